#pragma once

#include "query/stand_judge.h"
#include "reach/lattice.h"
#include "reach/level_ground.h"
#include "reach/sweep.h"

#include <spawnfield/reach.h>

#include <array>
#include <cmath>
#include <deque>
#include <limits>
#include <numbers>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace spawnfield {

/// Returns by how much a robot turns from one yaw to another one, -pi .. pi, rad.
inline double turn_between(double yaw, double other) { return std::remainder(other - yaw, 2 * std::numbers::pi); }

/// A settled pose; x, y and yaw are known from where it is.
struct StatePose {
    double z = 0, roll = 0, pitch = 0;  ///< m and rad; not raised
    bool is_exact = true;               ///< false: known to LevelGround::tolerance
};

/// What is known of the states of a place that is not open.
struct PlaceDetails {
    std::array<double, lattice_headings> slopes{};  ///< of the ground in the direction of each heading; > 0: upwards
    std::array<StatePose, lattice_headings> poses{};
};

/// The states of a place.
struct PlaceStates {
    double ground = 0;                      ///< height of the layer, m
    HeadingSet valid = 0;                   ///< at which the robot stands
    bool is_open = false;                   ///< there is nothing but level ground, as far as any way leads
    bool is_clear = false;                  ///< the same, but the ground may end there
    double level_z = 0;                     ///< m: of the robot's origin, if the place is open
    const PlaceDetails* details = nullptr;  ///< not if the place is open, or if only `ground` and `valid` are known

    StatePose pose(int heading) const
    {
        return is_open ? StatePose{.z = level_z, .is_exact = false} : details->poses[std::size_t(heading)];
    }
};
/// Details keep their addresses.
using DetailsStore = std::deque<PlaceDetails>;

/// A state with its place.
struct StateAt {
    Vec2 at;
    const PlaceStates& place;
    int heading;
};

/// Where a robot is at rest.
struct RobotAtRest {
    Vec3 ground;  ///< below its origin, m
    double yaw;   ///< rad
    StatePose pose;
};

/// How the position and the yaw of a robot change on a way.
struct Course {
    Vec2 begin, end;
    double yaw = 0, turn = 0;         ///< rad; at the beginning, and until the end
    std::optional<Vec2> corner = {};  ///< of a curve: where the straight lines ahead and back from its ends meet

    double length() const;  ///< m
    /// Returns the position and the yaw after a part t of the way. In a curve, the robot follows curve_in_corner() and
    /// looks along it.
    std::pair<Vec2, double> at(double t) const;

private:
    Curve curve() const;  ///< if there is a corner
};

/// Finds states, and examines the ways between them, for one thread. ReachGraph says which ways there are.
class WayJudge {
public:
    /// `step`: of the grid, m.
    WayJudge(const Judge::Impl& shared, double max_step, const Lattice& lattice, double step);

    /// Appends the places of a column, and their details.
    void find_places(const Vec2& at, std::vector<PlaceStates>& out, DetailsStore& details);
    /// Returns the only place that each column of a rectangle has, if it is open and the same for all of them, as far
    /// as that can be proven at once.
    std::optional<PlaceStates> place_of_all(const Vec2& low, const Vec2& high);

    /// Returns how much the ground may rise on a way, m.
    double largest_rise(Way way, int heading) const { return rises_[std::size_t(way)][std::size_t(heading)]; }

    /// Returns the index, in the next column `to` in the direction of a heading, of the place with the smallest step
    /// from this one; it has a state at `at_heading`. Returns nothing if all steps are larger than max_step.
    std::optional<std::size_t> place_ahead(const Vec2& from, const PlaceStates& place, const Vec2& to,
                                           std::span<const PlaceStates> others, int direction, int at_heading);

    /// Returns whether there is nothing that the robot could meet on a way from one state to another one. Where the
    /// ground may end between them, it must be proven that the robot is level in both.
    bool is_open(const StateAt& from, const StateAt& to) const
    {
        const auto is_level = [](const StateAt& state) { return !state.place.pose(state.heading).is_exact; };
        return (from.place.is_open || to.place.is_open ||
                ((from.place.is_clear || to.place.is_clear) && is_level(from) && is_level(to))) &&
               std::abs(from.place.ground - to.place.ground) <= 2 * level_.flatness();  // it may be another layer
    }
    /// Returns whether there are ways between two open places that are neighbours in a row or in a column of the grid,
    /// each the only place of its column.
    bool are_level(const PlaceStates& place, const PlaceStates& other) const
    {
        return std::abs(other.ground - place.ground) <= 2 * level_.flatness() && 3 * level_.flatness() <= max_step_;
    }
    /// Returns whether the robot meets nothing on a way from one state to another one.
    bool can_go(const StateAt& from, const StateAt& to, Way way);

    /// Drives along a way, in pieces of the same length, each of which complies with the rules for straight ways, with
    /// settled poses at both ends. Returns where it stands there, without the first place; nothing if the robot cannot
    /// go. It may end on another layer than that of `to`.
    std::vector<RobotAtRest> follow(const StateAt& from, const StateAt& to, Way way, int pieces);
    /// Returns into how many pieces a curve of a car is cut: of at most a step of the grid.
    int pieces_of_curve(Way way, int heading) const;

    /// Returns the index, in a column at most longest_way away, of the place to which the robot can go from a valid
    /// settled pose, where it then stands at a heading. The poses of the places are not used.
    std::optional<std::size_t> place_near(const SettledPose& pose, const Vec2& to, std::span<const PlaceStates> places,
                                          int heading);

    /// Returns the largest height by which ground that is proven to be level is not even, m.
    double flatness() const { return level_.flatness(); }
    /// Returns the height of the layer at (x, y) that is nearest to z, if it is at most `most` (m) away.
    std::optional<double> ground_near(const Vec3& place, double most);
    /// Returns how the robot is at rest on the ground at a place, if that is a valid settled pose.
    std::optional<RobotAtRest> stand(const Vec3& ground, double yaw);
    /// Returns where the robot stands at a point at most longest_way away, at a yaw at most a sixteenth of a turn away,
    /// if it can go there straight. As on the ways of a graph, it is on the layer with the smallest step.
    std::optional<RobotAtRest> go(const RobotAtRest& from, const Vec2& to, double yaw);

private:
    template <class Slope, class OtherSlope>
    std::optional<std::size_t> lowest_step(double length, double ground, std::span<const PlaceStates> others,
                                           int heading, const Slope& slope, const OtherSlope& other_slope) const;
    std::optional<std::size_t> lowest_step(const Vec3& from, const Vec2& to, std::span<const PlaceStates> others,
                                           int heading);
    std::optional<RobotAtRest> stand(const ColumnView& column, const Vec3& ground, double yaw);
    StatePose exact_pose(const RobotAtRest& standing);
    bool can_follow(const Course& course, const RobotAtRest& from, const RobotAtRest& to);
    double slope_at(const Vec2& at, const PlaceStates& place, int heading);
    double slope_at(const Vec2& at, double ground, const Vec2& ahead);
    bool has_head_room(const ColumnView& column, double height) const;
    bool is_proven(const ColumnView& column, const Vec3& place);
    double rise_of(Way way, int heading) const;
    void set_start(const Vec2& at);
    StatePose exact_pose(const StateAt& state);
    StatePose settled(const Vec2& at, double ground, int heading);
    Course course_of(const StateAt& from, const StateAt& to, Way way) const;
    bool passes_kink(const StateAt& from, const StateAt& to, const StatePose& pose, const StatePose& other, Way way);
    std::optional<RobotAtRest> go_prepared(const RobotAtRest& from, const Vec2& to, double yaw);
    bool can_follow(const Course& course, const StatePose& pose, const StatePose& other);
    bool can_climb(const Course& course, const StatePose& pose, const StatePose& other, int pieces);
    bool is_free(const Course& course, const StatePose& pose, const StatePose& other, int pieces, double lift);

    const Judge::Impl& shared_;
    const Lattice& lattice_;
    const double max_step_, step_, longest_way_;
    const double radius_;     ///< distance of the robot's farthest point from its origin, m
    const double steepest_;   ///< slope on which it may stand
    const double head_room_;  ///< at least so much is free above a place with a state, m; 0: unknown
    std::array<std::array<double, lattice_headings>, way_count> rises_{};  ///< see largest_rise()
    StandJudge stand_;
    PoseJudge columns_;
    LevelGround level_;
    Sweep sweep_;
    Vec2 start_ = Vec2::Constant(std::numeric_limits<double>::quiet_NaN());  ///< from where sweep_ examines ways
    std::vector<Pose> poses_;                                                ///< of the way that was examined last
};

}  // namespace spawnfield
