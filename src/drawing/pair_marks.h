#pragma once

#include "drawing/picture.h"

namespace spawnfield {

/// The marks of pairs of a start and a goal.
enum class PairMark { Start, Goal, Path };

/// Returns the radius of the marks of `count` starts and goals, pixels. It is smaller if there are many.
double pair_mark_radius(const Layout& layout, std::size_t count);

/// Draws a disc for a start, or a diamond for a goal.
void draw_pair_mark(Figure& figure, PairMark mark, cv::Point2d place, double radius, double unit);

/// Draws a line through these places.
void draw_path(Figure& figure, const std::vector<cv::Point2d>& places, double unit);

/// Draws the same marks around `centre`, as a symbol of the legend.
void draw_pair_symbol(Figure& figure, PairMark mark, cv::Point2d centre, double unit);

}  // namespace spawnfield
