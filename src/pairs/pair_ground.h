#pragma once

#include <spawnfield/settled_pose.h>

namespace spawnfield {

/// Returns the ground below a settled pose that has one, m.
inline Vec3 ground_of(const SettledPose& pose) { return {pose.position.x(), pose.position.y(), pose.ground->height}; }

}  // namespace spawnfield
