#pragma once

#include <spawnfield/robot.h>
#include <spawnfield/solid_bounds.h>

namespace spawnfield {

/// What images can prove of a pose.
enum class Proof : std::uint8_t { Candidate, Free, Blocked };

/// The free-space mask of a robot: which poses surely collide with nothing, and which surely with something, from the
/// heights of what is solid in each cell under and around it. What is neither, the CollisionChecker decides.
///
/// Free: no cell that a part of the robot overlaps, seen from above and 1e-5 m wider, holds anything solid between the
/// part's lowest and highest point. Blocked: some cell that a part covers whole holds something solid inside the part,
/// 1e-5 m from its surface. Each part counts by itself, so a low body and a thin mast do not block each other. Coarse
/// cells first, finer ones where those cannot tell. This is grey dilation of the scene by the robot (Lozano-Pérez,
/// Spatial planning: a configuration space approach, 1983), done only where it is asked for.
class FreeSpace {
public:
    /// m that proofs stay away from contact: more than FCL's tolerance and touch_margin.
    static constexpr double margin = 1e-5;

    FreeSpace(const SolidBounds& bounds, const Robot& robot);
    FreeSpace(FreeSpace&&) noexcept;
    ~FreeSpace();

    /// At any rotation. Tilted robots are never Blocked.
    Proof at(const Pose& scene_from_robot) const;
    /// Upright: roll and pitch are 0.
    Proof at(const Vec3& position, double yaw) const;
    /// Free, or Blocked: at every yaw. By discs around the parts and within them.
    Proof at_every_yaw(const Vec3& position) const;

    struct Impl;
    const Impl& impl() const { return *impl_; }

private:
    std::unique_ptr<const Impl> impl_;
};

}  // namespace spawnfield
