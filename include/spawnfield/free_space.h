#pragma once

#include <spawnfield/export.h>
#include <spawnfield/robot.h>
#include <spawnfield/solid_bounds.h>

namespace spawnfield {

/// What the mask can prove of a pose.
enum class Proof : std::uint8_t { Candidate, Free, Blocked };

/// The free-space mask of a robot: which poses surely collide with nothing, and which surely with something, from the
/// heights of what is solid in each cell under and around it. What is neither, the CollisionChecker decides. Any number
/// of threads may call its const methods at the same time; they throw FileError if a tile of a damaged map turns up.
///
/// Free: no cell that a part of the robot overlaps, seen from above and 1e-5 m wider, holds anything solid between the
/// part's lowest and highest point. Blocked: some cell that a part covers whole holds something solid inside the part,
/// 1e-5 m from its surface. Each part counts by itself, so a low body and a thin mast do not block each other. Coarse
/// cells first, finer ones where those cannot decide. This is grey dilation of the scene by the robot (Lozano-Pérez,
/// Spatial planning: a configuration space approach, 1983), done only where it is asked for.
class SPAWNFIELD_API FreeSpace {
public:
    /// m that proofs stay away from contact: more than FCL's tolerance and touch_margin.
    static constexpr double margin = 1e-5;

    FreeSpace(const SolidBounds& bounds, const Robot& robot);
    FreeSpace(FreeSpace&&) noexcept;
    ~FreeSpace();

    /// Returns what is proven of a pose. Tilted robots are never Blocked.
    Proof proof_of(const Pose& scene_from_robot) const;
    /// The same for an upright robot: roll and pitch are 0.
    Proof proof_of(const Vec3& position, double yaw) const;
    /// Returns what is proven of every yaw at this position, by discs around the parts and within them.
    Proof proof_at_every_yaw(const Vec3& position) const;

    struct Impl;
    const Impl& impl() const { return *impl_; }

private:
    std::unique_ptr<const Impl> impl_;
};

}  // namespace spawnfield
