#pragma once

#include <spawnfield/export.h>
#include <spawnfield/robot.h>

#include <filesystem>

namespace spawnfield {

/// Returns the radius around the robot's origin that the robot sweeps when it turns on the spot, m. Round parts are
/// replaced by polygons of 64 corners around them, so the result may be too large by up to 0.2 % of their own radius.
SPAWNFIELD_API double turning_radius(const Robot& robot);

/// Draws the robot from above, from its right side and from the front, at one scale and 1000 pixels wide. The picture
/// shows the parts, coloured by link, the footprint, the contacts, the axes of the robot's frame, a scale bar and
/// sizes. The ending of the file's name chooses the format; see picture_format(). Throws ArgumentError for another
/// ending, and OutputError. Colours: Okabe, Ito, Color Universal Design, 2008, lightened.
SPAWNFIELD_API void write_robot_picture(const Robot& robot, const std::filesystem::path& file);

}  // namespace spawnfield
