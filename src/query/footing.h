#pragma once

#include "base/polygon2.h"

#include <spawnfield/query.h>

#include <vector>

namespace spawnfield {

/// Throws ArgumentError unless options.max_slope is infinite or between 0 and pi/2.
void check_max_slope(const char* function, const QueryOptions& options);

/// How a robot would stand at a pose, by QueryOptions::max_slope, from the scene's geometry alone. One for each thread.
class Footing {
public:
    Footing(const Geometry& geometry, const Robot& robot, double max_slope);

    void face(const Mat3& rotation);  ///< of the poses to come; to be called before the first

    /// Valid, Steep or Unstable, of a pose that collides with nothing; `ground` is the height of its ground.
    Verdict at(const Vec3& position, double ground);

private:
    struct Contact {
        Vec2 shift;                    ///< from the origin, turned
        double level;                  ///< above the origin; what begins higher does not carry it
        double reach;                  ///< of its surface above or below the pose's ground
        Vec2 weight;                   ///< what 1 m there adds to the gradient of the plane
        std::vector<Interval> solids;  ///< of the column at look_at, all that touches taken as one, from the bottom up
    };
    void look_at(double x, double y);
    Vec2 gradient() const;
    bool is_even(const Vec2& gradient) const;

    const Geometry* geometry_;
    const Robot* robot_;
    std::vector<Vec3> points_;       ///< contacts_of the robot
    double lowest_, steepest_;       ///< z of the upright robot's lowest point; tangent of the limit
    std::vector<Contact> contacts_;  ///< none: as the robot is turned, they span no area
    Vec2 middle_ = Vec2::Zero();     ///< of the contacts
    std::vector<double> rises_;      ///< of the surfaces under the contacts, above the pose's ground
    std::optional<Vec2> looked_at_;  ///< poses above each other share their columns
};

}  // namespace spawnfield
