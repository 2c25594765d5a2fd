#pragma once

#include "free_space/bounds_tile.h"
#include "free_space/footprint.h"

#include <spawnfield/column.h>
#include <spawnfield/free_space.h>

#include <array>
#include <limits>

namespace spawnfield {

struct FreeSpace::Impl {
    SolidBounds bounds;
    Robot robot;
    std::vector<Footprint> ahead;  ///< upright, at yaw 0
    std::vector<Footprint> every_yaw;
};

/// Asks the mask, and keeps what neighbouring poses share: the footprints at one rotation, and the cells that they
/// cover from one row of poses. One for each thread.
class Mask {
public:
    explicit Mask(const FreeSpace::Impl& space) : space_(space), raster_(space.bounds.impl()) {}

    void face(double yaw);  ///< upright
    void face_every_yaw();
    void face(const Mat3& rotation);  ///< any; if tilted, nothing is Blocked
    void set_y(double y);             ///< of the poses to come, m
    Proof at(double x, double z);
    /// Whether something solid on the vertical line through the origin, whose spans these are, is inside a part for
    /// certain.
    bool is_pierced(std::span<const Span> spans, double z) const;

private:
    /// Cells of one row that a part covers, relative to the column of its origin; inner ones lie within it whole.
    struct CoverRow {
        int row;
        double low, high, inner_low, inner_high;
    };
    struct OpenTile {
        BoundsTile tile;
        int col = -1, row = -1;
        double a_quantum = 0;  ///< 1 / quantum of the tile
    };
    struct CellRange {
        int first, last;  ///< columns, inclusive
    };
    static constexpr CellRange no_cells{std::numeric_limits<int>::max(), std::numeric_limits<int>::min()};
    struct Pass {
        std::size_t level;
        bool is_ready = false;
        std::vector<CoverRow> rows;  ///< one after the other
        double low = 0, high = 0;    ///< of all rows
        std::vector<CellRange>
            left;  ///< of each row: outside of it, all is proven free at the last pose that was asked for
        std::array<OpenTile, 4> tiles;  ///< the last ones that were looked at: all that a part straddles
    };
    struct Part {
        Footprint footprint;
        std::vector<Pass> passes;  ///< coarse to fine
        bool is_around_origin;     ///< the inner prism, as seen from above
    };
    struct Heights;

    void set_footprints(const std::vector<Footprint>& footprints, double cosine, double sine);
    void choose_passes(Part& part) const;
    void cover(const Part& part, Pass& pass) const;
    const OpenTile& tile_of(Pass& pass, int col, int row) const;
    static CellRange open_cells(const Pass& pass, const CoverRow& cover, const Pass* coarser, double u);
    bool is_clear(const Part& part, Pass& pass, double x, double z) const;
    static bool is_hit(const BoundsTile& tile, std::uint32_t cell, const Heights& heights);
    static bool is_free(const BoundsTile& tile, std::uint32_t cell, const Heights& heights);
    Proof at(const Part& part, Pass& pass, const Pass* coarser, double x, double z) const;

    const FreeSpace::Impl& space_;
    const SolidBounds::Impl& raster_;
    std::vector<Part> parts_;
    double y_ = 0;
};

}  // namespace spawnfield
