#pragma once

#include <spawnfield/query.h>

#include <opencv2/core.hpp>

#include <functional>

namespace spawnfield {

/// Heights that a robot fills above its layer, m.
struct RobotHeights {
    double low = 0, high = 0;  ///< of its lowest and highest point
};

/// Where obstacles are looked for.
struct ObstacleSearch {
    /// Height of the shown layer near (x, y), m; none where no pose is shown.
    std::function<std::optional<double>(double x, double y)> layer_near;
    RobotHeights robot;
    double reach = 0;           ///< m that a layer may be off that height and still be the same one
    bool without_layer = true;  ///< obstacles where there is neither a shown pose nor any terrain
    int threads = 0;
};

/// 1 where an obstacle stands at the height of a robot on the shown layer, at the centres of the frame's cells, from
/// the exact geometry. Row 0 is the largest y. O(elements + cells).
cv::Mat_<std::uint8_t> obstacle_mask(const Geometry& geometry, const GridFrame& frame, const ObstacleSearch& search);

}  // namespace spawnfield
