#pragma once

#include <spawnfield/collision.h>
#include <spawnfield/fleet.h>

#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

namespace spawnfield {

/// The robots of a fleet that have been placed. Decides whether another one has room among them.
class PlacedRobots {
public:
    /// Throws ArgumentError for distances beyond their limits.
    PlacedRobots(std::span<const FleetKind> kinds, const FleetOptions& options);

    enum class Room : std::uint8_t { Clear, TooClose, Overlaps };
    Room room_for(std::size_t kind, const Spawn& spawn) const;

    void add(std::size_t kind, const Spawn& spawn);
    /// Removes the robots that were added last, until `size` are left.
    void shrink(std::size_t size);
    std::size_t size() const { return placed_.size(); }

private:
    struct Placed {
        std::size_t kind;
        Pose pose;
    };
    /// What two kinds have to do with each other.
    struct Relation {
        double distance = 0;  ///< m, between origins
        std::optional<CollisionChecker>
            collision;  ///< of the first kind with the second one, in the second one's frame
    };
    using Cell = std::uint64_t;
    const Relation& relation(std::size_t kind, std::size_t other) const { return relations_[kind * count_ + other]; }
    /// Returns the cell of a point, or one that is so many columns and rows away from it.
    Cell cell_at(const Vec3& point, int columns = 0, int rows = 0) const;

    const std::size_t count_;  ///< of kinds
    std::vector<Relation> relations_;
    std::vector<double> radii_;  ///< m: no part of a kind's robot is farther from its origin
    double cell_ = 1;            ///< m: robots with anything to do with each other are in neighbouring cells
    std::vector<Placed> placed_;
    std::unordered_map<Cell, std::vector<std::uint32_t>> cells_;  ///< indices in placed_
};

/// Returns the largest distance of a part of the robot from its origin, m, or slightly more.
double reach_of(const Robot& robot);

inline Pose pose_of(const Spawn& spawn)
{
    return {spawn.position, rotation_from_rpy(spawn.roll, spawn.pitch, spawn.yaw)};
}

}  // namespace spawnfield
