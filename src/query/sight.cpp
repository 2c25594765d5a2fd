#include "query/sight.h"

#include "base/polygon2.h"
#include "geometry/geometry_impl.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace spawnfield {
namespace {

/// A line of some length, in a frame in which it begins at the origin and goes straight up.
class UprightLine {
public:
    UprightLine(const Vec3& from, const Vec3& to)
        : from_(from), length_((to - from).norm()),
          rotation_(Eigen::Quaterniond::FromTwoVectors(to - from, Vec3::UnitZ()).toRotationMatrix())
    {
    }

    bool meets(const Tile& tile, std::uint32_t element) const
    {
        if (tile.is_triangle(element)) return meets(tile.corners(element));
        Shape shape = tile.primitive(element).shape();
        shape.pose = {rotation_ * (shape.pose.position - from_), rotation_ * shape.pose.rotation};
        const std::optional<Interval> inside = vertical_interval(shape, 0, 0);
        return inside && is_on_line(inside->bottom, inside->top);
    }

private:
    bool is_on_line(double low, double high) const
    {
        return low <= length_ + touch_tolerance && high >= -touch_tolerance;
    }

    /// A line through a common edge of two triangles meets one of them or both, because the edge's area has the
    /// opposite sign for the other triangle, with the same rounding.
    bool meets(std::array<Vec3, 3> corners) const
    {
        for (Vec3& corner : corners) corner = rotation_ * (corner - from_);
        std::array<double, 3> areas{};  // twice the area between the line and the edge across from corner k
        for (std::size_t k = 0; k < 3; ++k)
            areas[k] = cross(corners[(k + 1) % 3].head<2>(), corners[(k + 2) % 3].head<2>());
        const auto [least, most] = std::minmax_element(areas.begin(), areas.end());
        const double sum = areas[0] + areas[1] + areas[2];
        if ((*least < 0 && *most > 0) || sum == 0) return false;
        const double z = (areas[0] * corners[0].z() + areas[1] * corners[1].z() + areas[2] * corners[2].z()) / sum;
        return is_on_line(z, z);
    }

    Vec3 from_;
    double length_;
    Mat3 rotation_;
};

}  // namespace

bool is_clear_line(const Geometry& geometry, const Vec3& from, const Vec3& to)
{
    constexpr double piece = 1, most_pieces = 64;  // m: short pieces have small boxes with few elements
    if (from == to) return true;
    const UprightLine line(from, to);
    const int pieces = int(std::clamp(std::ceil((to - from).norm() / piece), 1.0, most_pieces));
    bool is_clear = true;
    for (int k = 0; k < pieces && is_clear; ++k) {
        Bounds box;
        for (const int end : {k, k + 1}) box.extend(from + (to - from) * (double(end) / pieces));
        box.min.array() -= touch_tolerance;
        box.max.array() += touch_tolerance;
        geometry.impl().visit_tiles(box, [&](const Tile& tile, const ElementBox&) {
            if (!is_clear) return;
            for_each_bit(tile.near(box), [&](std::uint32_t element) {
                if (is_clear && tile.label(element) != Label::Water) is_clear = !line.meets(tile, element);
            });
        });
    }
    return is_clear;
}

}  // namespace spawnfield
