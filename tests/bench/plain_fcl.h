#pragma once

#include <spawnfield/query.h>

#include <memory>
#include <optional>

namespace bench {

/// What a good engineer would write by hand: alternative (b).
///
/// A fcl::BVHModel<OBB> for each part of the scene (primitives as FCL's shapes) in a DynamicAABBTreeCollisionManager,
/// and vertical Embree rays for the heights of ground and water. Meshes are surfaces: a robot wholly inside one is
/// free. Single floats in Embree: heights are right to about 1e-5 m. Const calls may run at the same time.
class PlainFcl {
public:
    static bool is_available();  ///< whether the benchmark was built with Embree

    /// Primitives other than boxes collide, but no ray sees them: throws std::invalid_argument where they are terrain.
    PlainFcl(const spawnfield::Scene& scene, const spawnfield::Robot& robot);
    ~PlainFcl();

    /// A pose of the 2D raster of top layers, and what holds for it.
    struct TopPose {
        double z = 0;
        spawnfield::Verdict verdict{};
    };
    /// Row by row as RasterResult, one for each column; nothing where there is no terrain. Yaw is 0.
    std::vector<std::optional<TopPose>> raster_top(const spawnfield::RasterGrid& grid, double offset,
                                                   int threads) const;

    /// One pose after the other, each with its own ray unless `height_check` is false. Yaw is 0.
    spawnfield::VerdictCounts raster_3d(const spawnfield::RasterGrid& grid, double max_height, bool height_check,
                                        int threads) const;

    /// As check_poses, without reasons; all poses within the map.
    std::vector<spawnfield::Verdict> check(const std::vector<spawnfield::Pose>& poses, double max_height,
                                           int threads) const;

    /// Whether any closed mesh winds around the point: where FCL's surfaces see nothing, but the place is solid.
    bool is_inside(const spawnfield::Vec3& point) const;

private:
    struct Impl;
    std::unique_ptr<const Impl> impl_;
};

}  // namespace bench
