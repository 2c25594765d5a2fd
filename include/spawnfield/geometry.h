#pragma once

#include <spawnfield/export.h>
#include <spawnfield/scene.h>

#include <memory>

namespace spawnfield {

/// A scene, cut into tiles, so that a query reads only the tiles near it. Cheap to copy: copies share
/// the tiles. Any number of threads may read it at the same time. Reading a damaged tile of a map throws FileError.
///
/// Elements have numbers: first all triangles, then all primitives. A tile has at most 64 elements that lie near each
/// other, with their corners, labels and pieces. Elements of similar size form a packed tree of tiles (an R-tree whose
/// nodes have 16 children). A tile of a file is checked when it is first used. A closed mesh needs about 36 bytes for
/// each triangle.
class SPAWNFIELD_API Geometry {
public:
    Geometry();  ///< without elements
    explicit Geometry(const Scene& scene, int threads = 0);

    std::uint64_t element_count() const;
    const Bounds& bounds() const;  ///< of all elements together
    /// Of the scene, in the scene's order. Removed parts (changes.h) keep their place, with all counts 0.
    const std::vector<Part>& parts() const;
    bool is_removed(std::size_t part) const;
    /// Of the scene's meshes. Those of removed parts keep their place; those of added parts follow. Empty for maps of a
    /// version before 7.
    const std::vector<FaceGroup>& face_groups() const;
    const LabelCounts& labels() const;

    struct Impl;
    explicit Geometry(std::shared_ptr<const Impl> impl);
    const Impl& impl() const { return *impl_; }

private:
    std::shared_ptr<const Impl> impl_;
};

/// Returns the parts whose name, or a word of it between "::", matches a shell glob (POSIX fnmatch, ignoring case).
/// Removed parts match nothing. Empty if there is none.
SPAWNFIELD_API std::vector<std::size_t> parts_that_match(const Geometry& geometry, const std::string& glob);

}  // namespace spawnfield
