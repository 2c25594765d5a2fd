#pragma once

#include <spawnfield/export.h>
#include <spawnfield/query.h>
#include <spawnfield/repair.h>
#include <spawnfield/simulators.h>

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace spawnfield {

/// Poses of a CSV file, with the text of their rows.
struct PoseTable {
    std::string header;
    std::vector<std::string> rows;  ///< one for each pose, without the end of the line
    std::vector<Pose> poses;
    std::vector<std::string> notices;  ///< values that may be mistakes, for the user
};

/// Reads a header x,y,z,roll,pitch,yaw in any order, and a pose in each further line. Units are metres and radians;
/// columns roll_deg, pitch_deg, yaw_deg are in degrees. Angles default to 0. Columns qx,qy,qz,qw may replace the
/// angles. The text of other columns is kept. Throws FileError, which names line and column; without `allow_empty`,
/// also for a file without a pose.
SPAWNFIELD_API PoseTable read_poses(const std::filesystem::path& file, bool allow_empty = false);

/// The same for the text of a file. Messages use `name` as the file's name. Names of columns begin with `prefix`.
SPAWNFIELD_API PoseTable parse_poses(std::string_view text, const std::string& name, bool allow_empty = false,
                                     const std::string& prefix = {});

/// Returns the x, y, z and yaw of poses, without roll and pitch, in the form that sample and search return.
SPAWNFIELD_API std::vector<Spawn> spawns_of(const PoseTable& table);

/// Returns the fields of the column with this name, one for each row, without quotes. Empty if there is no such column.
SPAWNFIELD_API std::vector<std::string> column_of(const PoseTable& table, const std::string& name);

/// Returns robots at the poses of a list or table. `names` and `name_spaces` have one entry for each pose, or none.
SPAWNFIELD_API std::vector<RobotStart> robot_starts(const SpawnList& list, const std::vector<std::string>& names = {},
                                                    const std::vector<std::string>& name_spaces = {});
SPAWNFIELD_API std::vector<RobotStart> robot_starts(const PoseTable& table, const std::vector<std::string>& names = {},
                                                    const std::vector<std::string>& name_spaces = {});

/// Returns the verdicts in the column `verdict`, as `check` and `raster` write it; empty if there is no such column.
/// Throws FileError with the name of the file from which the table was read.
SPAWNFIELD_API std::vector<Verdict> verdicts_of(const PoseTable& table, const std::filesystem::path& file);

/// Returns the names of the table's columns that verdicts_csv() or, if `settled`, settled_csv() replaces by columns of
/// its own; `repairs`: with those of repairs.
SPAWNFIELD_API std::vector<std::string> replaced_columns(const PoseTable& table, bool settled = false,
                                                         bool repairs = false);

/// Returns the table's columns, except the replaced ones, and then verdict,ground,height_above,hit. Numbers read back
/// to the same double.
///
/// With repairs, the columns repair,repair_distance,repair_x,repair_y,repair_z,repair_roll,repair_pitch,repair_yaw,
/// repair_tried follow; m and rad. `repair` is "moved" if the repair has the yaw of the pose, "turned" if it has
/// another one, and "none" if there is no valid grid pose; then only the number of grid poses follows. All are empty
/// for a valid pose.
SPAWNFIELD_API std::string verdicts_csv(const PoseTable& table, const std::vector<Judgement>& judgements,
                                        const Map& map, const RepairList* repairs = nullptr);

/// The same for robots that were let down at the poses: height_above is that of the settled pose, and the columns
/// settled_z,settled_roll,settled_pitch,tilt,margin,contacts,tip_over,belly,reason follow; m and rad. They are empty if
/// the robot was not let down or has no room, except `reason`: Judge::describe() of each pose that is not valid.
/// `contacts` lists "x y z PART on GROUND", separated by "; ". `judge` must be the one that let the robots down.
SPAWNFIELD_API std::string settled_csv(const PoseTable& table, const std::vector<SettledPose>& poses,
                                       const Judge& judge, const RepairList* repairs = nullptr);

/// Returns the table with the repaired poses in the place of those that were not valid. All other poses, and the texts
/// of numbers that do not change, stay as they are. Columns that the verdicts replace (replaced_columns() with repairs)
/// are left out, because they are about the old poses. If a repair needs an angle for which the table has no column,
/// the column is added at the end, and is 0 for poses that were not repaired.
SPAWNFIELD_API std::string repaired_csv(const PoseTable& table, const RepairList& repairs);

/// Writes x,y,z,yaw,layer,verdict. With RasterResult::rests, writes
/// x,y,z,roll,pitch,yaw,layer,verdict,tilt,margin,tip_over,belly: m and rad. If the robot has no room or the place
/// cannot be used, roll and pitch are 0, and the last four are empty. With a HeadingRule of several headings, the
/// column valid_headings follows (bit k of the number: heading k); then `ground`, the height of the layer onto which
/// the robot was let down, and `clearance` or `way` (RasterRest::free_length) with a rule that measures it. Passes the
/// text to `sink` in pieces. Parts of a raster (raster_in_parts()) that are written one after the other make the same
/// text as the whole one. `layer` is empty if the ground is not a layer. With `aerial`, also writes the aerial poses
/// of a 3D raster that are not in raster.poses, at their places in the order. Several threads make the text (0: all
/// cores); it is the same for any number of them.
SPAWNFIELD_API void write_raster_csv(const RasterResult& raster, bool aerial,
                                     const std::function<void(std::string_view)>& sink, int threads = 0);

/// Returns x,y,z,roll,pitch,yaw of each spawn; for settled robots, tilt and margin follow, and `clearance` or `way`
/// (SpawnRest::free_length) with a rule that measures it. With names, one for each spawn, the first column is `name`.
SPAWNFIELD_API std::string spawns_csv(const SpawnList& list, std::span<const std::string> names = {});

/// Returns x,y,z,roll,pitch,yaw of robots. If they have names, the first column is `name`.
SPAWNFIELD_API std::string robots_csv(std::span<const RobotStart> robots);

/// Returns JSON with the map, the robot, the settings, the counts, and the poses with names and quaternions (x, y, z,
/// w); for a sample, also whether it is full. Poses of settled robots also have tilt and margin, and `clearance` or
/// `way` as in spawns_csv(). `robots` are the list's spawns.
SPAWNFIELD_API std::string spawns_json(std::span<const RobotStart> robots, const SpawnList& list, const Judge& judge,
                                       const SampleOptions& options);
SPAWNFIELD_API std::string spawns_json(std::span<const RobotStart> robots, const SpawnList& list, const Judge& judge,
                                       const SearchOptions& options);

/// The same for poses that were not sampled or searched: without settings and counts.
SPAWNFIELD_API std::string poses_json(std::span<const RobotStart> robots, const Map& map, const Robot& robot);

}  // namespace spawnfield
