#pragma once

#include <spawnfield/types.h>

#include <cmath>
#include <unordered_map>
#include <vector>

namespace spawnfield {

/// Points in a hash grid with cells of the distance that is asked for, so that a look-up meets 27 cells.
/// Source: Bridson, Fast Poisson Disk Sampling in Arbitrary Dimensions, 2007 (the background grid).
class SpacedPoints {
public:
    explicit SpacedPoints(double distance) : distance_(distance) {}

    /// Whether every point so far is at least the distance away. Always true for a distance of 0.
    bool is_clear(const Vec3& point) const
    {
        if (!(distance_ > 0)) return true;
        const Cell centre = cell_of(point);
        for (std::int64_t dx = -1; dx <= 1; ++dx)
            for (std::int64_t dy = -1; dy <= 1; ++dy)
                for (std::int64_t dz = -1; dz <= 1; ++dz) {
                    const auto found = cells_.find({centre[0] + dx, centre[1] + dy, centre[2] + dz});
                    if (found == cells_.end()) continue;
                    for (const Vec3& other : found->second)
                        if ((other - point).norm() < distance_) return false;
                }
        return true;
    }

    void add(const Vec3& point)
    {
        if (distance_ > 0) cells_[cell_of(point)].push_back(point);
    }

private:
    using Cell = std::array<std::int64_t, 3>;
    struct CellHash {
        std::size_t operator()(const Cell& cell) const
        {
            std::uint64_t hash = 0;
            for (const std::int64_t c : cell) hash = (hash ^ std::uint64_t(c)) * 0x9E3779B97F4A7C15 + (hash >> 29);
            return hash;
        }
    };

    Cell cell_of(const Vec3& point) const
    {
        Cell cell{};
        for (int axis = 0; axis < 3; ++axis) cell[axis] = std::int64_t(std::floor(point[axis] / distance_));
        return cell;
    }

    const double distance_;
    std::unordered_map<Cell, std::vector<Vec3>, CellHash> cells_;
};

}  // namespace spawnfield
