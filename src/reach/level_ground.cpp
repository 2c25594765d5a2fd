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
constexpr std::size_t most = 256;     // solids near a layer; of more, the comparisons take longer than they save
constexpr double crack = 1e-7;        // m: nothing gets into a narrower gap between two pieces of ground
constexpr double contact_gap = 1e-3;  // m: as in Settler
constexpr double end_slack = 1e-5;    // m: more than rounding and `crack` move the ends of the ground

/// Returns the extreme points of a robot in horizontal directions that are tilted by `down`, as corners of a polygon.
template <class KeepPart, class KeepPoint>
Polygon2 outline_of(std::span<const Convex> parts, double down, const KeepPart& keep_part, const KeepPoint& keep_point)
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
bool edges_separate(std::span<const Vec2> a, std::span<const Vec2> b, double gap)
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

bool are_apart(std::span<const Vec2> a, std::span<const Vec2> b, double gap)
{
    return edges_separate(a, b, gap) || edges_separate(b, a, gap);
}

bool overlap(const Rect& a, const Rect& b, double gap)
{
    return a.low_x <= b.high_x + gap && b.low_x <= a.high_x + gap && a.low_y <= b.high_y + gap &&
           b.low_y <= a.high_y + gap;
}

/// Returns the part of the line from p to q, 0 .. 1, that is in a convex polygon; empty (first > second) if it misses
/// the polygon.
std::pair<double, double> part_in(const Vec2& p, const Vec2& q, std::span<const Vec2> polygon)
{
    double low = 0, high = 1;
    for (std::size_t k = 0; k < polygon.size(); ++k) {
        const Vec2 &a = polygon[k], &b = polygon[k + 1 < polygon.size() ? k + 1 : 0];
        const double at_p = cross(b - a, p - a), at_q = cross(b - a, q - a);  // >= 0: inside
        if (at_p < 0 && at_q < 0) return {1, 0};
        if (at_p < 0) low = std::max(low, at_p / (at_p - at_q));
        if (at_q < 0) high = std::min(high, at_p / (at_p - at_q));
    }
    return {low, high};
}

Polygon2 rotated(const Polygon2& polygon, const Eigen::Matrix2d& rotation)
{
    Polygon2 out;
    for (const Vec2& corner : polygon) out.push_back(rotation * corner);
    return out;
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
    for (const Vec2& corner : footprint_) reach_ = std::max(reach_, corner.norm() + gap_);
    // A disc that lies on nearly level ground may touch it at a few points of its rim only.
    const auto has_feet = [](const Convex& body) { return body.disc == 0 || std::abs(body.axis.z()) < upright; };
    const auto is_low = [&](const Vec3& point) { return point.z() <= lowest_ + level; };
    Polygon2 support;
    for (const Convex& part : parts)
        if (Polygon2 foot = outline_of({&part, 1}, 1 / level, has_feet, is_low); !foot.empty()) {
            support.insert(support.end(), foot.begin(), foot.end());
            feet_.push_back(std::move(foot));
        }
    has_flat_base_ = parts.size() == 1 && parts[0].is_polyhedron() && feet_.size() == 1 &&
                     std::all_of(footprint_.begin(), footprint_.end(),
                                 [&](const Vec2& corner) { return depth_in(feet_[0], corner) >= -crack; });
    mass_ = mass_center_of(shared.robot);
    const double raised = limits.lift - lowest_;
    if (shared.options.exhaustive || limits.drop || limits.friction < least_friction ||
        limits.max_slope < least_slope || limits.lift < tolerance ||
        std::abs(raised - shared.options.max_height) < tolerance || raised < tolerance ||
        !contains(footprint_, Vec2::Zero()))
        return;
    flatness_ = largest_flatness(depth_in(convex_hull(std::move(support)), mass_.head<2>()));
    for (int heading = 0; heading < lattice_headings; ++heading) at_headings_.push_back(turned(lattice_yaw(heading)));
}

/// Returns the largest difference between ground and plane for which the proof holds, m; 0 if there is none. `margin`:
/// of the level robot on a plane, m.
double LevelGround::largest_flatness(double margin) const
{
    constexpr double reserve = 0.5;  // of each limit, for slopes and rounding
    const double mass_height = mass_.z() - lowest_, radius = shared_.settler().reach();
    const double least = margin - *shared_.options.stand.min_stability - 2 * contact_gap;
    if (!(least > 0) || !(mass_height > 0)) return 0;
    const double by_tilt = margin * margin / (4 * mass_height), by_gap = contact_gap / (2 + 8 * radius / margin);
    return reserve * std::min(by_tilt, by_gap);
}

void LevelGround::set_place(const Vec2& place, double radius)
{
    origin_ = {place.x(), place.y(), 0};
    radius_ = radius;
    solids_.clear();
    is_unsealed_ = has_water_ = false;
    shared_.map.geometry.impl().visit_in(
        {place.x() - radius, place.y() - radius, place.x() + radius, place.y() + radius},
        [&](const Tile& tile, auto element) {
            const Label label = tile.label(element);
            is_unsealed_ |= tile.is_triangle(element) && tile.piece(element).open != 0;
            has_water_ |= label == Label::Water;
            if (label == Label::Water || label == Label::Ignore) return;
            solids_.push_back(tile.is_triangle(element)
                                  ? triangle(tile.corners(element), label == Label::Terrain)
                                  : primitive(tile.primitive(element).shape(), label == Label::Terrain));
        });
}

LevelGround::Solid LevelGround::triangle(const std::array<Vec3, 3>& corners, bool is_terrain) const
{
    Solid out;
    const Vec3 a = corners[0] - origin_, b = corners[1] - origin_, c = corners[2] - origin_;
    const Vec3 normal = (b - a).cross(c - a);
    out.outline = {{a.head<2>(), b.head<2>(), c.head<2>(), Vec2::Zero()}, 3};
    if (normal.z() < 0) std::swap(out.outline.corners[1], out.outline.corners[2]);
    out.box = rect_around(out.outline.span());
    out.low = std::min({a.z(), b.z(), c.z()});
    out.high = std::max({a.z(), b.z(), c.z()});
    out.is_flat = out.low == out.high;
    out.is_level = is_terrain && normal.z() != 0;
    if (!out.is_level) return out;
    out.middle = normal.dot(a) / normal.z();
    out.steepness = normal.head<2>().norm() / std::abs(normal.z());
    return out;
}

LevelGround::Solid LevelGround::primitive(const Shape& shape, bool is_terrain) const
{
    Solid out;
    const Bounds box = bounds_of(shape);
    const bool is_upright = shape.kind == ShapeKind::Box && shape.pose.rotation(2, 2) == 1;
    const Vec2 half = is_upright ? Vec2(shape.size.head<2>() / 2) : Vec2((box.max - box.min).head<2>() / 2);
    const Eigen::Matrix2d rotation = is_upright ? Eigen::Matrix2d(shape.pose.rotation.topLeftCorner<2, 2>())
                                                : Eigen::Matrix2d::Identity();
    const Vec2 middle = ((box.min + box.max) / 2 - origin_).head<2>();
    const auto corner = [&](double x, double y) -> Vec2 { return middle + rotation * half.cwiseProduct(Vec2(x, y)); };
    out.outline = {{corner(-1, -1), corner(1, -1), corner(1, 1), corner(-1, 1)}, 4};
    out.box = rect_around(out.outline.span());
    out.low = box.min.z();
    out.high = out.middle = box.max.z();
    out.is_flat = shape.kind == ShapeKind::Box && shape.pose.rotation == Mat3::Identity();
    out.is_level = is_terrain && is_upright;
    return out;
}

std::optional<double> LevelGround::flat_ground(const Vec2& place, double radius, double head_room)
{
    set_place(place, radius);
    double top = -std::numeric_limits<double>::infinity();
    for (const Solid& solid : solids_) top = std::max(top, solid.high);
    const auto is_simple = [&](const Solid& solid) {
        const double below = top - solid.high;
        return solid.is_flat && (below == 0 || (below > flatness_ && below < head_room));
    };
    if (has_water_ || !std::all_of(solids_.begin(), solids_.end(), is_simple)) return std::nullopt;
    return set_layer(top) && is_open() ? std::optional(top) : std::nullopt;
}

/// Returns how far the top of a solid is from the height of the layer, as far as the robot may reach, m. Infinite if it
/// is no ground.
double LevelGround::unevenness_of(const Solid& solid) const
{
    return solid.is_level ? std::abs(solid.middle - height_) + std::numbers::sqrt2 * radius_ * solid.steepness
                          : std::numeric_limits<double>::infinity();
}

bool LevelGround::set_layer(double height)
{
    height_ = height;
    ground_.clear();
    obstacles_.clear();
    ends_.clear();
    unevenness_ = 0;
    is_clear_ = true;
    has_ends_ = can_tip_ = false;
    if (is_unsealed_) return false;
    double below = -std::numeric_limits<double>::infinity();  // highest of the solids that are lower than the ground, m
    const double top = z() + highest_ + shared_.options.stand.lift + tolerance;
    bool is_on_ground = false;
    std::size_t others = 0;
    for (const Solid& solid : solids_) {
        if (solid.high < height_ - flatness_) {
            below = std::max(below, solid.high);
            continue;
        }
        if (solid.low > top) continue;
        if (const double uneven = unevenness_of(solid); uneven <= flatness_) {
            ground_.push_back(&solid);
            unevenness_ = std::max(unevenness_, uneven);
            is_on_ground |= contains(solid.outline, Vec2::Zero());
        } else {
            is_clear_ = false;
            add_near(obstacles_, solid.outline, solid.box);
            ++others;
        }
        if (ground_.size() + others > most) return false;
    }
    for (std::size_t k = 0; k < ground_.size() && is_on_ground; ++k) find_ends(*ground_[k]);
    can_tip_ = has_flat_base_ && is_on_ground && is_clear_ && has_ends_ && unevenness_ == 0 &&
               below < height_ - 2 * shared_.settler().reach();
    return is_on_ground;
}

/// Adds an outline to a list, unless it is too far away at every yaw.
void LevelGround::add_near(std::vector<Outline>& list, const Outline& outline, const Rect& box) const
{
    if (overlap(box, {-reach_, -reach_, reach_, reach_}, 0)) list.push_back(outline);
}

/// Adds the parts of the edges of a piece of ground on whose other side there is no ground.
void LevelGround::find_ends(const Solid& solid)
{
    const double half = is_clear_ ? radius_ : reach_;  // what is farther away only matters to is_open()
    const std::array<Vec2, 4> square{{{-half, -half}, {half, -half}, {half, half}, {-half, half}}};
    const Outline& corners = solid.outline;
    for (std::size_t k = 0; k < corners.size(); ++k) {
        const Vec2 &p = corners[k], &q = corners[k + 1 < corners.size() ? k + 1 : 0];
        const Rect edge = rect_around(std::array{p, q});
        const double length = (q - p).norm();
        if (length == 0 || are_apart(std::array{p, q}, square, 0)) continue;
        const Vec2 outside = crack / length * edge_normal(p, q);
        covered_.clear();
        for (const Solid* const other : ground_) {
            if (other == &solid || !overlap(edge, other->box, crack)) continue;
            const auto part = part_in(p + outside, q + outside, other->outline.span());
            if (part.first < part.second) covered_.push_back(part);
        }
        std::sort(covered_.begin(), covered_.end());
        covered_.emplace_back(1, 1);
        double end = 0;  // up to here, the edge is covered
        for (const auto& [low, high] : covered_) {
            if ((low - end) * length > crack) {
                const Vec2 from = p + end * (q - p), to = p + low * (q - p);
                if (are_apart(std::array{from, to}, square, 0)) continue;
                has_ends_ = true;
                add_near(ends_, {{from, to}, 2}, rect_around(std::array{from, to}));
            }
            end = std::max(end, high);
        }
    }
}

LevelGround::Turned LevelGround::turned(double yaw) const
{
    const Eigen::Matrix2d rotation = rotation_from_rpy(0, 0, yaw).topLeftCorner<2, 2>();
    Turned out{.footprint = rotated(footprint_, rotation), .feet = {}, .mass = rotation * mass_.head<2>()};
    for (const Polygon2& foot : feet_) out.feet.push_back(rotated(foot, rotation));
    return out;
}

bool LevelGround::stands(const Turned& robot) const
{
    const auto is_apart = [&](const Outline& outline) { return are_apart(outline.span(), robot.footprint, gap_); };
    return std::all_of(obstacles_.begin(), obstacles_.end(), is_apart) &&
           (std::all_of(ends_.begin(), ends_.end(), is_apart) || stands_at_end(robot));
}

/// Returns whether the robot stands on the ground on the near sides of all ends below its footprint. There is ground at
/// its origin, and none of the ends lies between this and any other point there.
bool LevelGround::stands_at_end(const Turned& robot) const
{
    std::vector<Polygon2> feet = robot.feet;
    for (const Outline& end : ends_) {
        if (are_apart(end.span(), robot.footprint, gap_)) continue;
        const Vec2 outward = edge_normal(end[0], end[1]).normalized();
        const double distance = outward.dot(end[0]) - gap_;
        if (distance <= 0) return false;
        for (Polygon2& foot : feet) foot = cut(foot, outward, distance);
    }
    Polygon2 support;
    for (const Polygon2& foot : feet) support.insert(support.end(), foot.begin(), foot.end());
    const double flatness = largest_flatness(depth_in(convex_hull(std::move(support)), robot.mass));
    return flatness > 0 && unevenness_ <= flatness;
}

/// Returns whether the mass of the robot is beyond a straight end of the ground, or too near to it.
bool LevelGround::tips(const Turned& robot) const
{
    const double least = *shared_.options.stand.min_stability - 2 * end_slack;
    return std::any_of(ends_.begin(), ends_.end(), [&](const Outline& end) {
        const Vec2 outward = edge_normal(end[0], end[1]).normalized();
        return outward.dot(end[0] - robot.mass) < least && is_all_ground_before(end[0], outward);
    });
}

/// Returns whether all ground is on the near side of the line through a point of an end, at right angles to `outward`.
bool LevelGround::is_all_ground_before(const Vec2& point, const Vec2& outward) const
{
    const auto is_near = [&](const Vec2& corner) { return outward.dot(corner - point) <= end_slack; };
    return std::all_of(ground_.begin(), ground_.end(), [&](const Solid* const solid) {
        return std::all_of(solid->outline.span().begin(), solid->outline.span().end(), is_near);
    });
}

}  // namespace spawnfield
