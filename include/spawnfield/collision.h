#pragma once

#include <spawnfield/export.h>
#include <spawnfield/geometry.h>
#include <spawnfield/robot.h>

#include <memory>
#include <optional>

namespace spawnfield {

class OccupancyTree;

/// What a robot collides with: a part of the scene, or occupied voxels if the checker uses an OccupancyTree.
struct CollisionHit {
    static constexpr std::uint32_t occupancy = 0xffffffff;
    std::uint32_t part = occupancy;
};

/// Decides whether a robot collides with a scene. A Judge contains one. Use it without a Judge if only collisions
/// matter.
///
/// Any number of threads may call its const methods at the same time. They read the scene's tiles when they first need
/// them, so they throw FileError if a tile of a map is damaged. FCL decides (Pan, Chitta, Manocha, FCL: A General
/// Purpose Library for Collision and Proximity Queries, 2012), with its libccd solver. It is not asked about a triangle
/// if a separating axis test proves that a box is more than FreeSpace::margin from it, or overlaps it by more than
/// twice that. The robot is enlarged by touch_margin, so that touching counts as a collision in spite of the solver's
/// rounding.
class SPAWNFIELD_API CollisionChecker {
public:
    /// Checks against the scene's own geometry. `fcl_only`: without the separating axis test, which is slower.
    CollisionChecker(const Geometry& geometry, const Robot& robot, bool fcl_only = false);
    /// Checks against the occupied voxels of a baked tree instead.
    CollisionChecker(std::shared_ptr<const OccupancyTree> tree, const Robot& robot);
    CollisionChecker(CollisionChecker&&) noexcept;
    ~CollisionChecker();

    const Robot& robot() const;
    bool uses_occupancy() const;  ///< false: it uses the scene's own geometry

    /// Returns whether the robot neither touches nor overlaps any solid, nor is inside one. Obstacles and terrain
    /// count, water does not.
    bool is_free(const Pose& scene_from_robot) const;

    /// Returns the part that the robot collides with, the first one in the scene's order; nothing if the robot is free.
    std::optional<CollisionHit> find_hit(const Pose& scene_from_robot) const;

    struct Impl;
    const Impl& impl() const { return *impl_; }

private:
    std::unique_ptr<const Impl> impl_;
};

/// Loads FCL on another thread. Make one before a map is read, if a CollisionChecker or a Judge will be made from it:
/// then this waits less, and the threads of later queries are ready. Does nothing if only one thread is wanted
/// (`threads`; 0: all cores). The destructor waits until FCL is loaded. If it cannot be loaded, the constructor of the
/// checker throws.
class SPAWNFIELD_API CollisionPreload {
public:
    explicit CollisionPreload(int threads = 0);
    ~CollisionPreload();

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace spawnfield
