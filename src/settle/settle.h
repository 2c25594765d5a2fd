#pragma once

#include "base/rect.h"
#include "settle/convex.h"

#include <spawnfield/geometry.h>
#include <spawnfield/settled_pose.h>

#include <limits>
#include <memory>
#include <optional>
#include <vector>

namespace spawnfield {

/// How a robot comes to rest that is let down at a place with a yaw.
struct Rest {
    enum class State {
        Standing,  ///< its centre of mass is above its contacts, which span an area or a line on which it stays
        Falling,   ///< it tips over: by more than the largest tilt, or on a point or a line on which it does not stay
        Blocked    ///< there is no room for the level robot near the layer, or a wall stops it while it turns
    };
    State state = State::Blocked;
    double z = 0, roll = 0, pitch = 0;  ///< of the robot's origin, m and rad. Falling: where it would have to balance
    /// Distance of the projected centre of mass from the nearest edge of the support polygon, m; negative: outside. The
    /// polygon also counts wheels and feet that are at most 1 mm above the ground. If the distance is below
    /// Options::min_stability, it also counts contacts onto which the robot rocks with little motion.
    double margin = 0;
    /// How far the robot can be raised straight up from its rest until it meets something, m.
    double headroom = std::numeric_limits<double>::infinity();
    /// Largest height of the level robot's origin from which it falls freely onto its first contacts, m. Only if
    /// Options::wants_drop.
    double drop_z = std::numeric_limits<double>::infinity();
    double tip_over = 0, belly = 0;  ///< as in SettledPose
    /// Height of the robot's lowest point on the vertical line through its origin above the origin, m; 0: no such
    /// point.
    double underside = 0;
    std::vector<RestContact> contacts;  ///< those that the margin counts
    std::optional<std::uint32_t> wall;  ///< Blocked: the part of the scene that leaves no room

    double tilt() const;  ///< angle between the robot's z axis and the vertical, rad
};

class NearSolid;

/// Lets robots down on the ground of a scene.
class Settler {
public:
    struct Options {
        double max_tilt = 0.78539816339744831;  ///< rad; a robot that tilts more is falling
        double max_height = 1;                  ///< m; the level robot must find room within this height of its layer
        double min_stability = 0;               ///< m; see Rest::margin
        /// m; what is higher above the robot is not examined, and Rest::headroom and drop_z may be too large there.
        double headroom = std::numeric_limits<double>::infinity();
        bool wants_drop = true;  ///< Rest::drop_z is computed
    };

    /// What a thread keeps from one robot to the next one, for one Settler: memory, the solids at the last place, and
    /// how the robot rests on a plane at its last headings.
    class Workspace {
    public:
        Workspace();
        ~Workspace();
        Workspace(const Workspace&) = delete;
        Workspace& operator=(const Workspace&) = delete;

    private:
        friend Settler;
        struct Kept;
        const std::unique_ptr<Kept> kept_;
    };

    Settler(const Geometry& geometry, const Robot& robot, const Options& options);

    const Vec3& mass_center() const { return mass_center_; }  ///< in the robot's frame, m

    /// Lets the robot down at (x, y) with this yaw onto the terrain layer at a height. It moves only in z, roll and
    /// pitch: level down to the first contact, then it turns about its contacts so that its centre of mass sinks.
    Rest settle(double x, double y, double yaw, double layer, Workspace& workspace) const;
    Rest settle(double x, double y, double yaw, double layer) const;

    double reach() const { return reach_; }  ///< m: the distance of the robot's farthest point from its origin

    /// Announces that most of the next robots are let down in this rectangle. They share work if it is small.
    void expect(const Rect& places, Workspace& workspace) const;

private:
    class Descent;
    struct FlatRest;
    FlatRest flat_rest(double yaw, Descent& descent) const;
    const FlatRest& flat_rest(double yaw, Workspace& workspace) const;
    std::optional<Rest> rest_on_flat_ground(double yaw, const std::vector<NearSolid>& solids,
                                            Workspace& workspace) const;

    const Geometry geometry_;
    const Options options_;
    std::vector<Convex> parts_;  ///< in the robot's frame
    /// Segments between parts that do not touch each other. They only keep the level robot from starting with ground
    /// between its parts.
    std::vector<Convex> joints_;
    Vec3 mass_center_;
    double reach_;
};

}  // namespace spawnfield
