#pragma once

#include "base/rect.h"
#include "geometry/geometry_impl.h"

#include <algorithm>
#include <optional>
#include <vector>

namespace spawnfield {

/// Finds the tiles of a geometry near one robot after the other. It keeps the tiles near the last robot, or those of a
/// rectangle, if the caller knows that the next robots are in it.
class NearTiles {
public:
    /// The geometry must live as long as this object.
    explicit NearTiles(const Geometry::Impl& geometry) : geometry_(geometry) {}

    /// Says that the boxes around the next robots lie in this rectangle. There should be many of them, because the
    /// first one finds all tiles of the rectangle. Boxes beyond it are found, too.
    void expect(const Rect& area)
    {
        expected_ = area;
        is_binned_ = false;
    }

    /// Calls visit(tile) for each tile that meets a box, until it returns false.
    template <class Visit>
    void visit(const Bounds& space, const Visit& visit)
    {
        if (is_expected(space)) {
            visit_binned(space, visit);
            return;
        }
        for (const auto& [tile, box] : tiles_near(space))
            if (overlap(box, space) && !visit(tile)) return;
    }

private:
    struct Near {
        Tile tile;
        ElementBox box;
    };
    struct BinRange {
        std::uint32_t first_col, last_col, first_row, last_row;
    };
    /// A tile in a bin.
    struct Entry {
        ElementBox box;
        std::uint32_t tile;                  ///< its index in binned_
        std::uint16_t first_col, first_row;  ///< of the bins that it meets
    };

    bool is_expected(const Bounds& space) const
    {
        return expected_ && space.min.x() >= expected_->low_x && space.max.x() <= expected_->high_x &&
               space.min.y() >= expected_->low_y && space.max.y() <= expected_->high_y;
    }
    template <class Visit>
    void visit_binned(const Bounds& space, const Visit& visit)
    {
        if (!is_binned_) bin_expected();
        const auto [first_col, last_col, first_row, last_row] = bins_of(space.min.x(), space.min.y(), space.max.x(),
                                                                        space.max.y());
        for (std::uint32_t row = first_row; row <= last_row; ++row)
            for (std::uint32_t col = first_col; col <= last_col; ++col) {
                const std::size_t bin = std::size_t{row} * cols_ + col;
                for (std::uint32_t e = starts_[bin]; e < starts_[bin + 1]; ++e) {
                    const Entry& entry = entries_[e];
                    const bool is_first = col == std::max<std::uint32_t>(first_col, entry.first_col) &&
                                          row == std::max<std::uint32_t>(first_row, entry.first_row);
                    if (is_first && overlap(entry.box, space) && !visit(binned_[entry.tile])) return;
                }
            }
    }
    BinRange bins_of(double low_x, double low_y, double high_x, double high_y) const;
    void bin_expected();
    const std::vector<Near>& tiles_near(const Bounds& space);

    const Geometry::Impl& geometry_;
    Bounds known_;            ///< all tiles that meet this box are in near_
    Bounds last_;             ///< the last box
    std::vector<Near> near_;  ///< a few of them may not meet known_
    std::optional<Rect> expected_;
    // The tiles of the expected rectangle, in square bins seen from above. The bins at its rim also have what is
    // beyond.
    bool is_binned_ = false;
    double bins_per_metre_ = 0;
    std::uint32_t cols_ = 1, rows_ = 1;
    std::vector<std::uint32_t> starts_;  ///< of each bin in entries_; then their number
    std::vector<Entry> entries_;
    std::vector<Tile> binned_;
};

}  // namespace spawnfield
