#pragma once

#include <spawnfield/export.h>
#include <spawnfield/column.h>

#include <filesystem>
#include <memory>

namespace spawnfield {

/// Occupied, free and unknown space as an OctoMap (Hornung et al., OctoMap: An Efficient Probabilistic 3D Mapping
/// Framework Based on Octrees, 2013). Any number of threads may call its const methods at the same time.
class SPAWNFIELD_API OccupancyTree {
public:
    struct Impl;
    explicit OccupancyTree(std::unique_ptr<Impl> impl);
    OccupancyTree(OccupancyTree&&) noexcept;
    ~OccupancyTree();

    double resolution() const;  ///< side of the smallest voxels, m
    std::size_t leaves() const;
    enum class State { Free, Occupied, Unknown };
    State at(const Vec3& point) const;

    void write(const std::filesystem::path& file) const;  ///< as a binary .bt; throws OutputError
    const Impl& impl() const { return *impl_; }

private:
    std::unique_ptr<const Impl> impl_;
};

/// Returns the tree of a scene, pruned. Inside the bounds, a voxel is occupied if a solid surface touches it or if its
/// centre is inside a solid; all other voxels are free. Outside the bounds, voxels are unknown. Round primitives are
/// replaced by polygons of 256 sides around them, so they may be up to 0.01 % of their radius too wide. Throws
/// ArgumentError unless resolution > 0 and the bounds lie within 32768 voxels of the scene's origin (OctoMap's keys
/// have 16 bits).
SPAWNFIELD_API OccupancyTree build_occupancy(const Geometry& geometry, const Bounds& bounds, double resolution,
                                             int threads = 0, const Progress& progress = {});

/// Writes the same tree to a binary .bt, but without creating its nodes, so it needs a hundredth of the memory. Returns
/// the number of its leaves. Also throws OutputError.
SPAWNFIELD_API std::size_t write_occupancy(const std::filesystem::path& file, const Geometry& geometry,
                                           const Bounds& bounds, double resolution, int threads = 0,
                                           const Progress& progress = {});

/// Reads a binary .bt. Throws FileError.
SPAWNFIELD_API OccupancyTree read_occupancy(const std::filesystem::path& file);

}  // namespace spawnfield
