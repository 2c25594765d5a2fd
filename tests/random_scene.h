#pragma once

#include "worlds/random.h"

#include <spawnfield/robot.h>
#include <spawnfield/scene.h>

#include <cstdint>
#include <vector>

/// Returns Rz(yaw) Ry(pitch) Rx(roll).
spawnfield::Mat3 rotation_of_rpy(double roll, double pitch, double yaw);

/// Returns a small world of about 20 x 20 m around the origin: a relief or a floor, with ramps, boxes, round bodies,
/// closed, nested and open meshes, thin walls, poles, upper storeys and water.
spawnfield::Scene random_scene(std::uint64_t seed);

/// Returns a scene that consists of some parts of another one, in this order.
spawnfield::Scene scene_of_parts(const spawnfield::Scene& from, const std::vector<std::uint32_t>& parts);

/// Returns a robot of one to four boxes, round bodies and hulls, up to about 1 m across, mostly above its origin.
spawnfield::Robot random_robot(std::uint64_t seed);

/// Returns poses in the bounds of the scene and slightly beyond. Most are up to 1.5 m above some surface, and half of
/// them are near a part of the scene.
std::vector<spawnfield::Pose> random_poses(const spawnfield::Scene& scene, std::uint64_t seed, std::size_t count);

/// Returns a box around the vertices of the scene and the spheres around its primitives.
spawnfield::Bounds rough_bounds(const spawnfield::Scene& scene);
