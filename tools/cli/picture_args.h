#pragma once

#include "ground_args.h"

#include <spawnfield/picture_format.h>

namespace spawnfield::cli {

/// A picture that a command writes.
struct PictureFile {
    std::string path;
    PictureFormat format;
};

/// Returns the file with the format that --format (may be empty) or the file's ending names; "-" is standard output.
/// Throws ArgumentError for other endings, and if both contradict each other. Call it before all work.
PictureFile picture_file(const std::string& file, const std::string& format = "");

/// Returns the second line of a heat map: the poses that its verdicts are for. `options` are complete. `yaw` is in
/// words; empty: the raster's yaw.
std::string heatmap_caption(const RasterOptions& options, const GroundArgs& ground, const Judge& judge,
                            const std::string& yaw = "");

}  // namespace spawnfield::cli
