#pragma once

#include <spawnfield/export.h>
#include <spawnfield/geometry.h>

namespace spawnfield {

/// What is solid in each cell of a raster, and in cells 2, 4, 8, … times as large: the images behind the free-space
/// mask. Cheap to copy: copies share the tiles. Any number of threads may read them at the same time; reading a damaged
/// tile of a map throws FileError.
///
/// Each cell holds how high anything solid in it reaches, rounded up, and where there is a gap below that, the
/// intervals that hold all of its solids, rounded outwards. 16-bit heights in tiles of 64 x 64 cells, each with a range
/// of its own: 2.7 bytes a cell of the finest raster, and about 16 more for a cell over which something hangs.
class SPAWNFIELD_API SolidBounds {
public:
    SolidBounds();  ///< of nothing: it proves nothing
    /// Cells of this side (m) over the bounds, seen from above. O(elements + cells).
    SolidBounds(const Geometry& geometry, const Bounds& bounds, double cell, int threads = 0,
                const Progress& progress = {});

    struct Impl;
    explicit SolidBounds(std::shared_ptr<const Impl> impl);
    const Impl& impl() const { return *impl_; }

private:
    std::shared_ptr<const Impl> impl_;
};

}  // namespace spawnfield
