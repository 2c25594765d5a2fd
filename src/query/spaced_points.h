#pragma once

#include <spawnfield/types.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace spawnfield {

/// Points in a hash grid. The cells are twice as large as the distance, so a look-up examines 8 cells: four rows of two
/// adjacent table entries. Cells that share an entry also share its list of points. This is harmless, because the
/// distances decide. Source: Bridson, Fast Poisson Disk Sampling in Arbitrary Dimensions, 2007 (the background grid).
class SpacedPoints {
public:
    explicit SpacedPoints(double distance) : distance_(distance), reach_(std::min(distance * (1 + slack), farthest)) {}

    double distance() const { return distance_; }

    /// Returns whether all points are at least the distance away. Always true for a distance of 0.
    bool is_clear(const Vec3& point) const
    {
        return !any_near(point, [&](const Vec3& other) { return (other - point).norm() < distance_; });
    }

    /// Returns whether `test` is true for a point near this one. It is called for all points nearer than the distance,
    /// and for some others.
    template <class Test>
    bool any_near(const Vec3& point, const Test& test) const
    {
        if (points_.empty()) return false;
        const Vec3 around = Vec3::Constant(reach_);
        const Cell first = cell_of(point - around), last = cell_of(point + around);
        for (std::uint64_t z = first[2]; z != last[2] + 1; ++z)
            for (std::uint64_t y = first[1]; y != last[1] + 1; ++y) {
                const std::uint64_t row = row_start(y, z);
                for (std::uint64_t x = first[0]; x != last[0] + 1; ++x)
                    for (std::uint32_t i = heads_[(row + x) & mask_]; i != none; i = points_[i].next)
                        if (test(points_[i].position)) return true;
            }
        return false;
    }

    void add(const Vec3& point)
    {
        if (!(distance_ > 0)) return;
        points_.push_back({point, none});
        if (2 * points_.size() > heads_.size()) {
            heads_.assign(std::max(smallest, 2 * heads_.size()), none);
            mask_ = heads_.size() - 1;
            for (std::uint32_t i = 0; i < points_.size(); ++i) link(i);
        } else {
            link(std::uint32_t(points_.size() - 1));
        }
    }

    void clear()
    {
        points_.clear();
        std::fill(heads_.begin(), heads_.end(), none);
    }

private:
    using Cell = std::array<std::uint64_t, 3>;
    struct Point {
        Vec3 position;
        std::uint32_t next;  ///< index of the next point of the same table entry
    };
    static constexpr std::uint32_t none = 0xffffffff;
    static constexpr std::size_t smallest = 4096;
    static constexpr double slack = 1e-6;      // of the distance; more than rounding errors of coordinates
    static constexpr double farthest = 1e300;  // m; so no sum of a coordinate and reach_ is infinite

    static std::uint64_t row_start(std::uint64_t y, std::uint64_t z)
    {
        const std::uint64_t hash = (y * 0x9E3779B97F4A7C15) ^ (z * 0xC2B2AE3D27D4EB4F);
        return (hash ^ (hash >> 32)) * 0xD6E8FEB86659FD93 >> 16;
    }

    Cell cell_of(const Vec3& point) const
    {
        constexpr double last = 9e18;  // cells; points farther away are put into the outermost cells
        Cell cell{};
        for (int axis = 0; axis < 3; ++axis)
            cell[axis] = std::uint64_t(
                std::int64_t(std::clamp(std::floor(point[axis] / (2 * distance_)), -last, last)));
        return cell;
    }

    void link(std::uint32_t i)
    {
        const Cell cell = cell_of(points_[i].position);
        std::uint32_t& head = heads_[(row_start(cell[1], cell[2]) + cell[0]) & mask_];
        points_[i].next = head;
        head = i;
    }

    const double distance_, reach_;  ///< m
    std::vector<Point> points_;
    std::vector<std::uint32_t> heads_;  ///< index of the last point of each table entry; the size is a power of 2
    std::uint64_t mask_ = 0;
};

}  // namespace spawnfield
