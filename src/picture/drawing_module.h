#pragma once

#include <spawnfield/heatmap.h>
#include <spawnfield/robot_picture.h>

/// The interface of the module src/drawing: a shared library that contains all code that uses OpenCV and libharu, and
/// that is loaded when the first picture is drawn. Debian's OpenCV needs many other libraries, among them X11, and
/// OpenBLAS, which starts threads. Without the module, each start of a program would load them all.
namespace spawnfield::drawing_module {

// They do the work of the functions of the same name in <spawnfield/heatmap.h> and <spawnfield/robot_picture.h>.
void write_heatmap(const Map& map, const TerrainMap& terrain, const RasterResult& raster, const HeatmapOptions& options,
                   const std::filesystem::path& file);
void write_preview(const Map& map, const TerrainMap& terrain, const std::filesystem::path& file);
void write_robot_picture(const Robot& robot, const std::filesystem::path& file);

/// The functions that the module exports.
struct Functions {
    static constexpr const char *module = "drawing", *failure = "pictures cannot be drawn";
    decltype(&write_heatmap) heatmap;
    decltype(&write_preview) preview;
    decltype(&write_robot_picture) robot;
};

}  // namespace spawnfield::drawing_module
