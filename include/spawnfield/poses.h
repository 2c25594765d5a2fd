#pragma once

#include <spawnfield/export.h>
#include <spawnfield/query.h>
#include <spawnfield/simulators.h>

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace spawnfield {

/// Poses of a CSV file with the text of their rows, which is carried through.
struct PoseTable {
    std::string header;
    std::vector<std::string> rows;  ///< one for each pose, without line end
    std::vector<Pose> poses;
    std::vector<std::string> notices;  ///< what may be a slip of the pen, for the user to see
};

/// Reads a header x,y,z,roll,pitch,yaw in any order, and a pose in each further line. Metres and radians; columns
/// roll_deg, pitch_deg, yaw_deg are degrees. Angles default to 0; qx,qy,qz,qw may stand for them; other columns are
/// carried through. Throws FileError that names line and column; without `allow_empty` also for a file without a pose.
SPAWNFIELD_API PoseTable read_poses(const std::filesystem::path& file, bool allow_empty = false);

/// The same for a file's text; `name` stands for the file in messages.
SPAWNFIELD_API PoseTable parse_poses(std::string_view text, const std::string& name, bool allow_empty = false);

/// Poses as sample and search write them (x, y, z, yaw; roll and pitch are left aside).
SPAWNFIELD_API std::vector<Spawn> spawns_of(const PoseTable& table);

/// Fields of the column of this name, row by row, without quotes; none if the table has no such column.
SPAWNFIELD_API std::vector<std::string> column_of(const PoseTable& table, const std::string& name);

/// Robots at the poses of a list or table, with names and namespaces of the same number, or without.
SPAWNFIELD_API std::vector<RobotStart> robot_starts(const SpawnList& list, const std::vector<std::string>& names = {},
                                                    const std::vector<std::string>& name_spaces = {});
SPAWNFIELD_API std::vector<RobotStart> robot_starts(const PoseTable& table, const std::vector<std::string>& names = {},
                                                    const std::vector<std::string>& name_spaces = {});

/// What a column `verdict` says of each pose, as `check` and `raster` write it; empty if there is none. Throws
/// FileError, with the name of the file that the table was read from.
SPAWNFIELD_API std::vector<Verdict> verdicts_of(const PoseTable& table, const std::filesystem::path& file);

/// The table's columns that are named as some that verdicts_csv adds: those take their place.
SPAWNFIELD_API std::vector<std::string> replaced_columns(const PoseTable& table);

/// Returns the table's columns but the replaced ones, then verdict,ground,height_above,hit. Numbers read back to the
/// same double.
SPAWNFIELD_API std::string verdicts_csv(const PoseTable& table, const std::vector<Judgement>& judgements,
                                        const Map& map);

/// Writes x,y,z,yaw,layer,verdict, given to `sink` in pieces; layer is empty where the ground is no layer. With
/// `aerial` also the aerial poses of a 3D raster that `raster` leaves out, in their places.
SPAWNFIELD_API void write_raster_csv(const RasterResult& raster, bool aerial,
                                     const std::function<void(std::string_view)>& sink);

/// x,y,z,roll,pitch,yaw.
SPAWNFIELD_API std::string spawns_csv(const SpawnList& list);

/// The same, after a column `name` if the robots have names.
SPAWNFIELD_API std::string robots_csv(std::span<const RobotStart> robots);

/// Returns poses with names and quaternions (x, y, z, w), and what they were made from and with: settings, counts; for
/// a sample also whether it is full. `robots` are the list's spawns.
SPAWNFIELD_API std::string spawns_json(std::span<const RobotStart> robots, const SpawnList& list, const Judge& judge,
                                       const SampleOptions& options);
SPAWNFIELD_API std::string spawns_json(std::span<const RobotStart> robots, const SpawnList& list, const Judge& judge,
                                       const SearchOptions& options);

/// The same of poses that come from somewhere else: without settings and counts.
SPAWNFIELD_API std::string poses_json(std::span<const RobotStart> robots, const Map& map, const Robot& robot);

}  // namespace spawnfield
