#pragma once

#include "base/rect.h"
#include "collision/near_tiles.h"
#include "column/columns.h"

#include <spawnfield/collision.h>

#include <memory>
#include <vector>

namespace spawnfield {

struct PlacedPart;  // collision.cpp

/// Checks one pose after the other, for one thread. It keeps the tiles of the geometry near the last pose, so checks of
/// neighbouring poses take less time.
class PoseChecker {
public:
    /// The checker must live as long as this object.
    explicit PoseChecker(const CollisionChecker& checker);
    ~PoseChecker();

    /// Says that the origins of many of the next poses lie in this rectangle: they share the search for tiles.
    void expect(const Rect& places);
    /// From now on, uses the tiles that another checker of the same geometry finds: for poses at the same places.
    void share_tiles(const PoseChecker& with) { tiles_ = with.tiles_; }

    /// Does the same as CollisionChecker::is_free. `column` is the column at the pose's x and y, or nullptr if it is
    /// not known.
    bool is_free(const Pose& scene_from_robot, const ColumnView* column = nullptr);
    /// Does the same as CollisionChecker::find_hit.
    std::optional<CollisionHit> find_hit(const Pose& scene_from_robot, const ColumnView* column = nullptr);

private:
    std::optional<CollisionHit> find(const Pose& pose, bool any_will_do, const ColumnView* column);
    void set_rotation(const Mat3& rotation);

    const CollisionChecker::Impl& impl_;
    std::shared_ptr<NearTiles> tiles_;
    Mat3 rotation_;                   ///< of the last pose
    std::vector<PlacedPart> placed_;  ///< the robot's parts, turned by it
    Bounds around_;                   ///< all of them, relative to the robot's position
};

}  // namespace spawnfield
