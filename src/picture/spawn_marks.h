#pragma once

#include "base/polygon2.h"
#include "picture/picture.h"

#include <spawnfield/query.h>

namespace spawnfield {

/// How spawns are drawn: as footprints to scale, or as arrows or dots.
struct SpawnLook {
    std::vector<Polygon2> footprint = {};  ///< outlines of the robot's parts from above, m; none: arrows or dots
    double scale = 1;                      ///< pixels per metre
    double arrow = 0;                      ///< length, units; a dot if shorter than smallest_arrow
    double unit = 1;                       ///< pixels
};
inline constexpr double smallest_arrow = 10;
inline constexpr double least_footprint = 6;  ///< pixels of the footprint's longer side

/// Footprints where they are large enough, else arrows that are shorter where spawns are many.
SpawnLook spawn_look(const Robot* robot, const Layout& layout, double scale, std::size_t count);

/// `at` is the place of the robot's origin, in pixels; yaw turns from x to y, which is up.
void draw_spawn(Figure& figure, const SpawnLook& look, cv::Point2d at, double yaw, Colour colour);

/// The same as a symbol of the legend, around `centre`.
void draw_spawn_symbol(Figure& figure, const SpawnLook& look, cv::Point2d centre, Colour colour);

/// Writes each name beside its place, where it covers no mark and no other name and stays within the area. Returns how
/// many it wrote.
std::size_t write_names(Figure& figure, const SpawnLook& look, const std::vector<cv::Point2d>& places,
                        const std::vector<std::string>& names, const cv::Rect& area);

}  // namespace spawnfield
