#include "slow_reach.h"

#include <spawnfield/column.h>

#include <Eigen/Geometry>

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
    : judge_(judge), options_(options), grid_(grid), lattice_(options.turning_radius.value_or(0) / grid.step),
      surfaces_(surfaces), cols_(grid.cols), rows_(grid.rows)
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
    return least <= *options_.max_step + 1e-9 ? out : std::nullopt;
}

/// Returns where the ground leads on a way between different columns.
std::optional<int> Reach::end_of_ground(const State& from, Way way) const
{
    const WayEnd end = lattice_.end(way, from[3]);
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
    if (options_.drive == Drive::Car && is_curve(way)) return target_of_car(from, way);
    const WayEnd end = lattice_.end(way, from[3]);
    State to{from[0] + end.move.cols, from[1] + end.move.rows, from[2], end.heading};
    if (way == Way::Turn) {
        if (!places(to[0], to[1])[std::size_t(to[2])].poses[std::size_t(end.heading)]) return std::nullopt;
    } else {
        const auto k = end_of_ground(from, way);
        if (!k) return std::nullopt;
        to[2] = *k;
    }
    return can_follow(course(from, to, way), pose(from), pose(to)) || passes_kink(from, to, way) ? std::optional(to[2])
                                                                                                 : std::nullopt;
}

/// Goes straight in four pieces if the robot tilts, and is let down after each of them.
bool Reach::passes_kink(const State& from, const State& to, Way way) const
{
    const SettledPose &a = pose(from), &b = pose(to);
    if ((way != Way::Ahead && way != Way::Aside) || pieces(a, b, false)[0] == pieces(a, b, false)[1]) return false;
    const Course whole = course(from, to, way);
    std::optional<SettledPose> here = a;
    for (int k = 1; k <= 4 && here; ++k)
        here = next_stop(*here, k < 4 ? at(whole, k / 4.0).first : whole.end, yaw_of(to[3]));
    return here && here->ground->height == b.ground->height;
}

/// Returns into how many pieces a way is cut first, and then.
std::array<int, 2> Reach::pieces(const SettledPose& a, const SettledPose& b, bool turns) const
{
    double radius = 0;
    for (const RobotPart& part : judge_.robot().parts)
        for (const Vec3& corner : corners_of(part)) radius = std::max(radius, corner.norm());
    const double tilt = std::max(std::abs(a.roll - b.roll), std::abs(a.pitch - b.pitch));
    const int few = turns || tilt > 0.1 ? 4 : 1;
    return {few, std::max(few, int(std::ceil(tilt * radius / 0.01)))};
}

/// A car stands at the ends of all pieces of a curve, on the layer with the smallest step.
std::optional<int> Reach::target_of_car(const State& from, Way way) const
{
    const WayEnd end = lattice_.end(way, from[3]);
    const int col = from[0] + end.move.cols, row = from[1] + end.move.rows;
    if (col < 0 || row < 0 || col >= cols_ || row >= rows_) return std::nullopt;
    const Course whole = course(from, {col, row, 0, end.heading}, way);
    const int count = int(std::ceil(length(whole) / grid_.step - 1e-9));
    std::optional<SettledPose> here = pose(from);
    for (int k = 1; k <= count && here; ++k) {
        const auto [place, yaw] = at(whole, double(k) / count);
        here = next_stop(*here, k < count ? place : whole.end, k < count ? yaw : yaw_of(end.heading));
    }
    const std::vector<ReachPlace>& there = places(col, row);
    for (int k = 0; k < int(there.size()) && here; ++k)
        if (there[std::size_t(k)].ground == here->ground->height) return k;
    return std::nullopt;
}

std::optional<SettledPose> Reach::next_stop(const SettledPose& from, const Vec2& to, double yaw) const
{
    std::optional<SettledPose> out;
    double least = infinity;
    for (const double height : column_at(judge_.map().geometry, to.x(), to.y()).layers) {
        if (!judge_.map().z_limits.contains(height, 0)) continue;
        const SettledPose there = judge_.settle({to.x(), to.y(), height}, yaw);
        if (there.verdict != Verdict::Valid) continue;
        const double size = step(from.position.head<2>(), from.ground->height, to, height);
        if (size >= least) continue;
        least = size;
        out = there;
    }
    if (!out || least > *options_.max_step + 1e-9) return std::nullopt;
    const Course straight{from.position.head<2>(), to, from.yaw, std::remainder(yaw - from.yaw, 2 * std::numbers::pi)};
    return can_follow(straight, from, *out) ? out : std::nullopt;
}

Reach::Course Reach::course(const State& from, const State& to, Way way) const
{
    const double yaw = yaw_of(from[3]);
    Course out{at(from[0], from[1]), at(to[0], to[1]), yaw, std::remainder(yaw_of(to[3]) - yaw, 2 * std::numbers::pi)};
    if (is_curve(way)) out.corner = out.begin + grid_.step * vector_of(lattice_.corner(way, from[3]));
    return out;
}

double Reach::length(const Course& course)
{
    if (!course.corner) return (course.end - course.begin).norm();
    const double first = (*course.corner - course.begin).norm(), last = (course.end - *course.corner).norm(),
                 tangent = std::min(first, last), turn = std::abs(course.turn);
    return first + last - 2 * tangent + turn * tangent / std::tan(turn / 2);
}

/// In a curve: the point of the circle that touches both lines, or of the rest of the longer line.
std::pair<Vec2, double> Reach::at(const Course& course, double part)
{
    if (!course.corner) return {course.begin + part * (course.end - course.begin), course.yaw + part * course.turn};
    const Vec2 corner = *course.corner, ahead = (corner - course.begin).normalized(),
               beyond = (course.end - corner).normalized(), left(-ahead.y(), ahead.x());
    const double tangent = std::min((corner - course.begin).norm(), (course.end - corner).norm()),
                 turn = std::abs(course.turn), radius = tangent / std::tan(turn / 2);
    const Vec2 arc_begin = corner - tangent * ahead, arc_end = corner + tangent * beyond,
               centre = arc_begin + (course.turn > 0 ? radius : -radius) * left;
    double driven = part * length(course);
    if (driven <= (arc_begin - course.begin).norm()) return {course.begin + driven * ahead, course.yaw};
    driven -= (arc_begin - course.begin).norm();
    if (driven >= radius * turn) return {arc_end + (driven - radius * turn) * beyond, course.yaw + course.turn};
    const double angle = (course.turn > 0 ? 1 : -1) * driven / radius;
    return {centre + Eigen::Rotation2Dd(angle) * (arc_begin - centre), course.yaw + angle};
}

/// Returns whether the robot meets nothing between two poses: in few pieces, or if that is not enough, in many.
bool Reach::can_follow(const Course& course, const SettledPose& a, const SettledPose& b) const
{
    for (const int count : pieces(a, b, course.turn != 0)) {
        std::vector<Posed> poses;
        for (int k = 0; k <= count; ++k) {
            const double t = double(k) / count, u = 1 - t;
            const auto [place, yaw] = at(course, t);
            poses.push_back({{place.x(), place.y(), u * a.position.z() + t * b.position.z()},
                             u * a.roll + t * b.roll,
                             u * a.pitch + t * b.pitch,
                             yaw});
        }
        if (is_possible(poses)) return true;
    }
    return false;
}

/// Returns whether the robot meets nothing between these poses if it is raised by the lift, or by the largest step.
bool Reach::is_possible(const std::vector<Posed>& poses) const
{
    const double lift = judge_.options().stand.lift, higher = *options_.max_step;
    if (is_free(poses, lift, lift)) return true;
    return higher > lift && is_free(poses, higher, higher) && is_free({poses.front(), poses.front()}, lift, higher) &&
           is_free({poses.back(), poses.back()}, lift, higher);
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
