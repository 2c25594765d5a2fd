#include "drawing/pair_marks.h"

#include "picture/palette.h"

#include <algorithm>
#include <cmath>

namespace spawnfield {

double pair_mark_radius(const Layout& layout, std::size_t count)
{
    const double apart = std::sqrt(layout.plot.area() / std::max(1.0, double(count)));
    return std::max(3.0, std::clamp(0.15 * apart, 3 * layout.unit, 7 * layout.unit));
}

void draw_pair_mark(Figure& figure, PairMark mark, cv::Point2d place, double radius, double unit)
{
    const double edge = std::max(1.0, 1.6 * unit);
    if (mark == PairMark::Start) {
        draw_dot(figure, place, radius, rgb(start_colour), ink, edge);
        return;
    }
    const double corner = 1.25 * radius;  // about the area of the disc
    draw_polygon(figure,
                 {place + cv::Point2d(0, -corner), place + cv::Point2d(corner, 0), place + cv::Point2d(0, corner),
                  place + cv::Point2d(-corner, 0)},
                 rgb(goal_colour), ink, edge);
}

void draw_path(Figure& figure, const std::vector<cv::Point2d>& places, double unit)
{
    if (places.size() < 2) return;
    std::vector<cv::Point2d> there_and_back = places;  // figures have closed outlines only
    there_and_back.insert(there_and_back.end(), places.rbegin() + 1, places.rend() - 1);
    draw_outline(figure, there_and_back, white, std::max(2.5, 4 * unit));
    draw_outline(figure, there_and_back, rgb(path_colour), std::max(1.2, 2 * unit));
}

void draw_pair_symbol(Figure& figure, PairMark mark, cv::Point2d centre, double unit)
{
    const double half = symbol_size / 2 * unit;
    if (mark == PairMark::Path)
        draw_path(figure, {centre - cv::Point2d(half, 0), centre + cv::Point2d(half, 0)}, unit);
    else
        draw_pair_mark(figure, mark, centre, std::max(3.0, 7 * unit), unit);
}

}  // namespace spawnfield
