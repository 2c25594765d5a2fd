#pragma once

#include <spawnfield/query.h>

#include <opencv2/core.hpp>

#include <functional>

namespace spawnfield {

/// Heights that a robot fills above its layer, m.
struct RobotHeights {
    double low = 0, high = 0;  ///< of its lowest and highest point
};

/// Defines where obstacle_mask looks for obstacles.
struct ObstacleSearch {
    /// Returns the height of the shown layer near (x, y), m; nothing where no pose is shown.
    std::function<std::optional<double>(double x, double y)> layer_near;
    RobotHeights robot;
    double reach = 0;           ///< a layer that differs from that height by at most this counts as the same layer, m
    bool without_layer = true;  ///< also shows obstacles where there is neither a shown pose nor any terrain
    int threads = 0;
};

/// Returns 1 for each cell of the frame in which an obstacle stands at the height of a robot on the shown layer,
/// otherwise 0. Looks at the exact geometry at the cells' centres. Row 0 is the largest y. O(elements + cells).
cv::Mat_<std::uint8_t> obstacle_mask(const Geometry& geometry, const GridFrame& frame, const ObstacleSearch& search);

}  // namespace spawnfield
