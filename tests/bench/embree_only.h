#pragma once

#include "top_raster.h"
#include "triangle_scene.h"

#include <spawnfield/robot.h>

#include <memory>

namespace bench {

/// Alternative (d): what a good engineer would write with Embree alone.
///
/// Heights of ground and water are vertical rays, as in PlainFcl. For collisions it finds the triangles near the robot
/// and tests each of them against the robot's boxes. It computes in single precision, and meshes and boxes are
/// surfaces, so a robot that is completely inside one is free. Const methods may be called from several threads at the
/// same time.
class EmbreeOnly {
public:
    static bool is_available();  ///< whether the benchmark was built with Embree

    /// For what it is built. Answers are the same.
    enum class Use {
        Once,  ///< fast to build
        Often  ///< fast to ask: better trees for rays, and one more tree, a TriangleTree
    };
    /// How it finds the triangles near a robot. Answers are the same.
    enum class Search {
        PointQuery,  ///< asks Embree for the triangles around a point (rtcPointQuery), in the trees for rays
        OurOwn       ///< by the TriangleTree, which is faster; only with Use::Often
    };
    /// Uses all cores. Throws std::invalid_argument if the robot has a part that is not a box.
    EmbreeOnly(TriangleScene scene, const spawnfield::Robot& robot, Use use);
    ~EmbreeOnly();

    TopRaster raster_top(const spawnfield::RasterGrid& grid, double offset, int threads,
                         Search search) const;  ///< yaw is 0

private:
    struct Impl;
    std::unique_ptr<const Impl> impl_;
};

}  // namespace bench
