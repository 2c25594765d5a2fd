#pragma once

#include "reach/reach_graph.h"

#include <optional>
#include <vector>

namespace spawnfield {

/// A place on the ground at which the robot stands with a yaw (rad).
struct Stop {
    Vec3 ground;  ///< m
    double yaw;
};

/// Examines whether a robot can drive straight from one stop of a drivable graph to another one, for one thread: it
/// turns on the spot, drives, and turns again. These ways are cut into pieces of at most a reach step, and turns into
/// pieces of at most a sixteenth of a turn. Each piece must comply with the rules for the ways of the graph.
class StraightWays {
public:
    explicit StraightWays(const ReachGraph::Impl& graph) : graph_(graph) {}

    /// Returns the stops on the way, from `from` to `to`, or nothing if the robot cannot drive there. The ground at the
    /// end is that to which the ground leads; only its x, y are taken from `to`, if `ends_anywhere` is set. Otherwise,
    /// the robot cannot drive to other ground than that of `to`.
    std::optional<std::vector<Stop>> find(const Stop& from, const Stop& to, bool ends_anywhere = false);

private:
    std::optional<RobotAtRest> go(const Vec2& to, double yaw);
    bool turn(double yaw);
    bool drive(const Vec2& to);
    std::optional<double> open_ground(const Vec2& at, double ground) const;
    void add(const Vec3& ground, double yaw, std::optional<RobotAtRest> standing);

    const ReachGraph::Impl& graph_;
    std::vector<Stop> way_;                ///< up to where the robot is
    std::optional<RobotAtRest> standing_;  ///< how it stands there; nothing: not known yet
    bool is_open_ = false;                 ///< whether all ways of a reach step from there are free
};

}  // namespace spawnfield
