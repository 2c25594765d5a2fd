#pragma once

#include <spawnfield/robot.h>

/// Returns whether FCL finds that two robots touch or overlap at these poses. It is asked about each pair of their
/// parts as they are, and does not use the library's collision code.
bool fcl_robots_meet(const spawnfield::Robot& a, const spawnfield::Pose& scene_from_a, const spawnfield::Robot& b,
                     const spawnfield::Pose& scene_from_b);
