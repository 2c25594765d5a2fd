#pragma once

#include <spawnfield/export.h>

#include <filesystem>
#include <string>

namespace spawnfield {

/// Svg and Pdf contain lines, areas and texts as vectors, and the coloured ground as one embedded image.
enum class PictureFormat { Png, Svg, Pdf };

/// Returns the format for the ending of a file's name: .png, .svg or .pdf, in upper or lower case. A name without an
/// ending is a PNG file. Throws ArgumentError for any other ending, because programs would not recognise the file.
SPAWNFIELD_API PictureFormat picture_format(const std::filesystem::path& file);

/// Returns "png", "svg" or "pdf".
SPAWNFIELD_API const char* to_string(PictureFormat format);

}  // namespace spawnfield
