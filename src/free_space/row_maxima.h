#pragma once

#include "free_space/bounds_tile.h"
#include "free_space/sixteen.h"

#include <algorithm>
#include <array>

namespace spawnfield {

/// The highest value of neighbouring columns of a tile. It computes this for all windows of columns at once, 16 at a
/// time, so that the answer for some columns takes two reads.
class RowMaxima {
public:
    using Values = std::array<std::uint16_t, BoundsTile::side>;  ///< one for each column of the tile
    static constexpr int widest = BoundsTile::side - 1;          ///< columns of a window

    /// Neighbouring columns: where the first and the last window that they contain begin.
    struct Columns {
        std::uint8_t first = 0, last = 0;  ///< counted from `left` columns before the tile
    };

    int wide() const { return wide_; }
    /// Sets the columns' values, and how wide windows are: 1 .. widest columns.
    void set(const Values& values, int wide)
    {
        wide_ = wide;
        const int first = left - (wide / Sixteen::width + 1) * Sixteen::width;  // windows that begin further left are 0
        std::fill(windows_.begin() + first, windows_.begin() + left, std::uint16_t{0});
        std::copy(values.begin(), values.end(), windows_.begin() + left);
        for (int reach = 1; reach < wide;) {  // windows of `reach` columns become wider, at most twice as wide
            const int more = std::min(reach, wide - reach);
            for (int at = first; at < left + int(BoundsTile::side); at += Sixteen::width) {
                Sixteen highest = Sixteen::read(windows_.data() + at);
                highest.raise(Sixteen::read(windows_.data() + at + more));
                highest.write(windows_.data() + at);
            }
            reach += more;
        }
    }
    /// The same for columns without values.
    void set_zero(int wide)
    {
        wide_ = wide;
        windows_.fill(0);
    }

    /// Returns these columns for windows of `wide` columns. They must be as many as a window has, or one more, and one
    /// of them must be in the tile.
    static Columns columns(int first, int last, int wide)
    {
        return {std::uint8_t(left + first), std::uint8_t(left + last + 1 - wide)};
    }
    /// Returns the highest value of these columns; 0 for Columns(). Columns beyond the tile do not count.
    std::uint16_t highest(const Columns& columns) const
    {
        return std::max(windows_[columns.first], windows_[columns.last]);
    }

private:
    static constexpr int left = BoundsTile::side +
                                Sixteen::width;  ///< columns before the tile; windows may begin there

    int wide_ = 1;
    /// For each column from `left` columns before the tile on: the highest value of the window that begins there.
    std::array<std::uint16_t, 2 * left + BoundsTile::side> windows_{};
    static_assert(std::tuple_size_v<decltype(windows_)> <= 256);  // see Columns
};

}  // namespace spawnfield
