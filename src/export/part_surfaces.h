#pragma once

#include <spawnfield/geometry.h>

#include <array>
#include <functional>
#include <unordered_map>
#include <vector>

namespace spawnfield {

/// A corner in the frame of a file.
using Point = std::array<float, 3>;

/// Triangles with equal corners welded. Triangles with two equal corners are left out.
class Surface {
public:
    void add(const Point& a, const Point& b, const Point& c)
    {
        if (a == b || b == c || c == a) return;
        for (const Point& corner : {a, b, c}) indices_.push_back(number_of(corner));
    }
    bool empty() const { return indices_.empty(); }
    const std::vector<Point>& points() const { return points_; }
    const std::vector<std::uint32_t>& indices() const { return indices_; }

private:
    struct PointHash {
        std::size_t operator()(const Point& p) const;
    };
    std::uint32_t number_of(const Point& point);

    std::unordered_map<Point, std::uint32_t, PointHash> numbers_;
    std::vector<Point> points_;
    std::vector<std::uint32_t> indices_;
};

/// The surfaces of a part of the scene, by label.
using PartSurfaces = std::array<Surface, 3>;

/// Calls visit(part, surfaces) for each part of a scene, in the scene's order, also for parts without triangles.
/// `to_point` returns a corner, in m in the scene's frame, in that of the file; several threads call it. Circles of
/// round primitives become polygons of 32 sides; of 16 sides if there are more than 2000 round primitives, of 8 if
/// there are more than 20000. Needs about 50 bytes of memory for each triangle. Throws FileError for a damaged map.
void for_each_part(const Geometry& geometry, const std::function<Point(const Vec3&)>& to_point, int threads,
                   const std::function<void(std::size_t part, const PartSurfaces& surfaces)>& visit);

}  // namespace spawnfield
