#pragma once

#include <spawnfield/export.h>
#include <spawnfield/scene.h>

#include <memory>

namespace spawnfield {

/// A scene cut into tiles as seen from above, so that a query touches only what is near it. Cheap to copy: copies share
/// the tiles. Any number of threads may read one at the same time; reading a damaged tile of a map throws FileError.
///
/// Element e of the scene is triangle e, or primitive e - triangles. Tiles lie on grids of growing cell size; an
/// element is in each of the at most 2 x 2 tiles that it overlaps on the first grid whose cells are no smaller than it.
/// A tile holds its elements with their corners, labels and pieces, and a fine grid of its own that finds them; a tile
/// that lies in a file is checked when it is first touched. About 90 bytes for each triangle of a closed mesh.
class SPAWNFIELD_API Geometry {
public:
    Geometry();  ///< of nothing
    explicit Geometry(const Scene& scene, int threads = 0);

    std::uint64_t element_count() const;
    const Bounds& bounds() const;            ///< of all elements
    const std::vector<Part>& parts() const;  ///< of the scene, in its order
    const LabelCounts& labels() const;

    struct Impl;
    explicit Geometry(std::shared_ptr<const Impl> impl);
    const Impl& impl() const { return *impl_; }

private:
    std::shared_ptr<const Impl> impl_;
};

}  // namespace spawnfield
