#pragma once

#include <spawnfield/robot.h>

namespace spawnfield {

/// Returns how far a robot reaches at least along the vertical line through its origin, at any yaw and any tilt up to
/// `max_tilt` (rad), m. A robot whose pose is valid has so much room between its ground and the next surface above it
/// on this line. Returns 0 if this cannot be proven.
///
/// The proof: let a ball with radius r lie in a part of the robot, with its centre at 0, 0, c. If the robot tilts by an
/// angle a, the line is at most c sin(a) from the centre, so at least 2 sqrt(r^2 - (c sin(a))^2) of it lie in the ball.
/// No other part is on the line below the ball, so no surface is between the robot's lowest point there and the ball: a
/// surface below that point is the robot's ground, and one above it is above the ball.
double least_head_room(const Robot& robot, double max_tilt);

}  // namespace spawnfield
