#pragma once

#include <spawnfield/export.h>

#include <filesystem>
#include <string>

namespace spawnfield {

/// Svg and Pdf have lines, areas and texts as vectors, and the coloured ground as one embedded image.
enum class PictureFormat { Png, Svg, Pdf };

/// The format that a file's ending names: .png, .svg or .pdf, in any case. A name without an ending is a PNG file.
/// Throws ArgumentError for any other ending, because no program would open the file.
SPAWNFIELD_API PictureFormat picture_format(const std::filesystem::path& file);

/// "png", "svg" or "pdf".
SPAWNFIELD_API const char* to_string(PictureFormat format);

}  // namespace spawnfield
