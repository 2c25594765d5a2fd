#pragma once

#include <spawnfield/export.h>
#include <spawnfield/robot.h>

#include <filesystem>

namespace spawnfield {

/// Radius around the robot's origin that it sweeps when it turns on the spot, m: round parts as polygons of 64 corners
/// around them, so up to 0.2 % of their own radius too much.
SPAWNFIELD_API double turning_radius(const Robot& robot);

/// Draws the robot from above, from its right side and from the front, to one scale: parts coloured by link, footprint,
/// contacts, the axes of its frame, scale bar and sizes, in 1000 pixels of width. The file's ending chooses the
/// format, as picture_format() says. Throws ArgumentError for another ending, OutputError.
/// Colours: Okabe, Ito, Color Universal Design, 2008, lightened.
SPAWNFIELD_API void write_robot_picture(const Robot& robot, const std::filesystem::path& file);

}  // namespace spawnfield
