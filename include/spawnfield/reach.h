#pragma once

#include <spawnfield/judge.h>

#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace spawnfield {

/// All values are those that were given, those of Robot::drive, or the defaults, in this order.
struct ReachOptions {
    std::optional<Drive> drive = {};  ///< default: Differential
    /// m, >= 0; largest step up or down in the ground that the robot overcomes. See ReachGraph. Default: a quarter of
    /// the wheel radius; 0.03 m if that is not known. A legged robot has no default.
    std::optional<double> max_step = {};
    std::optional<double> turning_radius = {};  ///< m, > 0; only for a car, which has no default
    /// m between columns, > 0; no value: auto_reach_step().
    std::optional<double> step = {};
    /// Whether all ways are examined and kept, for PathSearch: 64 bytes for each place (Omni: 80), and a longer time.
    /// Otherwise, only those are examined that may join islands, and none is kept.
    bool keep_ways = false;
    int threads = 0;  ///< 0: all cores; results are the same for any number
    Progress progress = {};
};

/// A part of the ground within which a robot can drive from any place to any other.
struct Island {
    double area = 0;            ///< m2: number of its places, multiplied by step * step
    double share = 0;           ///< of all places on which the robot can stand, 0 .. 1
    Vec3 place = Vec3::Zero();  ///< the place on its ground that is nearest to the middle of the island, m
    double low = 0, high = 0;   ///< heights of its lowest and its highest ground, m
};

/// A place of the graph: a layer of a column on which the robot can stand.
struct ReachPlace {
    double x, y, ground;   ///< m; ground: height of the layer
    std::uint32_t island;  ///< index in ReachGraph::islands(): the largest island of its headings
};

/// The drivable graph of a map and a robot: where it can stand, and where it can drive from there.
///
/// States are valid settled poses (see docs/standing.md) on a grid of columns, on each layer, at 16 headings: those in
/// which a straight way leads to another column after one or two columns or rows. There is an edge between two states
/// if there is a way from one to the other:
///
/// - a turn on the spot, to the next heading; not with Drive::Car;
/// - straight ahead, to the next column in its heading; with Drive::Omni and Drive::Legged also straight to the left;
/// - a curve ahead, to the next heading or the one before. If m is the straight way at the first heading, and n the one
///   at the last heading, it leads from column A to column A + i m + k n. The corner between both lines is replaced by
///   an arc that touches them, as large as possible. The robot looks along the curve. For a car, i and k are the least
///   numbers with which the radius of the arc is at least its turning radius; for others they are 1.
///
/// The robot can go if
///
/// - the step in the ground between the two columns is at most max_step. Without a step, the ground would rise by
///   something between d * s and d * t, where d is the distance, and s and t are the slopes at both columns, in the
///   direction of the other one, measured over 1 mm. What it rises more or less than that is the step. Slopes steeper
///   than StandLimits::max_slope count as 0, so they are steps. In a curve, there are two steps: to the column A + m,
///   and from there. The robot must also stand there, at the first or the last heading. Curves of cars are cut into
///   pieces of at most a step of the grid, at whose ends the robot must stand; each piece is a way of its own;
/// - the robot meets no surface on the way. For that, it is raised by StandLimits::lift. If it meets something then, it
///   is raised by max_step, if it can be raised by so much at both ends. Each convex part of it covers the convex hull
///   of the part at both poses. If the heading changes, or if roll or pitch change by more than 0.1 rad, the way has
///   four such pieces; z, roll and pitch change evenly. If these hulls meet something, and the robot tilts, it has so
///   many pieces that no point of the robot moves by more than 1 cm in a piece because it tilts. If that is not enough
///   on a straight way, the robot is also let down at three places between its ends; then each quarter of the way must
///   comply with these rules, and the last one must lead to the same layer.
///
/// If a column has several layers with a state at the heading, a way leads to the one with the smallest step.
///
/// Robots go back the same way, so edges have no direction. Islands are the connected parts of the graph. In a narrow
/// corridor, in which a robot cannot turn, two islands have the same places at opposite headings.
///
/// Cheap to copy: copies share the graph. Any number of threads may call its const methods at the same time.
class SPAWNFIELD_API ReachGraph {
public:
    /// Throws ArgumentError for options beyond their limits, for more than 2^31 columns, and if JudgeOptions::obstacles
    /// is Voxels. Throws FileError for a damaged map.
    ReachGraph(const Judge& judge, const ReachOptions& options = {});

    const ReachOptions& options() const;  ///< with the step that was used
    /// The islands, the largest first. Of equally large ones, the first one has the place with the smallest y, then x.
    std::span<const Island> islands() const;
    /// The places on which the robot can stand at one heading or more: row by row, y ascending; in a row, x ascending;
    /// in a column, from the top down.
    std::vector<ReachPlace> places() const;

    /// Returns the island of a valid settled pose (not raised): that of the first state to which it can go. These are
    /// tried: the states of the four columns around it, the nearest column first, and there the two headings around its
    /// yaw, the nearer one first.
    std::optional<std::size_t> island_of(const SettledPose& pose) const;

    struct Impl;
    explicit ReachGraph(std::shared_ptr<const Impl> impl) : impl_(std::move(impl)) {}
    std::shared_ptr<const Impl> impl() const { return impl_; }  ///< for the library itself

private:
    std::shared_ptr<const Impl> impl_;
};

/// Returns options with all values. Throws ArgumentError for values beyond their limits, and if a legged robot has no
/// max_step or a car no turning_radius.
SPAWNFIELD_API ReachOptions with_defaults(const ReachOptions& options, const Robot& robot);

/// Returns a quarter of the smallest width of the robot, seen from above, m: half of the inscribed radius of its
/// footprint.
SPAWNFIELD_API double auto_reach_step(const Robot& robot);

}  // namespace spawnfield
