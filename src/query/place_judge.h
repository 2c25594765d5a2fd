#pragma once

#include "base/rect.h"
#include "query/clearance.h"
#include "query/parts_near.h"

#include <spawnfield/place_rules.h>
#include <spawnfield/settled_pose.h>

#include <span>

namespace spawnfield {

/// Decides whether poses comply with PlaceRules. Const calls may run at the same time.
class PlaceJudge {
public:
    /// Throws ArgumentError for values beyond their limits and for globs that match no part.
    PlaceJudge(const Geometry& geometry, const Robot& robot, const PlaceRules& rules,
               const std::optional<double>& sensor_height);

    bool has_limits() const { return rules_.has_limits(); }
    bool has_facing() const { return facing_.has_value(); }

    /// Returns whether a robot with its origin at this x and y can comply with the distances to points.
    bool is_at_distances(const Eigen::Vector2d& at) const;
    /// A point at which the robot stands on a part of the scene.
    struct GroundPoint {
        Vec3 point;  ///< m
        std::uint32_t part;
    };
    /// Returns whether a valid pose complies with all rules.
    bool complies(const Pose& pose, std::span<const GroundPoint> grounds) const;
    /// The same for a settled pose, raised by `lift`.
    bool complies(const SettledPose& pose, double lift) const;
    /// Returns the yaw at which a robot at a place on the ground faces the parts of PlaceRules::facing; 0 if their
    /// nearest point is straight above or below. Needs has_facing().
    double facing_yaw(const Vec3& place) const;

    // For PlaceCells:
    struct NearParts {
        PartsNear parts;
        double low, high;  ///< m
    };
    const std::vector<NearParts>& near() const { return near_; }
    const std::optional<PartsNear>& on_parts() const { return on_parts_; }  ///< those of PlaceRules::on, if it is given
    /// Returns false only if no point of the rectangle is_at_distances().
    bool may_be_at_distances(const Rect& rect) const;
    double reach() const { return reach_; }  ///< m: distance of the robot's farthest point from its origin

private:
    bool is_on(std::span<const GroundPoint> grounds) const;
    bool is_near(const Pose& pose) const;
    bool is_in_view(const Pose& pose) const;

    const Geometry geometry_;
    const PlaceRules rules_;
    std::vector<Convex> bodies_;  ///< of the robot, in its frame
    double sensor_height_, half_height_, reach_ = 0;
    std::optional<Selection> on_, not_on_;
    std::vector<bool> is_divided_;  ///< for each part: only some of its faces are in on_, or in not_on_
    std::vector<NearParts> near_;
    std::optional<PartsNear> on_parts_, facing_;
    std::optional<ClearanceMeter> clearances_;
};

}  // namespace spawnfield
