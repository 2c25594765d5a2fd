#pragma once

#include "base/polygon2.h"
#include "drawing/picture.h"

#include <spawnfield/query.h>

namespace spawnfield {

/// How spawns are drawn: as footprints to scale, or as arrows or dots.
struct SpawnLook {
    std::vector<Polygon2> footprint = {};  ///< outlines of the robot's parts from above, m; empty: arrows or dots
    double scale = 1;                      ///< pixels per metre
    double arrow = 0;                      ///< length, units; a dot if shorter than smallest_arrow
    double unit = 1;                       ///< pixels
};
inline constexpr double smallest_arrow = 10;
inline constexpr double least_footprint = 6;  ///< pixels; smallest longer side of a footprint that is drawn

/// Returns the look of `count` spawns: footprints if they are large enough, otherwise arrows, which are shorter if
/// there are many spawns.
SpawnLook spawn_look(const Robot* robot, const Layout& layout, double scale, std::size_t count);

/// Draws a spawn. `place` is that of the robot's origin, pixels. yaw turns from x (right) to y (up).
void draw_spawn(Figure& figure, const SpawnLook& look, cv::Point2d place, double yaw, Colour colour);

/// Draws the same mark around `centre`, as a symbol of the legend.
void draw_spawn_symbol(Figure& figure, const SpawnLook& look, cv::Point2d centre, Colour colour);

/// Returns the distance of a mark's farthest point from its place, pixels.
double radius_of(const SpawnLook& look);

/// A mark in the plot, and the name to be written beside it.
struct NamedMark {
    cv::Point2d place;
    double radius;  ///< pixels
    std::string name;
};

/// Writes each name beside its mark, if there is room in the area where it covers no mark and no other name. Returns
/// how many names it wrote.
std::size_t write_names(Figure& figure, double unit, const std::vector<NamedMark>& marks, const cv::Rect& area);

}  // namespace spawnfield
