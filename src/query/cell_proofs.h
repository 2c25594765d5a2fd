#pragma once

#include "query/area_index.h"
#include "query/cell_facets.h"
#include "query/avoid_index.h"
#include "query/pose_judge.h"

#include <spawnfield/query.h>

#include <vector>

namespace spawnfield {

/// Proves that a cell is closed: no further sample can stand anywhere in it. The proofs use the scene's own geometry
/// and not the mask, so they are the same with and without a mask.
///
/// The planes of the terrain in a cell give bands of heights that contain all of the cell's layers. A cell is closed if
/// in each band one reason holds for all poses on ground: they are off the area, outside, too close to one taken or
/// avoided position, under water, or they collide. There are two proofs of collision: the robot eroded by half a cell
/// collides at the centre of the cell, or some point of the robot is inside the ground, or inside one solid, at every
/// pose. Vertical lines within 1e-9 m of an upright face are ignored.
///
/// A cell without a proof stays open, for example a cell half on an obstacle that is not higher than the offset.
/// Footings (max_slope) only make valid poses invalid, so a cell that is closed without them is closed with them. But
/// steepness is not a proof: a cell in which all ground is steep stays open.
class CellProofs {
public:
    /// options.offset must have a value. `taken` may grow between calls of is_closed(), but not during a call.
    CellProofs(const Judge::Impl& shared, const SampleOptions& options, const AreaIndex& area,
               const SpacedPoints& taken, const AvoidIndex& avoided);
    ~CellProofs();

    /// Sets half the side lengths of the following cells, m. Must not run at the same time as is_closed().
    void set_half_cell(double half_x, double half_y);
    bool is_closed(const Rect& cell) const;

private:
    struct Prism;
    class Cell;
    /// The inside of the robot, eroded by half a cell in x and y and by half_height in z. If it collides at the middle
    /// of a cell and of a band, the robot collides at every pose of both. The band is at most twice half_height high.
    struct Eroded {
        double half_height;  ///< m
        CollisionChecker checker;
    };
    Robot eroded(double half_x, double half_y, double half_height) const;

    const Judge::Impl& shared_;
    const SampleOptions& options_;
    const double offset_;
    const ZRange ground_z_;  ///< layers beyond it are not ground, or their poses are outside
    const ZRange layer_z_;   ///< layers beyond it are not ground
    const AreaIndex& area_;
    const SpacedPoints& taken_;
    const AvoidIndex& avoided_;
    std::vector<Prism> prisms_;   ///< relative to the origin; inside the robot at every yaw that is drawn
    std::vector<Eroded> eroded_;  ///< sorted by half_height
};

}  // namespace spawnfield
