#include "slow_reach.h"

#include <spawnfield/column.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

using namespace spawnfield;

namespace slow {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

Vec2 vector_of(const LatticeMove& move) { return {double(move.cols), double(move.rows)}; }

double yaw_of(int heading)
{
    return std::atan2(double(lattice_move(heading).rows), double(lattice_move(heading).cols));
}

}  // namespace

std::vector<Vec3> corners_of(const RobotPart& part)
{
    if (part.shape.kind == ShapeKind::Hull) return part.hull_vertices;
    std::vector<Vec3> out;
    for (int k = 0; k < 8; ++k) {
        const Vec3 corner = Vec3(k & 1 ? 0.5 : -0.5, k & 2 ? 0.5 : -0.5, k & 4 ? 0.5 : -0.5);
        out.push_back(part.shape.pose.rotation * corner.cwiseProduct(part.shape.size) + part.shape.pose.position);
    }
    return out;
}

Reach::Reach(const Judge& judge, const ReachOptions& options, const RasterGrid& grid, const Geometry& surfaces)
    : judge_(judge), options_(options), grid_(grid), surfaces_(surfaces), cols_(grid.cols), rows_(grid.rows)
{
    for (int row = 0; row < rows_; ++row)
        for (int col = 0; col < cols_; ++col) {
            std::vector<ReachPlace>& here = places_.emplace_back();
            const Vec2 place = at(col, row);
            for (const double height : column_at(judge.map().geometry, place.x(), place.y()).layers) {
                if (!judge.map().z_limits.contains(height, 0)) continue;
                ReachPlace out{.ground = height, .poses = {}};
                for (int k = 0; k < lattice_headings; ++k)
                    if (SettledPose pose = judge.settle({place.x(), place.y(), height}, yaw_of(k));
                        pose.verdict == Verdict::Valid)
                        out.poses[std::size_t(k)] = std::move(pose);
                const auto is_valid = [](const auto& pose) { return pose.has_value(); };
                if (std::any_of(out.poses.begin(), out.poses.end(), is_valid)) here.push_back(std::move(out));
            }
        }
}

Vec2 Reach::at(int col, int row) const { return {grid_.x_of(col), grid_.y_of(row)}; }

double Reach::slope(const Vec2& place, double ground, const Vec2& ahead) const
{
    constexpr double arm = 1e-3;
    const double steepest = std::tan(judge_.options().stand.max_slope);
    const Vec2 beside = place + arm * ahead;
    double nearest = infinity;
    for (const double height : column_at(judge_.map().geometry, beside.x(), beside.y()).layers)
        if (std::abs(height - ground) < std::abs(nearest)) nearest = height - ground;
    return std::abs(nearest) <= arm * steepest + 1e-9 ? nearest / arm : 0;
}

double Reach::step(const Vec2& a, double ground_a, const Vec2& b, double ground_b) const
{
    const double d = (b - a).norm(), rise = ground_b - ground_a;
    const Vec2 ahead = (b - a) / d;
    const double by_a = d * slope(a, ground_a, ahead), by_b = -d * slope(b, ground_b, -ahead);
    if (rise > std::max(by_a, by_b)) return rise - std::max(by_a, by_b);
    if (rise < std::min(by_a, by_b)) return std::min(by_a, by_b) - rise;
    return 0;
}

/// Returns the place in another column with the smallest step, among those with a state at the heading.
std::optional<int> Reach::next_place(const State& from, int col, int row, int heading) const
{
    if (col < 0 || row < 0 || col >= cols_ || row >= rows_) return std::nullopt;
    const double ground = places(from[0], from[1])[std::size_t(from[2])].ground;
    std::optional<int> out;
    double least = infinity;
    const std::vector<ReachPlace>& there = places(col, row);
    for (int k = 0; k < int(there.size()); ++k) {
        if (!there[std::size_t(k)].poses[std::size_t(heading)]) continue;
        const double size = step(at(from[0], from[1]), ground, at(col, row), there[std::size_t(k)].ground);
        if (size >= least) continue;
        least = size;
        out = k;
    }
    return least <= options_.max_step + 1e-9 ? out : std::nullopt;
}

/// Returns where the ground leads on a way between different columns.
std::optional<int> Reach::end_of_ground(const State& from, Way way) const
{
    const WayEnd end = way_end(way, from[3]);
    const int col = from[0] + end.move.cols, row = from[1] + end.move.rows;
    if (way == Way::Ahead || way == Way::Aside) return next_place(from, col, row, end.heading);
    const LatticeMove half = lattice_move(from[3]);
    const int mid_col = from[0] + half.cols, mid_row = from[1] + half.rows;
    for (const int heading : {from[3], end.heading})
        if (const auto k = next_place(from, mid_col, mid_row, heading))
            if (const auto last = next_place({mid_col, mid_row, *k, heading}, col, row, end.heading)) return last;
    return std::nullopt;
}

std::optional<int> Reach::target(const State& from, Way way) const
{
    const WayEnd end = way_end(way, from[3]);
    State to{from[0] + end.move.cols, from[1] + end.move.rows, from[2], end.heading};
    if (way == Way::Turn) {
        if (!places(to[0], to[1])[std::size_t(to[2])].poses[std::size_t(end.heading)]) return std::nullopt;
    } else {
        const auto k = end_of_ground(from, way);
        if (!k) return std::nullopt;
        to[2] = *k;
    }
    const std::vector<Posed> poses = poses_on_way(from, to, way);
    const double lift = judge_.options().stand.lift, higher = options_.max_step;
    if (is_free(poses, lift, lift)) return to[2];
    const bool is_higher_free = higher > lift && is_free(poses, higher, higher) &&
                                is_free({poses.front(), poses.front()}, lift, higher) &&
                                is_free({poses.back(), poses.back()}, lift, higher);
    return is_higher_free ? std::optional(to[2]) : std::nullopt;
}

/// Returns the poses between which each part covers the hull of the part at both.
std::vector<Reach::Posed> Reach::poses_on_way(const State& from, const State& to, Way way) const
{
    const SettledPose &a = *places(from[0], from[1])[std::size_t(from[2])].poses[std::size_t(from[3])],
                      &b = *places(to[0], to[1])[std::size_t(to[2])].poses[std::size_t(to[3])];
    const double turn = std::remainder(b.yaw - a.yaw, 2 * std::numbers::pi);
    const bool tilts = std::abs(a.roll - b.roll) > 0.1 || std::abs(a.pitch - b.pitch) > 0.1;
    const int pieces = from[3] != to[3] || tilts ? 4 : 1;
    const bool is_curve = way == Way::Left || way == Way::Right;
    const Vec2 p0 = at(from[0], from[1]), p2 = at(to[0], to[1]),
               p1 = p0 + grid_.step * vector_of(lattice_move(from[3]));
    std::vector<Posed> out;
    for (int k = 0; k <= pieces; ++k) {
        const double t = double(k) / pieces, u = 1 - t;
        const Vec2 place = is_curve ? Vec2(u * u * p0 + 2 * u * t * p1 + t * t * p2) : Vec2(u * p0 + t * p2),
                   tangent = u * (p1 - p0) + t * (p2 - p1);
        const double yaw = is_curve ? std::atan2(tangent.y(), tangent.x()) : a.yaw + t * turn;
        out.push_back({{place.x(), place.y(), u * a.position.z() + t * b.position.z()},
                       u * a.roll + t * b.roll,
                       u * a.pitch + t * b.pitch,
                       yaw});
    }
    return out;
}

bool Reach::is_free(const std::vector<Posed>& poses, double lift_begin, double lift_end) const
{
    for (std::size_t k = 0; k + 1 < poses.size(); ++k)
        for (const RobotPart& part : judge_.robot().parts) {
            Posed a = poses[k], b = poses[k + 1];
            a.position.z() += lift_begin;
            b.position.z() += lift_end;
            if (!is_hull_free(part, a, b)) return false;
        }
    return true;
}

bool Reach::is_hull_free(const RobotPart& part, const Posed& a, const Posed& b) const
{
    // Coordinates relative to the first pose are small and precise.
    std::vector<Vec3> corners;
    Bounds box;
    for (const Posed* pose : {&a, &b})
        for (const Vec3& corner : corners_of(part)) {
            corners.push_back(rotation_from_rpy(pose->roll, pose->pitch, pose->yaw) * corner + pose->position -
                              a.position);
            box.extend(corners.back());
        }
    const auto meets_nothing = [&](const RobotPart& hull) {
        return CollisionChecker(surfaces_, make_robot("hull", {hull})).is_free({a.position});
    };
    const Vec3 room = Vec3::Constant(1e-3);
    return meets_nothing(shape_part(box_shape(box.max - box.min + room, {(box.min + box.max) / 2}))) ||
           meets_nothing(hull_part(corners));
}

}  // namespace slow
