#pragma once

#include <spawnfield/robot.h>
#include <spawnfield/scene.h>

#include <cstdint>
#include <vector>

/// SplitMix64 (Steele 2014): the same numbers everywhere, which std distributions don't promise.
class Random {
public:
    explicit Random(std::uint64_t seed) : state_{seed} {}

    std::uint64_t next()
    {
        std::uint64_t z = state_ += 0x9E3779B97F4A7C15;
        z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9;
        z = (z ^ (z >> 27)) * 0x94D049BB133111EB;
        return z ^ (z >> 31);
    }
    double between(double low, double high) { return low + (high - low) * (double(next() >> 11) * 0x1p-53); }
    int below(int count) { return int(next() % std::uint64_t(count)); }  ///< 0 .. count - 1
    bool chance(double share) { return between(0, 1) < share; }

private:
    std::uint64_t state_;
};

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
