#pragma once

#include "base/polygon2.h"

#include <spawnfield/column.h>
#include <spawnfield/robot.h>

#include <vector>

namespace spawnfield {

/// Decides how a robot would stand at a pose, as JudgeOptions::max_slope describes, from the scene's geometry alone.
/// Each thread needs its own. Refers to the geometry and the robot.
class Footing {
public:
    /// The robot is upright at yaw 0 until set_rotation() is called.
    Footing(const Geometry& geometry, const Robot& robot, double max_slope);

    void set_rotation(const Mat3& rotation);

    /// Returns Valid, Steep or Unstable for a pose that collides with nothing; `ground` is the height of its ground.
    Verdict judge(const Vec3& position, double ground);

private:
    struct Contact {
        Vec2 shift;                    ///< horizontal distance from the origin, at the current rotation
        double level;                  ///< height above the origin; solids that begin higher do not carry the contact
        double reach;                  ///< largest distance of its surface above or below the pose's ground
        Vec2 weight;                   ///< change of the plane's gradient if the surface is 1 m higher
        std::vector<Interval> solids;  ///< of its column, from the bottom up; solids that touch are joined
    };
    void set_columns(double x, double y);
    Vec2 gradient() const;
    bool is_even(const Vec2& gradient) const;

    const Geometry* geometry_;
    const Robot* robot_;
    std::vector<Vec3> points_;       ///< contacts_of the robot
    double lowest_, steepest_;       ///< z of the upright robot's lowest point; tangent of the limit
    std::vector<Contact> contacts_;  ///< empty: at this rotation, the contacts lie on one line
    Vec2 middle_ = Vec2::Zero();     ///< of the contacts
    std::vector<double> rises_;      ///< heights of the surfaces under the contacts above the pose's ground
    /// x and y of the pose whose columns are in contacts_; poses above each other share them.
    std::optional<Vec2> columns_at_;
};

}  // namespace spawnfield
