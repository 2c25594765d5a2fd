#pragma once

#include <spawnfield/export.h>
#include <spawnfield/geometry.h>

#include <string>
#include <vector>

namespace spawnfield {

/// What spawns must comply with besides being valid: their relation to parts of the scene and to points. All rules must
/// hold for the pose that is written. Parts and faces are selected by globs; see selection_of() and docs/places.md.
struct PlaceRules {
    /// Nearness to parts: the shortest distance in 3D between the robot and all matching parts and faces.
    struct Near {
        std::string parts;         ///< glob
        double low = 0, high = 0;  ///< m, inclusive, 0 <= low <= high; high may be infinite
    };
    /// Horizontal distance between the robot's origin and a point.
    struct Distance {
        double x = 0, y = 0;       ///< m
        double low = 0, high = 0;  ///< m, inclusive, 0 <= low <= high; high may be infinite
    };

    /// m, 0 .. 10: the shortest horizontal shift with which the robot touches an obstacle is at least this long.
    double clearance = 0;
    /// Globs of the parts and faces on which the robot stands. Settled: all contacts are with those that match one of
    /// `on`, and none with those that match one of `not_on`. Level: the same for the ground below the origin. On the
    /// edge between two face groups, the robot stands on both.
    std::vector<std::string> on = {}, not_on = {};
    std::vector<Near> near = {};
    std::vector<Distance> distance_to = {};
    /// Points from which the robot's sensor is visible, or is not visible. A line of sight is interrupted by terrain
    /// and obstacles that it touches; water does not count. The sensor is at PlaceMeasures::sensor_height.
    std::vector<Vec3> in_view_of = {}, hidden_from = {};
    /// Glob; if it is not empty, the robot's x axis points, seen from above, to the nearest point of the matching
    /// parts. It is the one nearest in 3D to the point half of the robot's height above the ground of the spawn. Must
    /// not be given together with a HeadingRule or a random yaw.
    std::string facing = {};

    /// Returns whether there is a rule that a spawn can break; `facing` is not one.
    bool has_limits() const
    {
        return clearance > 0 || !on.empty() || !not_on.empty() || !near.empty() || !distance_to.empty() ||
               !in_view_of.empty() || !hidden_from.empty();
    }
};

/// What is selected of a scene: whole parts, and face groups of other parts.
struct Selection {
    std::vector<std::uint8_t> parts;   ///< for each part, 1 if all of it is selected, else 0
    std::vector<std::uint8_t> groups;  ///< the same for each of Geometry::face_groups()

    /// Returns whether an element is selected; `group` is as in Scene::triangle_groups.
    bool contains(std::uint32_t part, std::uint32_t group) const
    {
        return parts[part] != 0 || (group > 0 && groups[group - 1] != 0);
    }
};

/// Returns the parts whose name, or a word of it between "::", matches one of the globs, ignoring case, and the face
/// groups whose node or material does. Throws ArgumentError for a glob that matches nothing; the message begins with
/// `rule` and lists some names.
SPAWNFIELD_API Selection selection_of(const Geometry& geometry, const std::vector<std::string>& globs,
                                      const std::string& rule);

/// Returns the rules as in the options of `sample`, for people: "near shelf* 0.5:1 m, not on road*"; may be empty.
SPAWNFIELD_API std::string to_string(const PlaceRules& rules);

}  // namespace spawnfield
