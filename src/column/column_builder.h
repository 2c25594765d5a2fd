#pragma once

#include "column/surface_hit.h"

#include <span>
#include <vector>

namespace spawnfield {

/// Builds columns from the hits of their vertical lines. Reuses its temporary memory for the next column.
class ColumnBuilder {
public:
    /// Appends to `out` the column of these hits, which must be in the order of their elements, and of sheets that are
    /// already known as spans and as heights of water surfaces.
    void build(std::span<const SurfaceHit> hits, Column& out, std::span<const Span> sheets = {},
               std::span<const double> water_sheets = {});

private:
    struct Solid {
        Interval z;
        bool terrain;
    };
    void add_piece(std::span<const SurfaceHit> hits, Column& out);
    void finish(std::size_t first_span, std::size_t first_water, Column& out);
    static void pair_crossings(std::vector<Solid>& crossings, double piece_bottom, std::vector<Solid>& intervals);
    static void join(std::vector<Solid>& intervals);

    std::vector<Solid> intervals_, crossings_;
};

}  // namespace spawnfield
