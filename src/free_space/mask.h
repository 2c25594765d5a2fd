#pragma once

#include "free_space/bounds_tile.h"
#include "free_space/footprint.h"

#include <spawnfield/free_space.h>

namespace spawnfield {

struct FreeSpace::Impl {
    SolidBounds bounds;
    Robot robot;
    std::vector<Footprint> ahead;     ///< upright, at yaw 0
    std::vector<Footprint> every_yaw;
};

/// Asks the mask, and keeps what neighbouring poses share: the footprints at one rotation, and the cells that they cover
/// from one row of poses. One for each thread.
class Mask {
public:
    explicit Mask(const FreeSpace::Impl& space) : space_(space), raster_(space.bounds.impl()) {}

    void face(double yaw);                ///< upright
    void face_every_yaw();
    void face(const Mat3& rotation);      ///< any; if tilted, nothing is Blocked
    void set_y(double y);                 ///< of the poses to come, m
    Proof at(double x, double z);

private:
    /// Cells of one row that a part covers, relative to the column of its origin; inner ones lie within it whole.
    struct CoverRow {
        int row;
        double low, high, inner_low, inner_high;
    };
    struct Pass {
        std::size_t level;
        bool is_ready = false;
        std::vector<CoverRow> rows;
        BoundsTile tile = {};               ///< the last one that was looked at
        int tile_col = -1, tile_row = -1;
        double a_quantum = 0;               ///< 1 / quantum of the tile
    };
    struct Part {
        Footprint footprint;
        std::vector<Pass> passes;  ///< coarse to fine
    };
    struct Heights;

    void set_footprints(const std::vector<Footprint>& footprints, double cosine, double sine);
    void choose_passes(Part& part) const;
    void cover(const Part& part, Pass& pass) const;
    Proof at(const Part& part, Pass& pass, double x, double z) const;

    const FreeSpace::Impl& space_;
    const SolidBounds::Impl& raster_;
    std::vector<Part> parts_;
    double y_ = 0;
};

}  // namespace spawnfield
