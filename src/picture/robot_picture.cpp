#include "base/module.h"
#include "picture/drawing_module.h"
#include "picture/silhouette.h"

#include <spawnfield/robot_picture.h>

#include <algorithm>

namespace spawnfield {

double turning_radius(const Robot& robot)
{
    double radius = 0;
    for (const RobotPart& part : robot.parts)
        for (const Vec2& corner : silhouette(part, view_from_above)) radius = std::max(radius, corner.norm());
    return radius;
}

void write_robot_picture(const Robot& robot, const std::filesystem::path& file)
{
    module_functions<drawing_module::Functions>().robot(robot, file);
}

}  // namespace spawnfield
