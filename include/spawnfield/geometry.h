#pragma once

#include <spawnfield/export.h>
#include <spawnfield/scene.h>

#include <memory>

namespace spawnfield {

/// A scene, cut into tiles as seen from above, so that a query reads only the tiles near it. Cheap to copy: copies
/// share the tiles. Any number of threads may read it at the same time. Reading a damaged tile of a map throws
/// FileError.
///
/// Elements have numbers: first all triangles, then all primitives. Tiles lie on several grids; the cells of each grid
/// are larger than those of the grid before. An element uses the first grid whose cells are at least as large as the
/// element, and is stored in all tiles that it overlaps there: at most 2 x 2. A tile contains its elements with their
/// corners, labels and pieces, and a fine grid to find them. A tile of a file is checked when it is first used. A
/// closed mesh needs about 90 bytes for each triangle.
class SPAWNFIELD_API Geometry {
public:
    Geometry();  ///< without elements
    explicit Geometry(const Scene& scene, int threads = 0);

    std::uint64_t element_count() const;
    const Bounds& bounds() const;            ///< of all elements together
    const std::vector<Part>& parts() const;  ///< of the scene, in the scene's order
    const LabelCounts& labels() const;

    struct Impl;
    explicit Geometry(std::shared_ptr<const Impl> impl);
    const Impl& impl() const { return *impl_; }

private:
    std::shared_ptr<const Impl> impl_;
};

}  // namespace spawnfield
