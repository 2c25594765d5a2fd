#pragma once

#include "top_raster.h"

#include <memory>

namespace bench {

/// Alternative (b): what a good engineer would write by hand.
///
/// It has a fcl::BVHModel<OBB> for each part of the scene (primitives become shapes of FCL) in a
/// DynamicAABBTreeCollisionManager, and finds the heights of ground and water with vertical Embree rays. Meshes are
/// surfaces, so a robot that is completely inside one is free. Embree uses single precision: heights are right to about
/// 1e-5 m. Const methods may be called from several threads at the same time.
class PlainFcl {
public:
    static bool is_available();  ///< whether the benchmark was built with Embree

    /// Primitives other than boxes collide, but rays do not see them. Throws std::invalid_argument if such a primitive
    /// is terrain.
    PlainFcl(const spawnfield::Scene& scene, const spawnfield::Robot& robot);
    ~PlainFcl();

    TopRaster raster_top(const spawnfield::RasterGrid& grid, double offset, int threads) const;  ///< yaw is 0

    /// Returns the counts by verdict. Checks one pose after the other, each with its own ray unless `height_check` is
    /// false. Yaw is 0.
    spawnfield::VerdictCounts raster_3d(const spawnfield::RasterGrid& grid, double max_height, bool height_check,
                                        int threads) const;

    /// Returns verdicts like check_poses, without reasons. All poses must be within the map.
    std::vector<spawnfield::Verdict> check(const std::vector<spawnfield::Pose>& poses, double max_height,
                                           int threads) const;

    /// Returns whether a closed mesh winds around the point. Such a point is solid, although the surfaces of FCL do not
    /// touch it.
    bool is_inside(const spawnfield::Vec3& point) const;

private:
    struct Impl;
    std::unique_ptr<const Impl> impl_;
};

}  // namespace bench
