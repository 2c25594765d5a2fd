#pragma once

#include <spawnfield/query.h>

#include <filesystem>
#include <string>
#include <vector>

namespace spawnfield {

/// Poses of a CSV file with the text of their rows, which is carried through.
struct PoseTable {
    std::string header;
    std::vector<std::string> rows;  ///< one for each pose, without line end
    std::vector<Pose> poses;
};

/// Header x,y,z,roll,pitch,yaw in any order; roll, pitch, yaw default to 0; qx,qy,qz,qw may stand for them; other columns
/// are carried through. Metres and radians. Throws FileError that names line and column.
PoseTable read_poses(const std::filesystem::path& file);

/// Spawns of a CSV file as sample and search write it (x, y, z, yaw; roll and pitch are left aside).
std::vector<Spawn> read_spawns(const std::filesystem::path& file);

/// Table's columns, then verdict,ground,height_above,hit. Numbers read back to the same double.
std::string verdicts_csv(const PoseTable& table, const std::vector<Judgement>& judgements, const std::vector<Part>& parts);

/// x,y,z,yaw,layer,verdict, told to `sink` in pieces; layer is empty where the ground is no layer. With `aerial` also the
/// aerial poses of a 3D raster that `raster` leaves out, in their places.
void write_raster_csv(const RasterResult& raster, bool aerial, const std::function<void(std::string_view)>& sink);

/// x,y,z,roll,pitch,yaw.
std::string spawns_csv(const SpawnList& list);

/// Poses with quaternions (x, y, z, w) and what they were made from.
std::string spawns_json(const SpawnList& list, const Map& map, const Robot& robot, const SpawnOptions& options,
                        const std::string& command);

}  // namespace spawnfield
