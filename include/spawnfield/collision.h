#pragma once

#include <spawnfield/geometry.h>
#include <spawnfield/robot.h>

#include <memory>
#include <optional>

namespace spawnfield {

class OccupancyTree;

/// What a robot collides with: a part of the scene, or occupied voxels where it is checked against an OccupancyTree.
struct CollisionHit {
    static constexpr std::uint32_t occupancy = 0xffffffff;
    std::uint32_t part = occupancy;
};

/// A scene and a robot, ready for queries. Const calls may run at the same time.
///
/// FCL decides (Pan, Chitta, Manocha, FCL: A General Purpose Library for Collision and Proximity Queries, 2012),
/// through its libccd solver. The robot is grown by touch_margin, so that a touching pair reads as collision whatever
/// that solver's rounding says.
class CollisionChecker {
public:
    /// Against the scene's own geometry.
    CollisionChecker(const Geometry& geometry, const Robot& robot);
    /// Against the occupied voxels of a baked tree instead.
    CollisionChecker(std::shared_ptr<const OccupancyTree> tree, const Robot& robot);
    CollisionChecker(CollisionChecker&&) noexcept;
    ~CollisionChecker();

    const Robot& robot() const;
    bool uses_occupancy() const;  ///< rather than the scene's own geometry

    /// Neither touching nor overlapping any solid, nor inside one. Obstacles and terrain count, water does not.
    bool is_free(const Pose& scene_from_robot) const;

    /// The first part, in the scene's order, that the robot collides with; nothing if it is free.
    std::optional<CollisionHit> find_hit(const Pose& scene_from_robot) const;

private:
    struct Impl;  // FCL is seen in src/collision/collision.cpp only
    std::unique_ptr<const Impl> impl_;
};

}  // namespace spawnfield
