#pragma once

#include "settle/convex.h"

#include <spawnfield/geometry.h>

#include <vector>

namespace spawnfield {

/// A place where a robot at rest touches the ground.
struct RestContact {
    Vec3 point;            ///< m, in the scene's frame
    Vec3 normal;           ///< from the ground to the robot, of length 1
    std::size_t part;      ///< of the robot
    std::uint32_t ground;  ///< part of the scene
    Label label;           ///< of what it touches
};

/// How a robot comes to rest that is let down at a place with a yaw.
struct Rest {
    enum class State {
        Standing,  ///< it stands on three or more contacts, and its centre of mass is above them
        Falling,   ///< it tips over: by more than the largest tilt, or on a point or a line
        Blocked    ///< there is no room for the level robot near the layer
    };
    State state = State::Blocked;
    double z = 0, roll = 0, pitch = 0;  ///< of the robot's origin, m and rad. Falling: where it would have to balance
    /// Distance of the projected centre of mass from the nearest edge of the support polygon, m; negative: outside. The
    /// polygon also counts wheels and feet that are at most 1 mm above the ground.
    double margin = 0;
    std::vector<RestContact> contacts;  ///< those that the margin counts

    double tilt() const;  ///< angle between the robot's z axis and the vertical, rad
};

/// Lets robots down on the ground of a scene.
class Settler {
public:
    struct Options {
        double max_tilt = 0.78539816339744831;  ///< rad; a robot that tilts more is falling
        double max_height = 1;                  ///< m; the level robot must find room within this height of its layer
    };

    Settler(const Geometry& geometry, const Robot& robot, const Options& options);

    /// Lets the robot down at (x, y) with this yaw onto the terrain layer at a height. It moves only in z, roll and
    /// pitch: level down to the first contact, then it turns about its contacts so that its centre of mass sinks.
    Rest settle(double x, double y, double yaw, double layer) const;

private:
    class Descent;

    const Geometry geometry_;
    const Options options_;
    std::vector<Convex> parts_;  ///< in the robot's frame
    Vec3 mass_center_;
    double reach_;  ///< m: the distance of the robot's farthest point from its origin
};

}  // namespace spawnfield
