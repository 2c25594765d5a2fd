#pragma once

#include <spawnfield/settled_pose.h>

#include <span>

namespace spawnfield {

/// Returns whether forces at the contacts, within their friction cones, can hold a body of one part against gravity.
/// `mass` is its centre of mass in the scene's frame. Each cone is a pyramid with 16 edges inside the exact cone, so
/// this may be false although up to 2 % less friction would be enough. Source: Murray, Li, Sastry, A Mathematical
/// Introduction to Robotic Manipulation, 1994, chapter 5 (friction cones, force closure).
bool is_held(std::span<const RestContact> contacts, const Vec3& mass, double friction);

/// Returns the least coefficient of friction above `least` with which the body is held, to 1 %; infinite if it is above
/// 10. With `least` itself it must not be held.
double friction_needed(std::span<const RestContact> contacts, const Vec3& mass, double least);

/// Returns the centre of mass of a robot at rest in the scene's frame, from that in the robot's frame.
Vec3 mass_center_at(const SettledPose& pose, const Vec3& mass_center);

}  // namespace spawnfield
