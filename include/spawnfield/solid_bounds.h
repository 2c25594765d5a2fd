#pragma once

#include <spawnfield/export.h>
#include <spawnfield/geometry.h>

namespace spawnfield {

/// The heights of solid space in each cell of a raster, and in cells 2, 4, 8, … times as large. The free-space mask
/// uses these images. Cheap to copy: copies share the tiles. Any number of threads may read them at the same time.
/// Reading a damaged tile of a map throws FileError.
///
/// Each cell contains the height of its highest solid point, rounded up. If there is a gap below that point, it also
/// contains the intervals in which all its solids lie, rounded outwards. Heights have 16 bits. They are stored in tiles
/// of 64 x 64 cells, and each tile has its own range of heights. A cell of the finest raster needs 2.7 bytes, and about
/// 16 more if something hangs over it.
class SPAWNFIELD_API SolidBounds {
public:
    SolidBounds();  ///< without cells: it proves nothing
    /// Makes images of the bounds, seen from above. `cell` is the side of the smallest cells, m. O(elements + cells).
    SolidBounds(const Geometry& geometry, const Bounds& bounds, double cell, int threads = 0,
                const Progress& progress = {});

    struct Impl;
    explicit SolidBounds(std::shared_ptr<const Impl> impl);
    const Impl& impl() const { return *impl_; }
    const std::shared_ptr<const Impl>& shared_impl() const { return impl_; }

private:
    std::shared_ptr<const Impl> impl_;
};

}  // namespace spawnfield
