#pragma once

#include <spawnfield/pairs.h>
#include <spawnfield/poses.h>

#include <string>
#include <string_view>
#include <vector>

/// Files of start and goal pairs.
namespace spawnfield {

/// Pairs of a CSV file. Both tables have the same rows.
struct PairTable {
    PoseTable starts, goals;
};

/// Reads pairs with the columns of pairs_csv(): start_x, … and goal_x, …, as in parse_poses(). Other columns are
/// copied. Throws what parse_poses() throws.
SPAWNFIELD_API PairTable parse_pairs(std::string_view text, const std::string& name, bool allow_empty = false);

/// Returns a table with start_x,start_y,start_z,start_roll,start_pitch,start_yaw, the same of the goal (goal_x, …), and
/// path_length,straight,detour,island. m and rad; poses are raised by StandLimits::lift.
SPAWNFIELD_API std::string pairs_csv(const PairList& list, double lift);

/// Returns a table with pair,pose,x,y,z,roll,pitch,yaw: the poses of all paths, raised by the lift. Pairs and poses
/// count from 0.
SPAWNFIELD_API std::string paths_csv(const PairList& list, double lift);

/// Returns a JSON object with `format`: "spawnfield-pairs/1", the map, the robot and the settings as in spawns_json(),
/// and `pairs`: `start` and `goal` as the poses there, raised by StandLimits::lift, and the other columns of
/// pairs_csv().
SPAWNFIELD_API std::string pairs_json(const PairList& list, const Judge& judge, const PairOptions& options);

/// Returns an episode dataset of Habitat (PointNav-v1: gzip of JSON). Positions are those of the ground, as on
/// Habitat's navigation mesh, in its frame: x to the right, y up, z backwards; a point (x, y, z) of the map is (x, z,
/// -y) there. Rotations are about the vertical axis. `geodesic_distance` is the length of the path. Source:
/// PointNavDatasetV1 of habitat-lab.
SPAWNFIELD_API std::string habitat_episodes(const PairList& list, const std::string& scene_id);

/// Returns a YAML list for Nav2: `start` and `goal` are geometry_msgs/PoseStamped in the frame `map`, on the ground and
/// level, and `path_length` (m).
SPAWNFIELD_API std::string nav2_goals(const PairList& list);

}  // namespace spawnfield
