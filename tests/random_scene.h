#pragma once

#include "worlds/random.h"

#include <spawnfield/robot.h>
#include <spawnfield/scene.h>

#include <cstdint>
#include <vector>

/// R = Rz(yaw) Ry(pitch) Rx(roll).
spawnfield::Mat3 rotation_of_rpy(double roll, double pitch, double yaw);

/// A small world about 20 x 20 m around the origin: relief or floor, and some of all that scenes are made of: ramps,
/// boxes, round bodies, closed, nested and open meshes, thin walls, poles, upper storeys, water.
spawnfield::Scene random_scene(std::uint64_t seed);

/// One to four boxes, round bodies and hulls, up to about 1 m across, most of it above the origin.
spawnfield::Robot random_robot(std::uint64_t seed);

/// Poses in and slightly beyond the scene's bounds, most of them up to 1.5 m above some surface, half of them near a
/// part of the scene rather than anywhere.
std::vector<spawnfield::Pose> random_poses(const spawnfield::Scene& scene, std::uint64_t seed, std::size_t count);

/// Smallest box around the scene, from its vertices and the spheres around its primitives.
spawnfield::Bounds rough_bounds(const spawnfield::Scene& scene);
