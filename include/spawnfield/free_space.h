#pragma once

#include <spawnfield/export.h>
#include <spawnfield/robot.h>
#include <spawnfield/solid_bounds.h>

namespace spawnfield {

/// What the mask proves about a pose.
enum class Proof : std::uint8_t { Candidate, Free, Blocked };

/// The free-space mask of a robot. It proves that poses are free or that they collide, from the heights of solid space
/// in the cells under and around the robot. If it has no proof, the CollisionChecker must decide. Any number of threads
/// may call its const methods at the same time; they throw FileError if a tile of a map is damaged.
///
/// Free: each part of the robot is taken as seen from above, and enlarged by 1e-5 m. No cell that it overlaps has
/// anything solid between the part's lowest and highest point. Blocked: a cell lies completely under a part and has
/// something solid inside the part, at least 1e-5 m from the part's surface. Each part is examined on its own, so a low
/// body and a thin mast do not block each other. Coarse cells come first, and finer ones where the coarse ones do not
/// decide. This is grey dilation of the scene by the robot (Lozano-Pérez, Spatial planning: a configuration space
/// approach, 1983), computed only at the poses in question.
class SPAWNFIELD_API FreeSpace {
public:
    /// Distance from contact that proofs keep, m. It is larger than FCL's tolerance and touch_margin.
    static constexpr double margin = 1e-5;

    FreeSpace(const SolidBounds& bounds, const Robot& robot);
    FreeSpace(FreeSpace&&) noexcept;
    ~FreeSpace();

    /// Returns what the mask proves about a pose. A tilted robot is never Blocked.
    Proof proof_of(const Pose& scene_from_robot) const;
    /// The same for an upright robot (roll and pitch are 0).
    Proof proof_of(const Vec3& position, double yaw) const;
    /// Returns what the mask proves about all yaws at this position. Uses discs around the parts and inside them.
    Proof proof_at_every_yaw(const Vec3& position) const;

    struct Impl;
    const Impl& impl() const { return *impl_; }

private:
    std::unique_ptr<const Impl> impl_;
};

}  // namespace spawnfield
