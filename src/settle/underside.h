#pragma once

#include "settle/touch.h"

#include <spawnfield/robot.h>

#include <optional>
#include <span>
#include <vector>

namespace spawnfield {

/// Returns the z of the lowest point of bodies on the vertical line through x = y = 0, m, or nothing if the line misses
/// all of them.
std::optional<double> underside_of(std::span<const PlacedBody> bodies);

/// Finds how much room is below a robot at its origin, for one rotation after another. For one thread.
class Underside {
public:
    explicit Underside(const Robot& robot);

    /// Returns how far the robot's lowest point on the vertical line through its origin is above the origin, m; 0 if
    /// that point is below the origin, or if the line misses the robot. It is computed once for equal rotations in a
    /// row.
    double above_origin(const Mat3& rotation);

private:
    std::vector<Convex> parts_;       ///< in the robot's frame
    std::vector<PlacedBody> placed_;  ///< the parts with rotation_
    Mat3 rotation_;                   ///< NaN: none yet
    double above_ = 0;                ///< at rotation_, m
};

}  // namespace spawnfield
