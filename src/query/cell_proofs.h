#pragma once

#include "query/area_index.h"
#include "query/cell_facets.h"
#include "query/avoid_index.h"
#include "query/pose_judge.h"

#include <spawnfield/query.h>

#include <vector>

namespace spawnfield {

/// Proves that no further sample can stand anywhere in a cell, from the scene's own geometry and without the mask, so
/// that the proofs are the same with the mask and without it.
///
/// A cell's layers lie between heights that the planes of its terrain give. At each such height, as far as layers are
/// ground there, all poses must be off the area, outside, too close to one taken or avoided position, under water, or
/// collide: the robot eroded by half a cell does at its centre, or some point of the robot is inside the ground at
/// every pose. Lines within 1e-9 m of an upright face are ignored. A cell without a proof stays open, for example one
/// half on an obstacle as flat as the offset. max_slope only makes valid poses invalid, so a cell that is closed
/// without it is closed with it; cells where all ground is steep stay open.
class CellProofs {
public:
    /// options.offset is given. `taken` may grow between calls of is_closed, never during them.
    CellProofs(const Judge::Impl& shared, const SampleOptions& options, const AreaIndex& area,
               const SpacedPoints& taken, const AvoidIndex& avoided);
    ~CellProofs();

    /// Prepares proofs for cells of these half sides, m. Must not run at the same time as is_closed.
    void set_half_cell(double half_x, double half_y);
    bool is_closed(const Rect& cell) const;

private:
    struct Prism;
    class Cell;
    /// The robot's inside, smaller by half a cell and by half a range of heights: where it collides, the robot does at
    /// every pose of the cell.
    struct Eroded {
        double half_height;  ///< m
        CollisionChecker checker;
    };
    Robot eroded(double half_x, double half_y, double half_height) const;

    const Judge::Impl& shared_;
    const SampleOptions& options_;
    const double offset_;
    const ZRange ground_z_;  ///< layers elsewhere are no ground, or give poses that are outside
    const ZRange layer_z_;   ///< layers elsewhere are no ground
    const AreaIndex& area_;
    const SpacedPoints& taken_;
    const AvoidIndex& avoided_;
    std::vector<Prism> prisms_;   ///< within the robot at every yaw that is drawn, relative to its origin
    std::vector<Eroded> eroded_;  ///< from the lowest range of heights on
};

}  // namespace spawnfield
