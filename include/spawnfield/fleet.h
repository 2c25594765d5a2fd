#pragma once

#include <spawnfield/export.h>
#include <spawnfield/formation.h>
#include <spawnfield/query.h>
#include <spawnfield/simulators.h>

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace spawnfield {

/// Some equal robots of a fleet.
struct FleetKind {
    std::string name;  ///< its robots are NAME_1, NAME_2, …; with a count of 1 the only one is NAME
    Judge judge;       ///< of the map, which all kinds share, and of this kind's robot
    std::optional<std::size_t> count = 1;  ///< 1 .. max_spawns; no value: as many as fit
    /// How robots of this kind are drawn. min_distance is that between two robots of this kind. These are not used:
    /// count, seed, threads, progress and stop. There must be no rules in `place` and `measures`.
    SampleOptions spawns = {};
    std::optional<Formation> formation = {};  ///< then yaw and heading of `spawns` are not used; needs a count
    /// m between the columns of the raster that is searched if draws find no place; > 0. No value: auto_fill_step().
    std::optional<double> fill_step = {};
};

/// A distance between the robots of two kinds, m >= 0. Kinds are indices in the list of kinds.
struct KindDistance {
    std::size_t first = 0, second = 0;
    double distance = 0;
};

struct FleetOptions {
    double min_distance = 0;  ///< m between any two robots, >= 0
    /// More distances. Distances are measured between the origins, in 3D, as in sample(). Of all that apply to two
    /// robots, the largest one counts.
    std::vector<KindDistance> between = {};
    std::optional<Formation> formation = {};  ///< of all robots together, kind by kind; each kind needs a count
    std::uint64_t seed = 0;
    int threads = 0;  ///< 0: all cores; results are the same for any number
    Progress progress = {};
    StopRequest stop = {};  ///< see Fleet::is_stopped

    bool is_stopped() const { return stop && stop(); }
};

struct FleetRobot {
    std::string name;
    std::size_t kind = 0;  ///< index in the list of kinds
    Spawn spawn = {};
    SpawnRest rest = {};  ///< of settled robots
};

/// The raster that was searched when draws found no place. All its poses were examined: each valid one overlaps a robot
/// of the fleet, or is too near to one or to an avoided point. So no robot of the kind can be added at any of them.
struct FleetProof {
    double step = 0;           ///< m between its columns
    std::size_t headings = 0;  ///< number of yaws (or rules of headings) at each layer of a column
    std::uint64_t poses = 0;   ///< number of its poses at all headings
    std::uint64_t valid = 0;   ///< those that are valid
};

/// What was done for one kind.
struct FleetKindResult {
    std::size_t found = 0;
    std::uint64_t draws = 0;               ///< valid poses that were drawn
    std::uint64_t overlapping = 0;         ///< those among them that overlap a robot, and are not too near to one
    std::uint64_t too_close = 0;           ///< those among them that are too near to a robot
    std::uint64_t exact_checks = 0;        ///< of poses, against the scene
    std::optional<FleetProof> proof = {};  ///< only if fewer than `count` were found, or without a count
    std::string why = {};                  ///< why a formation has no place; in words for the user
};

struct Fleet {
    std::vector<FleetRobot> robots;  ///< kind by kind
    std::vector<FleetKindResult> kinds;
    /// Robots or proofs are missing because the options' `stop` returned true. The robots of each kind are the first
    /// ones of the whole fleet; formations are complete or missing.
    bool is_stopped = false;
};

/// Returns valid poses of several kinds of robots, none of which overlaps another one.
///
/// Two robots overlap if FCL finds that their shapes touch or overlap at their poses (raised by StandLimits::lift if
/// they are settled), as in CollisionChecker for a robot and an obstacle. Formations are placed first, then kinds with
/// a count, and then those without, the largest robots first. The poses of a kind are drawn by sample(), uniformly by
/// area, and kept if there is room. When few draws have room, all poses of a raster are examined in a random order, at
/// each of these headings: the yaw or the rule of the options; with HeadingRule::Any, each of its headings; for a
/// random yaw, 16 headings. So when fewer than `count` robots are found, or without a count, it is proven that no robot
/// can be added at these poses. It is not proven that no other choice of poses has more robots.
///
/// A formation is complete or missing. Its robots stand on the layers that are nearest to the ground of the first
/// robot. If its place is not given, places for the first robot are drawn until all robots have room; then all poses of
/// the raster are tried.
///
/// Throws ArgumentError for options beyond their limits, FileError for a damaged map.
SPAWNFIELD_API Fleet place_fleet(std::span<const FleetKind> kinds, const FleetOptions& options);

/// Returns a quarter of the smallest width of the robot, seen from above, m, or so much more that the rasters of all
/// headings in the bounds and the area of the options have at most 200,000 columns.
SPAWNFIELD_API double auto_fill_step(const FleetKind& kind);

/// Returns whether two robots touch or overlap at these poses: see place_fleet().
SPAWNFIELD_API bool robots_overlap(const Robot& a, const Pose& scene_from_a, const Robot& b, const Pose& scene_from_b);

/// Returns the island of the graph that has most ground in common with an island of another graph, or nothing if it
/// has none in common. Two places have common ground if they are at most one step of the coarser graph apart, in 3D.
SPAWNFIELD_API std::optional<std::size_t> linked_island(const ReachGraph& graph, const ReachGraph& other,
                                                        std::size_t island_of_other);

/// Returns name,kind,x,y,z,roll,pitch,yaw of each robot; m and rad.
SPAWNFIELD_API std::string fleet_csv(const Fleet& fleet, std::span<const FleetKind> kinds);

/// Returns JSON with `format`: "spawnfield-fleet-poses/1", the map, the settings, and for each kind its robot,
/// settings, the numbers of robots wanted and found, and the proof; and the poses of `robots`, which are those of the
/// fleet.
SPAWNFIELD_API std::string fleet_json(const Fleet& fleet, std::span<const FleetKind> kinds, const FleetOptions& options,
                                      std::span<const RobotStart> robots);

/// Returns the robots at their poses.
SPAWNFIELD_API std::vector<RobotStart> robot_starts(const Fleet& fleet);

}  // namespace spawnfield
