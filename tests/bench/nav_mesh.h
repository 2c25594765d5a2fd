#pragma once

#include <spawnfield/scene.h>

#include <memory>

namespace bench {

/// The robot as Recast knows it: an upright cylinder. Metres and radians.
struct Walker {
    double radius = 0.6;
    double height = 0.4;
    double climb = 0.1;         ///< highest step
    double slope = 0.165;       ///< steepest ground
    double cell = 0.2;          ///< width of Recast's voxels
    double cell_height = 0.05;  ///< height of the voxels
};

/// Alternative (c): the navigation mesh of Recast for a scene, and random points on it from Detour.
///
/// The mesh is built in tiles of 256 cells, one after the other, on one core. Terrain is walkable and obstacles are
/// not. Everything under a part of water, within the rectangle around it, is not walkable either.
class NavMesh {
public:
    static bool is_available();  ///< whether the benchmark was built with Recast

    /// Throws std::runtime_error if Recast fails, and std::invalid_argument for primitives other than boxes.
    NavMesh(const spawnfield::Scene& scene, const Walker& walker);
    ~NavMesh();

    /// Returns points on the ground. Detour draws a tile, then a polygon by area, then a point in it. The same seed
    /// gives the same points. Returns fewer than `count` only if there is nothing to walk on.
    std::vector<spawnfield::Vec3> draw(std::size_t count, std::uint64_t seed) const;

    /// Returns whether the mesh is directly above or below the point, within 1 m.
    bool covers(const spawnfield::Vec3& point) const;

    int tiles() const;
    int polygons() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace bench
