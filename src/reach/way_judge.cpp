#include "reach/way_judge.h"

#include "reach/head_room.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace spawnfield {
namespace {

constexpr double slope_arm = 1e-3;    // m: the slope of the ground at a column is measured over this length
constexpr double limit_slack = 1e-9;  // m, in comparisons with limits
constexpr double room_slack = 1e-4;   // m: more than any contact is off its surface
constexpr int turn_pieces = 4;        // of a way on which the robot turns
constexpr double large_tilt = 0.1;    // rad: if roll or pitch change by more, a way has as many pieces
constexpr int kink_pieces = 4;        // of a straight way on which the robot is let down between its ends
/// m: the hull of a robot that tilts between two poses is at most half as much thicker than the robot.
constexpr double small_motion = 0.01;

/// Returns the direction of a heading, of length 1.
Vec2 direction_of(int heading)
{
    const LatticeMove move = lattice_move(heading);
    return Vec2(move.cols, move.rows) / move.length();
}

StatePose state_of(const SettledPose& pose) { return {.z = pose.position.z(), .roll = pose.roll, .pitch = pose.pitch}; }

/// Returns into how many pieces a way is cut so that the hulls of the robot are not much larger than what it covers:
/// few, and if that is not enough, many. `radius`: distance of its farthest point from its origin, m.
std::array<int, 2> pieces_between(const Course& course, const StatePose& pose, const StatePose& other, double radius)
{
    const double tilt = std::max(std::abs(pose.roll - other.roll), std::abs(pose.pitch - other.pitch));
    const int few = course.turn != 0 || tilt > large_tilt ? turn_pieces : 1;
    return {few, std::max(few, int(std::ceil(tilt * radius / small_motion)))};
}

}  // namespace

Curve Course::curve() const
{
    return curve_in_corner((*corner - begin).norm(), (end - *corner).norm(), std::abs(turn));
}

double Course::length() const { return corner ? curve().length() : (end - begin).norm(); }

std::pair<Vec2, double> Course::at(double t) const
{
    if (!corner) return {begin + t * (end - begin), yaw + t * turn};
    const Curve parts = curve();
    const double driven = t * parts.length();
    const Vec2 ahead = (*corner - begin).normalized();
    if (driven <= parts.first) return {begin + driven * ahead, yaw};
    if (driven >= parts.first + parts.arc)
        return {end - (parts.length() - driven) * (end - *corner).normalized(), yaw + turn};
    const double angle = (driven - parts.first) / parts.radius(), side = turn > 0 ? 1 : -1;
    const Vec2 aside = side * Vec2(-ahead.y(), ahead.x());
    return {begin + parts.first * ahead + parts.radius() * (std::sin(angle) * ahead + (1 - std::cos(angle)) * aside),
            yaw + side * angle};
}

WayJudge::WayJudge(const Judge::Impl& shared, double max_step, const Lattice& lattice, double step)
    : shared_(shared), lattice_(lattice), max_step_(max_step), step_(step), longest_way_(lattice.longest() * step),
      radius_(shared.settler().reach()), steepest_(std::tan(shared.options.stand.max_slope)),
      head_room_(shared.options.exhaustive ? 0 : least_head_room(shared.robot, shared.options.stand.max_slope)),
      stand_(shared), columns_(shared, 0), level_(shared), sweep_(shared.map.geometry, shared.robot)
{
    for (const Way way : all_ways)
        for (int heading = 0; heading < lattice_headings; ++heading)
            rises_[std::size_t(way)][std::size_t(heading)] = rise_of(way, heading);
}

Course WayJudge::course_of(const StateAt& from, const StateAt& to, Way way) const
{
    const double yaw = lattice_yaw(from.heading);
    Course out{.begin = from.at, .end = to.at, .yaw = yaw, .turn = turn_between(yaw, lattice_yaw(to.heading))};
    if (!is_curve(way)) return out;
    const LatticeMove corner = lattice_.corner(way, from.heading);
    out.corner = from.at + step_ * Vec2(corner.cols, corner.rows);
    return out;
}

void WayJudge::find_places(const Vec2& at, std::vector<PlaceStates>& out, DetailsStore& details)
{
    const std::size_t first = out.size();
    std::size_t next = details.size();  // of the first place with details
    const ColumnView column(columns_.column_at(at));
    bool has_solids = false;
    for (const double height : heights_within(column.layers, shared_.map.z_limits)) {
        if (!has_head_room(column, height)) continue;
        PlaceStates place{.ground = height};
        bool is_level = level_.is_possible();
        if (is_level && !has_solids) {
            level_.set_place(at, radius_ + longest_way_);
            has_solids = true;
        }
        is_level = is_level && level_.set_layer(height) && is_proven(column, {at.x(), at.y(), height});
        place.is_clear = is_level && level_.is_clear();
        place.is_open = place.is_clear && level_.is_open();
        if (place.is_open) {
            place.level_z = level_.z();
            place.valid = HeadingSet(~0u);
            out.push_back(place);
            continue;
        }
        PlaceDetails& known = details.emplace_back();
        for (int heading = 0; heading < lattice_headings; ++heading) {
            StatePose& state = known.poses[std::size_t(heading)];
            if (is_level && level_.stands_at(heading)) {
                state = {.z = level_.z(), .is_exact = false};
            } else if (is_level && level_.tips_at(heading)) {
                continue;
            } else {
                const SettledPose pose = stand_.judge(column, {at.x(), at.y(), height}, lattice_yaw(heading));
                if (pose.verdict != Verdict::Valid) continue;
                state = {.z = pose.position.z(), .roll = pose.roll, .pitch = pose.pitch};
            }
            place.valid |= HeadingSet(1u << heading);
        }
        if (place.valid == 0) {
            details.pop_back();
            continue;
        }
        place.details = &known;
        out.push_back(place);
    }
    // Only now, because this looks up other columns.
    for (const PlaceStates& place : std::span(out).subspan(first)) {
        if (place.is_open) continue;
        PlaceDetails& known = details[next++];
        for (int heading = 0; heading < lattice_headings; ++heading)
            known.slopes[std::size_t(heading)] = slope_at(at, place.ground, direction_of(heading));
    }
}

std::optional<PlaceStates> WayJudge::place_of_all(const Vec2& low, const Vec2& high)
{
    if (!level_.is_possible()) return std::nullopt;
    const double half = ((high - low) / 2).maxCoeff();
    const auto ground = level_.flat_ground((low + high) / 2, half + radius_ + longest_way_, head_room_ - room_slack);
    if (!ground) return std::nullopt;
    // What LevelGround does not examine is the same for all columns, and known from those in the corners.
    std::vector<PlaceStates> places;
    DetailsStore details;
    for (const Vec2& corner : {low, Vec2(low.x(), high.y()), Vec2(high.x(), low.y()), high})
        find_places(corner, places, details);
    const auto is_it = [&](const PlaceStates& place) { return place.is_open && place.ground == *ground; };
    return places.size() == 4 && std::all_of(places.begin(), places.end(), is_it) ? std::optional(places[0])
                                                                                  : std::nullopt;
}

/// Returns whether the next surface above a layer of a column leaves room for the robot. False: it stands there at no
/// heading.
bool WayJudge::has_head_room(const ColumnView& column, double height) const
{
    return head_room_ == 0 || std::none_of(column.spans.begin(), column.spans.end(), [&](const Span& span) {
               return span.top > height + layer_tolerance && span.bottom < height + head_room_ - room_slack;
           });
}

/// Returns whether a place has what LevelGround does not examine: ground that can be used, also for the robot at rest,
/// and nothing filled around it.
bool WayJudge::is_proven(const ColumnView& column, const Vec3& place)
{
    Judgement there, at_rest;
    const Vec3 raised(place.x(), place.y(), level_.z() + shared_.options.stand.lift);
    const bool is_inside = shared_.map.z_limits.contains(raised.z() - LevelGround::tolerance, 0) &&
                           shared_.map.z_limits.contains(raised.z() + LevelGround::tolerance, 0);
    if (!is_inside || !columns_.judge_ground(column, place, there) || !columns_.judge_ground(column, raised, at_rest))
        return false;
    const double above = place.z() + level_.flatness();
    if (at_rest.ground->height > above) return false;
    return std::none_of(column.spans.begin(), column.spans.end(),
                        [&](const Span& span) { return span.top > above && span.bottom <= raised.z(); });
}

std::optional<std::size_t> WayJudge::place_ahead(const Vec2& from, const PlaceStates& place, const Vec2& to,
                                                 std::span<const PlaceStates> others, int direction, int at_heading)
{
    // On level ground, the step cannot be larger.
    if (others.size() == 1 && (place.is_open || others[0].is_open) && are_level(place, others[0]))
        return has_heading(others[0].valid, at_heading) ? std::optional<std::size_t>(0) : std::nullopt;
    return lowest_step((to - from).norm(), place.ground, others, at_heading,
                       [&] { return slope_at(from, place, direction); },
                       [&](const PlaceStates& other) { return slope_at(to, other, opposite(direction)); });
}

double WayJudge::rise_of(Way way, int heading) const
{
    // The two straight ways of a curve are longer than the straight line between its ends. A curve of a car has more
    // pieces than two only if it is longer than two steps.
    const double length = step_ * lattice_.length(way, heading);
    return std::numbers::sqrt2 * length * steepest_ +
           std::max(2, pieces_of_curve(way, heading)) * (max_step_ + limit_slack);
}

int WayJudge::pieces_of_curve(Way way, int heading) const
{
    return int(std::ceil(lattice_.length(way, heading) - limit_slack));
}

/// Returns the index of the place with the smallest step that has a state at a heading, if the step is at most
/// max_step. `length`: between the columns, m. `slope` and `other_slope` return the slopes at the ends of the way, each
/// in the direction of the other end.
template <class Slope, class OtherSlope>
std::optional<std::size_t> WayJudge::lowest_step(double length, double ground, std::span<const PlaceStates> others,
                                                 int heading, const Slope& slope, const OtherSlope& other_slope) const
{
    double least = std::numeric_limits<double>::infinity();
    std::size_t best = 0;
    for (std::size_t k = 0; k < others.size(); ++k) {
        const double rise = others[k].ground - ground;
        if (!has_heading(others[k].valid, heading) || std::abs(rise) > length * steepest_ + max_step_ + limit_slack)
            continue;
        double step = std::abs(rise);
        if (length > 0) {
            const double s = length * slope(), t = -length * other_slope(others[k]);
            step = std::max({0.0, rise - std::max(s, t), std::min(s, t) - rise});
        }
        if (!(step < least)) continue;
        least = step;
        best = k;
    }
    return least <= max_step_ + limit_slack ? std::optional(best) : std::nullopt;
}

/// Returns the slope of the ground at a place in the direction of a heading.
double WayJudge::slope_at(const Vec2& at, const PlaceStates& place, int heading)
{
    return place.is_open ? slope_at(at, place.ground, direction_of(heading))
                         : place.details->slopes[std::size_t(heading)];
}

/// Returns the slope of the ground at a place in a direction; 0 if it is steeper than the robot may stand on, or if it
/// ends there.
double WayJudge::slope_at(const Vec2& at, double ground, const Vec2& ahead)
{
    double nearest = steepest_ * slope_arm + limit_slack, out = 0;
    for (const double height : columns_.column_at(at + slope_arm * ahead).layers) {
        if (!(std::abs(height - ground) <= nearest)) continue;
        nearest = std::abs(height - ground);
        out = (height - ground) / slope_arm;
    }
    return out;
}

/// Prepares for ways that begin at a place.
void WayJudge::set_start(const Vec2& at)
{
    if (start_ == at) return;
    sweep_.set_place(at, radius_ + longest_way_);
    start_ = at;
}

bool WayJudge::can_go(const StateAt& from, const StateAt& to, Way way)
{
    if (is_open(from, to)) return true;
    set_start(from.at);
    const StatePose pose = from.place.pose(from.heading), other = to.place.pose(to.heading);
    const Course course = course_of(from, to, way);
    if (pose.is_exact && other.is_exact)
        return can_follow(course, pose, other) || passes_kink(from, to, pose, other, way);
    const int few = pieces_between(course, pose, other, radius_).front();
    if (is_free(course, pose, other, few, shared_.options.stand.lift)) return true;
    const StatePose exact = exact_pose(from), exact_other = exact_pose(to);
    return can_follow(course, exact, exact_other) || passes_kink(from, to, exact, exact_other, way);
}

/// Returns whether the robot can go straight over a kink of the ground, on which it tilts, if it is also let down
/// between the two states.
bool WayJudge::passes_kink(const StateAt& from, const StateAt& to, const StatePose& pose, const StatePose& other,
                           Way way)
{
    if (way != Way::Ahead && way != Way::Aside) return false;
    const auto [few, many] = pieces_between(course_of(from, to, way), pose, other, radius_);
    if (many == few) return false;
    const std::vector<RobotAtRest> stops = follow(from, to, way, kink_pieces);
    return !stops.empty() && stops.back().ground.z() == to.place.ground;
}

std::vector<RobotAtRest> WayJudge::follow(const StateAt& from, const StateAt& to, Way way, int pieces)
{
    const Course course = course_of(from, to, way);
    set_start(from.at);
    std::vector<RobotAtRest> out;
    auto standing = stand({from.at.x(), from.at.y(), from.place.ground}, course.yaw);
    for (int k = 1; k <= pieces && standing; ++k) {
        const auto [at, yaw] = k < pieces ? course.at(double(k) / pieces) : std::pair(to.at, lattice_yaw(to.heading));
        standing = go_prepared(*standing, at, yaw);
        if (standing) out.push_back(*standing);
    }
    return standing ? out : std::vector<RobotAtRest>();
}

/// Returns whether the robot meets nothing on a way between two poses, both of which are exact.
bool WayJudge::can_follow(const Course& course, const StatePose& pose, const StatePose& other)
{
    const auto [few, many] = pieces_between(course, pose, other, radius_);
    const auto is_possible = [&](int pieces) {
        return is_free(course, pose, other, pieces, shared_.options.stand.lift) ||
               can_climb(course, pose, other, pieces);
    };
    return is_possible(few) || (many > few && is_possible(many));
}

/// Returns whether the robot can be raised by max_step at both ends of a way, and then meets nothing.
bool WayJudge::can_climb(const Course& course, const StatePose& pose, const StatePose& other, int pieces)
{
    const double lift = shared_.options.stand.lift;
    if (!(max_step_ > lift) || !is_free(course, pose, other, pieces, max_step_)) return false;
    const auto can_rise = [&](const Pose& settled) {
        const Pose low{settled.position + lift * Vec3::UnitZ(), settled.rotation},
            high{settled.position + max_step_ * Vec3::UnitZ(), settled.rotation};
        return sweep_.is_free(std::array{low, high}, 0);
    };
    return can_rise(poses_.front()) && can_rise(poses_.back());
}

/// The same from the ground below a settled pose to a column, with the slopes in their directions.
std::optional<std::size_t> WayJudge::lowest_step(const Vec3& from_ground, const Vec2& to,
                                                 std::span<const PlaceStates> others, int heading)
{
    const Vec2 from = from_ground.head<2>();
    const double ground = from_ground.z(), length = (to - from).norm();
    const Vec2 ahead = (to - from) / length;  // not used if the length is 0
    return lowest_step(
        length, ground, others, heading, [&] { return slope_at(from, ground, ahead); },
        [&](const PlaceStates& other) { return slope_at(to, other.ground, -ahead); });
}

std::optional<std::size_t> WayJudge::place_near(const SettledPose& pose, const Vec2& to,
                                                std::span<const PlaceStates> places, int heading)
{
    const Vec2 from = pose.position.head<2>();
    const auto k = lowest_step({from.x(), from.y(), pose.ground->height}, to, places, heading);
    if (!k) return std::nullopt;
    const Course course{
        .begin = from, .end = to, .yaw = pose.yaw, .turn = turn_between(pose.yaw, lattice_yaw(heading))};
    set_start(from);
    return can_follow(course, state_of(pose), settled(to, places[*k].ground, heading)) ? k : std::nullopt;
}

std::optional<double> WayJudge::ground_near(const Vec3& place, double most)
{
    std::optional<double> out;
    for (const double height : columns_.column_at(place.head<2>()).layers) {
        if (!(std::abs(height - place.z()) <= most)) continue;
        most = std::abs(height - place.z());
        out = height;
    }
    return out;
}

std::optional<RobotAtRest> WayJudge::stand(const Vec3& ground, double yaw)
{
    return stand(ColumnView(columns_.column_at(ground.head<2>())), ground, yaw);
}

/// The same for the ground in a column. The robot is let down only if nothing is proven there.
std::optional<RobotAtRest> WayJudge::stand(const ColumnView& column, const Vec3& ground, double yaw)
{
    if (level_.is_possible()) {
        level_.set_place(ground.head<2>(), radius_ + step_);
        if (level_.set_layer(ground.z()) && level_.stands(yaw) && is_proven(column, ground))
            return RobotAtRest{ground, yaw, {.z = level_.z(), .is_exact = false}};
    }
    const SettledPose pose = stand_.judge(column, ground, yaw);
    if (pose.verdict != Verdict::Valid) return std::nullopt;
    return RobotAtRest{{ground.x(), ground.y(), pose.ground->height}, yaw, state_of(pose)};
}

std::optional<RobotAtRest> WayJudge::go(const RobotAtRest& from, const Vec2& to, double yaw)
{
    set_start(from.ground.head<2>());
    return go_prepared(from, to, yaw);
}

/// The same if set_start() was called for a place near both ends.
std::optional<RobotAtRest> WayJudge::go_prepared(const RobotAtRest& from, const Vec2& to, double yaw)
{
    const Vec2 begin = from.ground.head<2>();
    const double length = (to - begin).norm();
    std::vector<PlaceStates> places;
    std::vector<RobotAtRest> there;
    const ColumnView column(columns_.column_at(to));
    for (const double height : heights_within(column.layers, shared_.map.z_limits)) {
        if (std::abs(height - from.ground.z()) > length * steepest_ + max_step_ + limit_slack) continue;
        const auto standing = stand(column, {to.x(), to.y(), height}, yaw);
        if (!standing) continue;
        places.push_back({.ground = height, .valid = 1});
        there.push_back(*standing);
    }
    const auto k = lowest_step(from.ground, to, places, 0);
    if (!k) return std::nullopt;
    const Course course{.begin = begin, .end = to, .yaw = from.yaw, .turn = turn_between(from.yaw, yaw)};
    return can_follow(course, from, there[*k]) ? std::optional(there[*k]) : std::nullopt;
}

/// Returns whether the robot meets nothing on a way. It is let down only if that is not certain without.
bool WayJudge::can_follow(const Course& course, const RobotAtRest& from, const RobotAtRest& to)
{
    const int few = pieces_between(course, from.pose, to.pose, radius_).front();
    if (!(from.pose.is_exact && to.pose.is_exact) &&
        is_free(course, from.pose, to.pose, few, shared_.options.stand.lift))
        return true;
    return can_follow(course, exact_pose(from), exact_pose(to));
}

StatePose WayJudge::exact_pose(const RobotAtRest& standing)
{
    return standing.pose.is_exact ? standing.pose : state_of(stand_.judge(standing.ground, standing.yaw));
}

/// Returns the settled pose of a state.
StatePose WayJudge::exact_pose(const StateAt& state)
{
    const StatePose known = state.place.pose(state.heading);
    return known.is_exact ? known : settled(state.at, state.place.ground, state.heading);
}

StatePose WayJudge::settled(const Vec2& at, double ground, int heading)
{
    return state_of(stand_.judge({at.x(), at.y(), ground}, lattice_yaw(heading)));
}

bool WayJudge::is_free(const Course& course, const StatePose& pose, const StatePose& other, int pieces, double lift)
{
    const double growth = pose.is_exact && other.is_exact ? 0 : LevelGround::tolerance;
    poses_.clear();
    for (int k = 0; k <= pieces; ++k) {
        const double t = double(k) / pieces;
        const auto [at, yaw] = course.at(t);
        const auto between = [&](double a, double b) { return a + t * (b - a); };
        poses_.push_back({{at.x(), at.y(), between(pose.z, other.z)},
                          rotation_from_rpy(between(pose.roll, other.roll), between(pose.pitch, other.pitch), yaw)});
    }
    return sweep_.is_free(poses_, lift, growth);
}

}  // namespace spawnfield
