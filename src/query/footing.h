#pragma once

#include "base/polygon2.h"

#include <spawnfield/column.h>
#include <spawnfield/robot.h>

#include <vector>

namespace spawnfield {

/// Decides how a robot would stand at a pose, as JudgeOptions::max_slope describes, from the scene's geometry alone.
/// One for each thread. Refers to the geometry and the robot.
class Footing {
public:
    /// Upright at yaw 0 until another rotation is set.
    Footing(const Geometry& geometry, const Robot& robot, double max_slope);

    void set_rotation(const Mat3& rotation);

    /// Returns Valid, Steep or Unstable for a pose that collides with nothing; `ground` is the height of its ground.
    Verdict judge(const Vec3& position, double ground);

private:
    struct Contact {
        Vec2 shift;                    ///< from the origin, turned
        double level;                  ///< above the origin; what begins higher does not carry it
        double reach;                  ///< of its surface above or below the pose's ground
        Vec2 weight;                   ///< what 1 m there adds to the gradient of the plane
        std::vector<Interval> solids;  ///< of its column, all that touches taken as one, from the bottom up
    };
    void set_columns(double x, double y);
    Vec2 gradient() const;
    bool is_even(const Vec2& gradient) const;

    const Geometry* geometry_;
    const Robot* robot_;
    std::vector<Vec3> points_;        ///< contacts_of the robot
    double lowest_, steepest_;        ///< z of the upright robot's lowest point; tangent of the limit
    std::vector<Contact> contacts_;   ///< none: as the robot is turned, they span no area
    Vec2 middle_ = Vec2::Zero();      ///< of the contacts
    std::vector<double> rises_;       ///< of the surfaces under the contacts, above the pose's ground
    std::optional<Vec2> columns_at_;  ///< where the contacts' columns were taken; poses above each other share them
};

}  // namespace spawnfield
