#pragma once

#include "column/columns.h"
#include "geometry/tile_tree.h"

#include <spawnfield/collision.h>

#include <vector>

namespace spawnfield {

/// Checks one pose after the other, for one thread. It keeps the tiles of the geometry near the last pose, so checks of
/// neighbouring poses take less time.
class PoseChecker {
public:
    /// The checker must live as long as this object.
    explicit PoseChecker(const CollisionChecker& checker) : impl_(checker.impl()) {}

    /// Does the same as CollisionChecker::is_free. `column` is the column at the pose's x and y, or nullptr if it is
    /// not known.
    bool is_free(const Pose& scene_from_robot, const ColumnView* column = nullptr);
    /// Does the same as CollisionChecker::find_hit.
    std::optional<CollisionHit> find_hit(const Pose& scene_from_robot, const ColumnView* column = nullptr);

private:
    struct NearTile {
        Tile tile;
        ElementBox box;
    };
    std::optional<CollisionHit> find(const Pose& pose, bool any_will_do, const ColumnView* column);
    const std::vector<NearTile>& tiles_near(const Bounds& space);

    const CollisionChecker::Impl& impl_;
    Bounds known_;                 ///< all tiles that meet this box are in tiles_
    Bounds last_;                  ///< around the robot at the last pose
    std::vector<NearTile> tiles_;  ///< a few of them may not meet known_
};

}  // namespace spawnfield
