#pragma once

#include "base/polygon2.h"
#include "settle/convex.h"

#include <spawnfield/geometry.h>

#include <span>
#include <vector>

namespace spawnfield {

namespace narrow_phase_module {
struct Functions;
}

/// Decides whether a robot meets something on short ways near a place. For one thread.
///
/// On its way between two poses, each convex part of the robot covers the convex hull of the part at both poses. The
/// robot is enlarged by touch_margin, as in CollisionChecker, so touching counts.
class Sweep {
public:
    Sweep(const Geometry& geometry, const Robot& robot);

    /// Looks for the solids at most `radius` from a place, m. The following ways must lie within it.
    void set_place(const Vec2& place, double radius);

    /// Returns whether the robot meets nothing on a way along these poses, if it is raised by `lift` and enlarged by
    /// `growth` (m). Between two neighbouring poses, each part covers the convex hull of the part at both.
    bool is_free(std::span<const Pose> poses, double lift, double growth = 0);

private:
    struct Solid {
        Convex body;  ///< relative to the place
        Bounds bounds;
    };
    bool may_meet(std::span<const Convex> bodies, double growth);
    bool is_met(std::span<const Convex> bodies, double growth) const;

    const Geometry geometry_;
    const narrow_phase_module::Functions& narrow_phase_;
    std::vector<Convex> parts_;  ///< in the robot's frame
    Vec3 origin_ = Vec3::Zero();
    std::vector<Solid> solids_;
    std::vector<const Solid*> near_;  ///< those that the hull of the whole way may meet
    std::vector<Convex> placed_;      ///< the parts of the robot at each pose of a way
};

}  // namespace spawnfield
