#pragma once

#include "ground_args.h"

#include <spawnfield/picture_format.h>

namespace spawnfield::cli {

/// A picture that a command writes.
struct PictureFile {
    std::string path;
    PictureFormat format;
};

/// The file with the format that --format (may be empty) or its ending names; "-" is standard output. Throws
/// ArgumentError for endings of other formats, and where both contradict each other. To be called before all work.
PictureFile picture_file(const std::string& file, const std::string& format = "");

/// Second line of a heat map: what its verdicts hold for. `options` are complete; `yaw` in words, empty: the raster's.
std::string heatmap_caption(const RasterOptions& options, const GroundArgs& ground, const Judge& judge,
                            const std::string& yaw = "");

}  // namespace spawnfield::cli
