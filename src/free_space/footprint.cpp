#include "free_space/footprint.h"

#include <spawnfield/free_space.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace spawnfield {
namespace {

constexpr int disc_sides = 32, inner_disc_sides = 16;

/// Corners of two polyhedra, one around a part and one within it, in the robot's frame turned by `rotation`.
struct PartCorners {
    std::vector<Vec3> around, within;
    /// Edges of `within`. Empty: not known, so each pair of corners counts as an edge.
    std::vector<std::pair<std::size_t, std::size_t>> edges;
};

/// Adds a circle of `radius` around `centre` in the plane of u and v, as corners of polygons around it and within it.
void add_circle(const Vec3& centre, const Vec3& u, const Vec3& v, double radius, PartCorners& out)
{
    const double wide = radius / std::cos(std::numbers::pi / disc_sides);
    for (int k = 0; k < disc_sides; ++k) {
        const double angle = 2 * std::numbers::pi * k / disc_sides;
        const Vec3 spoke = std::cos(angle) * u + std::sin(angle) * v;
        out.around.push_back(centre + wide * spoke);
        if (k % (disc_sides / inner_disc_sides) == 0) out.within.push_back(centre + radius * spoke);
    }
}

/// Adds circles of latitude of a ball. Seen from above they contain it; its height is computed separately.
void add_ball(const Vec3& centre, double radius, PartCorners& out)
{
    const Vec3 x = Vec3::UnitX(), y = Vec3::UnitY(), z = Vec3::UnitZ();
    for (const double latitude : {-1.0, -0.4, 0.0, 0.4, 1.0}) {
        const double angle = latitude * std::numbers::pi / 2.5;
        PartCorners circle;
        add_circle(centre + radius * std::sin(angle) * z, x, y, radius * std::cos(angle), circle);
        out.within.insert(out.within.end(), circle.within.begin(), circle.within.end());
        if (latitude == 0) out.around.insert(out.around.end(), circle.around.begin(), circle.around.end());
    }
}

PartCorners corners_of(const RobotPart& part, const Mat3& rotation)
{
    PartCorners out;
    const Pose pose = Pose{Vec3::Zero(), rotation} * part.shape.pose;
    const Vec3 u = pose.rotation.col(0), v = pose.rotation.col(1), axis = pose.rotation.col(2);
    const Vec3& size = part.shape.size;
    switch (part.shape.kind) {
    case ShapeKind::Hull:
        for (const Vec3& vertex : part.hull_vertices) out.around.push_back(rotation * vertex);
        out.within = out.around;
        for (const auto& face : part.hull_faces)
            for (std::size_t k = 0; k < 3; ++k) out.edges.emplace_back(face[k], face[(k + 1) % 3]);
        break;
    case ShapeKind::Box:
        for (int corner = 0; corner < 8; ++corner)
            out.around.push_back(pose.rotation *
                                     (0.5 * Vec3(corner & 1 ? size[0] : -size[0], corner & 2 ? size[1] : -size[1],
                                                 corner & 4 ? size[2] : -size[2])) +
                                 pose.position);
        out.within = out.around;
        break;
    case ShapeKind::Sphere: add_ball(pose.position, size[0], out); break;
    case ShapeKind::Cylinder:
        for (const double end : {-0.5, 0.5}) add_circle(pose.position + end * size[1] * axis, u, v, size[0], out);
        break;
    case ShapeKind::Capsule:
        for (const double end : {-0.5, 0.5}) add_ball(pose.position + end * size[1] * axis, size[0], out);
        break;
    }
    return out;
}

/// Returns a polygon that contains all points nearer than `reach` to this one.
Polygon2 widened(const Polygon2& polygon, double reach)
{
    Polygon2 corners;
    for (const Vec2& p : polygon)
        for (int corner = 0; corner < 4; ++corner)
            corners.push_back(p + reach * Vec2(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1));
    return convex_hull(std::move(corners));
}

/// Returns the polygon scaled towards its centre until its rim is `reach` inside the old one; empty if it is too thin.
Polygon2 narrowed(const Polygon2& polygon, double reach)
{
    if (polygon.size() < 3) return {};
    const Vec2 centre = std::accumulate(polygon.begin(), polygon.end(), Vec2(Vec2::Zero())) / double(polygon.size());
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < polygon.size(); ++k) {
        const Vec2 edge = polygon[(k + 1) % polygon.size()] - polygon[k];
        if (edge.norm() > 0) nearest = std::min(nearest, cross(edge, centre - polygon[k]) / edge.norm());
    }
    if (!(nearest > 2 * reach)) return {};
    Polygon2 out;
    for (const Vec2& p : polygon) out.push_back(centre + (1 - reach / nearest) * (p - centre));
    return out;
}

/// Returns the cross-section at height z of the polyhedron within the part, seen from above.
Polygon2 slice(const PartCorners& corners, double z)
{
    Polygon2 out;
    const auto add = [&](const Vec3& p, const Vec3& q) {
        const Vec3 &low = p.z() < q.z() ? p : q, &high = p.z() < q.z() ? q : p;
        if (low.z() > z || high.z() < z) return;
        const double rise = high.z() - low.z();
        out.push_back((low + (rise > 0 ? (z - low.z()) / rise : 0.0) * (high - low)).head<2>());
        if (!(rise > 0)) out.push_back(high.head<2>());
    };
    for (const auto& [a, b] : corners.edges) add(corners.within[a], corners.within[b]);
    if (corners.edges.empty())
        for (std::size_t a = 0; a < corners.within.size(); ++a)
            for (std::size_t b = 0; b < a; ++b) add(corners.within[a], corners.within[b]);
    return convex_hull(std::move(out));
}

/// Returns a large upright prism inside the polyhedron within the part. It is convex, so the area that two of its
/// cross-sections share is inside it at all heights between them.
Prism prism_within(const PartCorners& corners)
{
    const std::vector<Vec3>& points = corners.within;
    const auto [low, high] = std::minmax_element(points.begin(), points.end(),
                                                 [](const Vec3& l, const Vec3& r) { return l.z() < r.z(); });
    const double height = high->z() - low->z();
    Prism best;
    double best_volume = 0;
    for (const double share : {0.0, 0.02, 0.08, 0.2, 0.35}) {
        const double bottom = low->z() + share * height, top = high->z() - share * height;
        Polygon2 polygon = slice(corners, bottom);
        const Polygon2 other = slice(corners, top);
        if (polygon.size() < 3 || other.size() < 3) continue;
        for (std::size_t k = 0; k < other.size() && polygon.size() >= 3; ++k) {
            const Vec2 normal = edge_normal(other[k], other[(k + 1) % other.size()]);
            polygon = cut(polygon, normal, normal.dot(other[k]));
        }
        polygon = convex_hull(std::move(polygon));
        if (polygon.size() < 3) continue;
        const double volume = area_of(polygon) * (top - bottom);
        if (volume > best_volume * 1.001) {
            best_volume = volume;
            best = {std::move(polygon), bottom, top};
        }
    }
    // Twice the margin, because the cross-sections are rounded.
    best.polygon = narrowed(best.polygon, 2 * FreeSpace::margin);
    best.bottom += 2 * FreeSpace::margin;
    best.top -= 2 * FreeSpace::margin;
    if (best.polygon.empty() || !(best.top > best.bottom)) return {};
    return best;
}

constexpr double reach = touch_margin * 2 + FreeSpace::margin;  // m; a hull grows by up to sqrt(3) touch_margin

}  // namespace

Interval height_of(const RobotPart& part, const Mat3& rotation)
{
    Bounds box;
    if (part.shape.kind == ShapeKind::Hull) {
        for (const Vec3& vertex : part.hull_vertices) box.extend(rotation * vertex);
    } else {
        Shape turned = part.shape;
        turned.pose = Pose{Vec3::Zero(), rotation} * part.shape.pose;
        box = bounds_of(turned);
    }
    return {box.min.z(), box.max.z()};
}

double lowest_point(const Robot& robot, const Mat3& rotation)
{
    double lowest = std::numeric_limits<double>::infinity();
    for (const RobotPart& part : robot.parts) lowest = std::min(lowest, height_of(part, rotation).bottom);
    return lowest;
}

std::vector<Footprint> footprints(const Robot& robot, const Mat3& rotation, bool with_inner)
{
    std::vector<Footprint> out;
    for (const RobotPart& part : robot.parts) {
        const PartCorners corners = corners_of(part, rotation);
        const Interval height = height_of(part, rotation);
        Footprint footprint;
        Polygon2 seen;
        for (const Vec3& corner : corners.around) seen.push_back(corner.head<2>());
        footprint.outer = {widened(convex_hull(std::move(seen)), reach), height.bottom - reach, height.top + reach};
        if (with_inner) footprint.inner = prism_within(corners);
        out.push_back(std::move(footprint));
    }
    return out;
}

std::vector<Footprint> yaw_free_footprints(const Robot& robot)
{
    std::vector<Footprint> out = footprints(robot, Mat3::Identity(), true);
    const auto disc = [](double radius) {
        Polygon2 polygon;
        for (int k = 0; k < disc_sides; ++k) {
            const double angle = 2 * std::numbers::pi * k / disc_sides;
            polygon.push_back(radius * Vec2(std::cos(angle), std::sin(angle)));
        }
        return polygon;
    };
    for (Footprint& footprint : out) {
        double farthest = 0;
        for (const Vec2& p : footprint.outer.polygon) farthest = std::max(farthest, p.norm());
        footprint.outer.polygon = disc((farthest + reach) / std::cos(std::numbers::pi / disc_sides));
        Polygon2& inner = footprint.inner.polygon;
        double nearest = std::numeric_limits<double>::infinity();  // distance of its rim from the origin; negative if
                                                                   // the origin is outside
        for (std::size_t k = 0; k < inner.size(); ++k) {
            const Vec2 edge = inner[(k + 1) % inner.size()] - inner[k];
            if (edge.norm() > 0) nearest = std::min(nearest, cross(edge, -inner[k]) / edge.norm());
        }
        if (inner.empty() || !(nearest > 0))
            inner.clear();
        else
            inner = disc(nearest);
    }
    return out;
}

}  // namespace spawnfield
