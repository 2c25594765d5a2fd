#include "drawing/spawn_marks.h"

#include "drawing/text_room.h"
#include "picture/silhouette.h"

#include <algorithm>
#include <cmath>

namespace spawnfield {
namespace {

struct Extent {
    Vec2 min = Vec2::Constant(std::numeric_limits<double>::infinity()), max = -min;

    Vec2 size() const { return max - min; }
    Vec2 centre() const { return (min + max) / 2; }
};

Extent extent_of(const std::vector<Polygon2>& polygons)
{
    Extent extent;
    for (const Polygon2& polygon : polygons)
        for (const Vec2& corner : polygon) {
            extent.min = extent.min.cwiseMin(corner);
            extent.max = extent.max.cwiseMax(corner);
        }
    return extent;
}

bool holds(const Polygon2& outer, const Polygon2& inner)
{
    return std::all_of(inner.begin(), inner.end(), [&](const Vec2& corner) { return contains(outer, corner); });
}

/// Returns the outlines of all parts from above, except those that lie within an earlier outline.
std::vector<Polygon2> footprint_of(const Robot& robot)
{
    std::vector<Polygon2> outlines;
    for (const RobotPart& part : robot.parts) {
        Polygon2 outline = silhouette(part, view_from_above);
        if (std::none_of(outlines.begin(), outlines.end(),
                         [&](const Polygon2& other) { return holds(other, outline); }))
            outlines.push_back(std::move(outline));
    }
    return outlines;
}

/// Converts metres in the robot's frame to pixels.
struct Placement {
    cv::Point2d origin;  ///< place of the robot's origin, pixels
    double yaw, scale;   ///< rad; pixels per metre

    cv::Point2d of(const Vec2& point) const
    {
        const double c = std::cos(yaw), s = std::sin(yaw);
        return {origin.x + scale * (c * point.x() - s * point.y()), origin.y - scale * (s * point.x() + c * point.y())};
    }
    std::vector<cv::Point2d> of(const Polygon2& polygon) const
    {
        std::vector<cv::Point2d> corners;
        for (const Vec2& corner : polygon) corners.push_back(of(corner));
        return corners;
    }
};

/// Returns black or white: the one that is easier to see on the colour (ITU-R BT.601 luma).
Colour contrast_to(Colour colour)
{
    return 0.114 * colour[0] + 0.587 * colour[1] + 0.299 * colour[2] < 110 ? white : ink;
}

/// Returns whether a footprint is too small for a triangle at its front. Then a line ahead of it shows the heading.
bool is_small(const SpawnLook& look)
{
    constexpr double least_width = 10;  // pixels
    return extent_of(look.footprint).size().minCoeff() * look.scale < least_width;
}

/// Returns by how many pixels this line extends beyond the footprint.
double length_ahead(double unit) { return std::clamp(10 * unit, 3.0, 6.0); }

void draw_heading(Figure& figure, const Placement& placement, const Extent& extent, bool small, double unit,
                  Colour colour)
{
    const Vec2 size = extent.size(), centre = extent.centre();
    const double tip = extent.max.x() - 0.12 * size.x(), back = extent.max.x() - 0.45 * size.x(),
                 half = 0.28 * size.y();
    if (small)
        draw_outline(
            figure, placement.of(Polygon2{centre, {extent.max.x() + length_ahead(unit) / placement.scale, centre.y()}}),
            ink, 1.4 * unit);
    else
        draw_polygon(figure,
                     placement.of(Polygon2{{tip, centre.y()}, {back, centre.y() + half}, {back, centre.y() - half}}),
                     contrast_to(colour), ink, 0);
}

// A dark rim within a white rim can be seen on ground of any colour, even of the mark's own colour. The mark covers
// half of each line.
constexpr double rim = 2.4, white_rim = 5;  // units

void draw_footprint(Figure& figure, const SpawnLook& look, const Placement& placement, Colour colour)
{
    for (const Polygon2& part : look.footprint) draw_outline(figure, placement.of(part), white, white_rim * look.unit);
    for (const Polygon2& part : look.footprint) draw_outline(figure, placement.of(part), ink, rim * look.unit);
    for (const Polygon2& part : look.footprint) draw_polygon(figure, placement.of(part), colour, ink, 0);
    draw_heading(figure, placement, extent_of(look.footprint), is_small(look), look.unit, colour);
}

/// Draws an arrow that points along yaw. The larger part of it is ahead of `centre`.
void draw_arrow(Figure& figure, cv::Point2d centre, double yaw, const SpawnLook& look, Colour colour)
{
    if (look.arrow < smallest_arrow) {
        draw_dot(figure, centre, std::max(1.2, 2.2 * look.unit), colour, ink, look.unit);
        return;
    }
    const cv::Point2d along = look.arrow * look.unit * cv::Point2d(std::cos(yaw), -std::sin(yaw)),
                      left(along.y, -along.x);
    const cv::Point2d tail = centre - 0.4 * along;
    const std::vector<cv::Point2d> corners{centre + 0.6 * along, tail + 0.36 * left, centre - 0.2 * along,
                                           tail - 0.36 * left};
    if (colour != white) draw_outline(figure, corners, white, 4 * look.unit);
    draw_polygon(figure, corners, colour, ink, 1.4 * look.unit);
}

}  // namespace

double radius_of(const SpawnLook& look)
{
    double radius = look.footprint.empty() ? std::max(3.0, 0.6 * look.arrow) * look.unit : 0;
    for (const Polygon2& part : look.footprint)
        for (const Vec2& corner : part) radius = std::max(radius, corner.norm() * look.scale);
    return radius;
}

SpawnLook spawn_look(const Robot* robot, const Layout& layout, double scale, std::size_t count)
{
    SpawnLook look{{}, scale, 0, layout.unit};
    if (robot) {
        look.footprint = footprint_of(*robot);
        if (!(extent_of(look.footprint).size().maxCoeff() * scale >= least_footprint)) look.footprint.clear();
    }
    const double apart = std::sqrt(layout.plot.area() / std::max(1.0, static_cast<double>(count))) / layout.unit;
    look.arrow = std::clamp(0.5 * apart, smallest_arrow - 1, 22.0);
    return look;
}

void draw_spawn(Figure& figure, const SpawnLook& look, cv::Point2d place, double yaw, Colour colour)
{
    if (look.footprint.empty())
        draw_arrow(figure, place, yaw, look, colour);
    else
        draw_footprint(figure, look, {place, yaw, look.scale}, colour);
}

void draw_spawn_symbol(Figure& figure, const SpawnLook& look, cv::Point2d centre, Colour colour)
{
    if (look.footprint.empty()) {
        const double middle = 0.1 * (look.arrow < smallest_arrow
                                         ? 0
                                         : look.arrow);  // distance of the arrow's middle ahead of its place, units
        draw_arrow(figure, {centre.x - middle * look.unit, centre.y}, 0, look, colour);
        return;
    }
    const Extent extent = extent_of(look.footprint);
    const double size = symbol_size * look.unit,
                 room = is_small(look) ? std::max(size - length_ahead(look.unit), size / 2) : size;
    const double scale = room / extent.size().maxCoeff();
    const Vec2 middle = extent.centre();
    draw_footprint(figure, look, {{centre.x - scale * middle.x(), centre.y + scale * middle.y()}, 0, scale}, colour);
}

std::size_t write_names(Figure& figure, double unit, const std::vector<NamedMark>& marks, const cv::Rect& area)
{
    const double cap = std::max(9 * unit, 5.0);
    TextRoom room(area, cap);
    for (const auto& [place, radius, name] : marks)
        room.add_mark({place.x - 0.7 * radius, place.y - 0.7 * radius, 1.4 * radius, 1.4 * radius});
    std::size_t written = 0;
    for (const auto& [place, radius, name] : marks) {
        const double width = text_width(name, cap), away = radius + 0.5 * cap;
        // Lower left corners of the text: to the right, to the left, above, below.
        for (const cv::Point2d& corner :
             {cv::Point2d(place.x + away, place.y + cap / 2), cv::Point2d(place.x - away - width, place.y + cap / 2),
              cv::Point2d(place.x - width / 2, place.y - away),
              cv::Point2d(place.x - width / 2, place.y + away + cap)}) {
            if (!room.draw(figure, name, corner)) continue;
            ++written;
            break;
        }
    }
    return written;
}

}  // namespace spawnfield
