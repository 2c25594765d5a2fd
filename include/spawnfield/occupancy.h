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

    double resolution() const;   ///< side of the smallest voxels, m
    const Vec3& origin() const;  ///< where 0, 0, 0 of the tree is in the scene, m
    std::size_t leaves() const;
    enum class State { Free, Occupied, Unknown };
    State at(const Vec3& point) const;  ///< in the scene

    /// Writes a binary .bt, in the tree's own coordinates. Throws OutputError.
    void write(const std::filesystem::path& file) const;
    const Impl& impl() const { return *impl_; }

private:
    std::unique_ptr<const Impl> impl_;
};

/// Returns where 0, 0, 0 of the tree of a scene with these bounds is in the scene, m. It is 0, 0, 0, unless the bounds
/// reach more than 32768 voxels from there along an axis, as with coordinates of a survey: OctoMap's keys have 16 bits.
/// Then it is a multiple of 128 voxels near their middle. Throws ArgumentError as build_occupancy().
SPAWNFIELD_API Vec3 occupancy_origin(const Bounds& bounds, double resolution);

/// Returns the tree of a scene, pruned. Inside the bounds, a voxel is occupied if a solid surface touches it or if its
/// centre is inside a solid; all other voxels are free. Outside the bounds, voxels are unknown. Round primitives are
/// replaced by polygons of 256 sides around them, so they may be up to 0.01 % of their radius too wide. Throws
/// ArgumentError unless resolution > 0 and the bounds have fewer than 65280 voxels along each axis.
SPAWNFIELD_API OccupancyTree build_occupancy(const Geometry& geometry, const Bounds& bounds, double resolution,
                                             int threads = 0, const Progress& progress = {});

/// Writes the same tree to a binary .bt, but without creating its nodes, so it needs a hundredth of the memory. Returns
/// the number of its leaves. Also throws OutputError.
SPAWNFIELD_API std::size_t write_occupancy(const std::filesystem::path& file, const Geometry& geometry,
                                           const Bounds& bounds, double resolution, int threads = 0,
                                           const Progress& progress = {});

/// Reads a binary .bt; `origin`: where its 0, 0, 0 is in the scene, m. Throws FileError.
SPAWNFIELD_API OccupancyTree read_occupancy(const std::filesystem::path& file, const Vec3& origin = Vec3::Zero());

}  // namespace spawnfield
