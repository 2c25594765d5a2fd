#include "reach/level_ground.h"

#include "geometry/geometry_impl.h"
#include "query/pose_judge.h"
#include "settle/convex.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace spawnfield {
namespace {

constexpr int directions = 64;        // in which the robot's outline is examined
constexpr double round_miss = 2e-3;   // share of the radius of round parts by which the outline may miss their points
constexpr std::size_t most = 64;      // solids near a place; of more, the comparisons take longer than they save
constexpr double contact_gap = 1e-3;  // m: as in Settler

/// Returns the extreme points of a robot in horizontal directions that are tilted by `down`, as corners of a polygon.
template <class KeepPart, class KeepPoint>
Polygon2 outline_of(const std::vector<Convex>& parts, double down, const KeepPart& keep_part,
                    const KeepPoint& keep_point)
{
    Polygon2 points;
    for (const Convex& part : parts) {
        if (!keep_part(part)) continue;
        for (int k = 0; k < directions; ++k) {
            const double angle = 2 * std::numbers::pi * k / directions;
            const Vec3 point = part.support({std::cos(angle), std::sin(angle), -down});
            if (keep_point(point)) points.push_back(point.head<2>());
        }
    }
    return convex_hull(std::move(points));
}

/// Returns the distance of a point from the nearest edge of a convex polygon; negative outside.
double depth_in(const Polygon2& polygon, const Vec2& point)
{
    double out = polygon.size() < 3 ? -1 : std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < polygon.size(); ++k) {
        const Vec2 &p = polygon[k], &q = polygon[k + 1 < polygon.size() ? k + 1 : 0];
        out = std::min(out, -edge_normal(p, q).normalized().dot(point - p));
    }
    return out;
}

/// Returns whether a line at right angles to an edge of `a` separates two convex polygons (1 or more corners) by more
/// than a gap.
bool edges_separate(const Polygon2& a, const Polygon2& b, double gap)
{
    for (std::size_t k = 0; k < a.size(); ++k) {
        const Vec2 &p = a[k], &q = a[k + 1 < a.size() ? k + 1 : 0];
        if (p == q) continue;
        const Vec2 outward = edge_normal(p, q).normalized();
        double nearest = std::numeric_limits<double>::infinity();
        for (const Vec2& corner : b) nearest = std::min(nearest, outward.dot(corner - p));
        if (nearest > gap) return true;
    }
    return false;
}

bool are_apart(const Polygon2& a, const Polygon2& b, double gap)
{
    return edges_separate(a, b, gap) || edges_separate(b, a, gap);
}

Polygon2 rotated(const Polygon2& polygon, double yaw)
{
    const Eigen::Matrix2d rotation = rotation_from_rpy(0, 0, yaw).topLeftCorner<2, 2>();
    Polygon2 out;
    for (const Vec2& corner : polygon) out.push_back(rotation * corner);
    return out;
}

/// Returns the largest difference between ground and plane for which the proof holds, m; 0 if there is none. `margin`,
/// `mass_height`: of the level robot on a plane; `radius`: distance of its farthest point from its origin, m.
double largest_flatness(double margin, double mass_height, double radius, double min_stability)
{
    constexpr double reserve = 0.5;  // of each limit, for slopes and rounding
    const double least = margin - min_stability - 2 * contact_gap;
    if (!(least > 0) || !(mass_height > 0)) return 0;
    const double by_tilt = margin * margin / (4 * mass_height), by_gap = contact_gap / (2 + 8 * radius / margin);
    return reserve * std::min(by_tilt, by_gap);
}

}  // namespace

LevelGround::LevelGround(const Judge::Impl& shared) : shared_(shared)
{
    constexpr double level = 1e-6;   // m: points that are not higher than this above the lowest one stand on the ground
    constexpr double upright = 0.5;  // cosine of the angle between the axis of a wheel and the vertical
    constexpr double least_friction = 0.1, least_slope = 0.05;  // the proof would need smaller slopes otherwise
    const StandLimits& limits = shared.options.stand;
    std::vector<Convex> parts;
    Bounds box;
    for (const RobotPart& part : shared.robot.parts) {
        const Convex& body = parts.emplace_back(convex_of(part));
        gap_ = std::max(gap_, 2 * tolerance + round_miss * (body.ball + body.disc));
        box.extend(body.bounds().min);
        box.extend(body.bounds().max);
    }
    lowest_ = box.min.z();
    highest_ = box.max.z();
    const auto is_any = [](const auto&) { return true; };
    footprint_ = outline_of(parts, 0, is_any, is_any);
    // A disc that lies on nearly level ground may touch it at a few points of its rim only.
    const auto has_feet = [](const Convex& body) { return body.disc == 0 || std::abs(body.axis.z()) < upright; };
    const auto is_low = [&](const Vec3& point) { return point.z() <= lowest_ + level; };
    const Polygon2 support = outline_of(parts, 1 / level, has_feet, is_low);
    const Vec3 mass = mass_center_of(shared.robot);
    const double raised = limits.lift - lowest_;
    if (shared.options.exhaustive || limits.drop || limits.friction < least_friction ||
        limits.max_slope < least_slope || limits.lift < tolerance ||
        std::abs(raised - shared.options.max_height) < tolerance || raised < tolerance ||
        !contains(footprint_, Vec2::Zero()))
        return;
    flatness_ = largest_flatness(depth_in(support, mass.head<2>()), mass.z() - lowest_, shared.settler().reach(),
                                 *limits.min_stability);
}

void LevelGround::set_place(const Vec2& place, double radius)
{
    origin_ = {place.x(), place.y(), 0};
    radius_ = radius;
    solids_.clear();
    is_unsealed_ = false;
    const std::vector<Part>& scene_parts = shared_.map.geometry.parts();
    shared_.map.geometry.impl().visit_in(
        place.x() - radius, place.y() - radius, place.x() + radius, place.y() + radius,
        [&](const Tile& tile, auto element) {
            const Label label = tile.label(element);
            const Part& part = scene_parts[tile.part(element)];
            is_unsealed_ |= part.open_edges > 0 && part.solid_pieces > 0;
            if (label == Label::Water || label == Label::Ignore || solids_.size() > most) return;
            if (tile.is_triangle(element))
                add_triangle(tile.corners(element), label == Label::Terrain);
            else
                add_primitive(tile.primitive(element).shape(), label == Label::Terrain);
        });
}

void LevelGround::add_triangle(const std::array<Vec3, 3>& corners, bool is_terrain)
{
    Solid& solid = solids_.emplace_back();
    const Vec3 a = corners[0] - origin_, b = corners[1] - origin_, c = corners[2] - origin_;
    solid.outline = convex_hull({a.head<2>(), b.head<2>(), c.head<2>()});
    solid.low = std::min({a.z(), b.z(), c.z()});
    solid.high = std::max({a.z(), b.z(), c.z()});
    const Vec3 normal = (b - a).cross(c - a);
    solid.is_level = is_terrain && solid.outline.size() == 3 && normal.z() != 0;
    if (!solid.is_level) return;
    solid.middle = normal.dot(a) / normal.z();
    solid.steepness = normal.head<2>().norm() / std::abs(normal.z());
}

void LevelGround::add_primitive(const Shape& shape, bool is_terrain)
{
    Solid& solid = solids_.emplace_back();
    const Convex body = convex_of(shape);
    Bounds box = body.bounds();
    box.min -= origin_;
    box.max -= origin_;
    solid.low = box.min.z();
    solid.high = box.max.z();
    const bool is_upright = shape.kind == ShapeKind::Box && shape.pose.rotation(2, 2) == 1;
    solid.is_level = is_terrain && is_upright;
    solid.middle = solid.high;
    Polygon2 points{box.min.head<2>(), box.max.head<2>(), {box.min.x(), box.max.y()}, {box.max.x(), box.min.y()}};
    if (is_upright) {
        points.clear();
        for (const Vec3& point : body.points) points.push_back((point - origin_).head<2>());
    }
    solid.outline = convex_hull(std::move(points));
}

/// Returns whether the top of a solid is everywhere near the height of the layer, as far as the robot may reach.
bool LevelGround::is_ground(const Solid& solid) const
{
    return solid.is_level &&
           std::abs(solid.middle - height_) + std::numbers::sqrt2 * radius_ * solid.steepness <= flatness_;
}

bool LevelGround::set_layer(double height)
{
    height_ = height;
    ground_.clear();
    others_.clear();
    ends_.clear();
    if (solids_.size() > most || is_unsealed_) return false;
    const double top = z() + highest_ + shared_.options.stand.lift + tolerance;
    bool is_on_ground = false;
    for (const Solid& solid : solids_) {
        if (is_ground(solid)) {
            ground_.push_back(&solid);
            is_on_ground |= contains(solid.outline, Vec2::Zero());
        } else if (solid.high >= height_ - flatness_ && solid.low <= top) {
            others_.push_back(&solid.outline);
        }
    }
    for (const Solid* const solid : ground_) find_ends(*solid);
    return is_on_ground;
}

/// Adds the edges of a piece of ground on whose other side no piece begins.
void LevelGround::find_ends(const Solid& solid)
{
    const Polygon2 square{{-radius_, -radius_}, {radius_, -radius_}, {radius_, radius_}, {-radius_, radius_}};
    const Polygon2& corners = solid.outline;
    for (std::size_t k = 0; k < corners.size(); ++k) {
        const Vec2 &p = corners[k], &q = corners[k + 1 < corners.size() ? k + 1 : 0];
        const auto goes_on = [&](const Solid* other) {
            const Polygon2& polygon = other->outline;  // counterclockwise, too: a neighbour has the edge from q to p
            for (std::size_t l = 0; l < polygon.size(); ++l)
                if (polygon[l] == q && polygon[l + 1 < polygon.size() ? l + 1 : 0] == p) return true;
            return false;
        };
        if (!std::any_of(ground_.begin(), ground_.end(), goes_on) && !are_apart({p, q}, square, 0))
            ends_.push_back({p, q});
    }
}

bool LevelGround::stands(double yaw) const
{
    const Polygon2 footprint = rotated(footprint_, yaw);
    const auto is_clear = [&](const Polygon2& outline) { return are_apart(outline, footprint, gap_); };
    return std::all_of(others_.begin(), others_.end(), [&](const Polygon2* other) { return is_clear(*other); }) &&
           std::all_of(ends_.begin(), ends_.end(), is_clear);
}

}  // namespace spawnfield
