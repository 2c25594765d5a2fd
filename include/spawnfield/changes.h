#pragma once

#include <spawnfield/export.h>
#include <spawnfield/map.h>
#include <spawnfield/robot.h>

#include <string>
#include <vector>

/// Changes of a map in memory, without a new bake.
///
/// All queries on a changed map give the same answers, byte for byte, as on the map that is baked from the changed
/// scene with the bounds, z limits and resolutions of the old map. A changed map shares the tiles of the old one. Its
/// `folder` is empty, its `changes` list what was done, and its `hash` depends on all changes. See
/// docs/changing-worlds.md.
namespace spawnfield {

/// Returns a map without the parts that match one of the globs (POSIX fnmatch, ignoring case) with their whole name or
/// with one of its words between "::". Reads all tiles of the geometry. Throws ArgumentError for a glob that matches no
/// part, and FileError for a damaged map.
SPAWNFIELD_API Map without_parts(const Map& map, const std::vector<std::string>& globs, int threads = 0);

/// Returns a map with the parts of a scene, after those of the map. Reads no tiles of the map, unless a part is
/// terrain: then it also reads terrain.tiff. Throws ArgumentError if the map has a part of the same name, and FileError
/// for a damaged map.
SPAWNFIELD_API Map with_parts(const Map& map, const Scene& extra, int threads = 0);

/// Returns the parts of a robot at a pose as a scene of obstacles, for with_parts(). They are named NAME::PART, where
/// PART is the name of the robot's part (its number if it has none; "PART (2)" for the second one of the same name).
SPAWNFIELD_API Scene robot_as_obstacle(const Robot& robot, const Pose& scene_from_robot, const std::string& name);

/// Returns the names of the parts of a scene that lie completely beyond the bounds of a map in x or y.
SPAWNFIELD_API std::vector<std::string> parts_off_map(const Scene& extra, const Map& map);

}  // namespace spawnfield
