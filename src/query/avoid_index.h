#pragma once

#include "query/spaced_points.h"

#include <spawnfield/query.h>

namespace spawnfield {

/// The points of SearchOptions::avoid, prepared for look-ups: a hash grid for each distance.
class AvoidIndex {
public:
    /// Keeps only the points that are near enough to matter within the x and y of `box`.
    AvoidIndex(const std::vector<AvoidedPoints>& avoid, const Bounds& box)
    {
        constexpr double slack = 1e-6;  // m; larger than the rounding of distances
        grids_.reserve(avoid.size());
        for (const AvoidedPoints& group : avoid) {
            SpacedPoints& grid = grids_.emplace_back(group.distance);
            if (!(group.distance > 0)) continue;
            for (const Vec3& point : group.points) {
                if (!box.contains_xy(point.x(), point.y(), group.distance + slack)) continue;
                grid.add(point);
                ++size_;
            }
        }
    }

    /// Returns whether the distance to every avoided point is at least that of the point's group.
    bool is_clear(const Vec3& point) const
    {
        return std::all_of(grids_.begin(), grids_.end(),
                           [&](const SpacedPoints& grid) { return grid.is_clear(point); });
    }

    const std::vector<SpacedPoints>& grids() const { return grids_; }
    std::size_t size() const { return size_; }

private:
    std::vector<SpacedPoints> grids_;
    std::size_t size_ = 0;
};

}  // namespace spawnfield
