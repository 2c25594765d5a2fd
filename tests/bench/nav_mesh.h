#pragma once

#include <spawnfield/scene.h>

#include <memory>

namespace bench {

/// What Recast is told of the robot: it knows upright cylinders only. Metres and radians.
struct Walker {
    double radius = 0.6;
    double height = 0.4;
    double climb = 0.1;  ///< of a step
    double slope = 0.165;
    double cell = 0.2;  ///< of its voxels, seen from above
    double cell_height = 0.05;
};

/// Recast's navigation mesh of a scene, and Detour's random points on it: alternative (c).
///
/// Built in tiles of 256 cells, one after the other, on one core. Terrain is walkable, obstacles are not, and what lies
/// under a part of water (within the rectangle around it) is taken out.
class NavMesh {
public:
    static bool is_available();  ///< whether the benchmark was built with Recast

    /// Throws std::runtime_error if Recast fails, std::invalid_argument for primitives other than boxes.
    NavMesh(const spawnfield::Scene& scene, const Walker& walker);
    ~NavMesh();

    /// Points on the ground as Detour draws them: a tile, then a polygon by area, then a point in it; the same for the
    /// same seed. Fewer than `count` only where there is nothing to walk on.
    std::vector<spawnfield::Vec3> draw(std::size_t count, std::uint64_t seed) const;

    /// Whether there is mesh straight above or below, within 1 m.
    bool covers(const spawnfield::Vec3& point) const;

    int tiles() const;
    int polygons() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace bench
