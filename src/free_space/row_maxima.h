#pragma once

#include "free_space/bounds_tile.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace spawnfield {

/// The highest value of neighbouring columns of a tile. It takes the maxima of all windows of columns at once
/// (van Herk's idea of shared maxima), so that the question for one window takes two reads.
class RowMaxima {
public:
    using Values = std::array<std::uint16_t, BoundsTile::side>;  ///< one for each column of the tile
    static constexpr int widest = BoundsTile::side - 1;          ///< columns of a window

    int wide() const { return wide_; }
    /// Sets the columns' values, and how wide windows are: 1 .. widest columns.
    void set(const Values& values, int wide)
    {
        wide_ = wide;
        // Columns beyond the tile are zero. Some more are read together with the last ones.
        std::array<std::uint16_t, left + BoundsTile::side + left + Eight::width> row{};
        std::copy(values.begin(), values.end(), row.begin() + left);
        const int first = left - wide / Eight::width * Eight::width - Eight::width;
        const auto join = [&](int by) {
            for (int at = first; at < left + int(BoundsTile::side); at += Eight::width)
                Eight::highest(row.data() + at, row.data() + at + by).write(row.data() + at);
        };
        int joined = 1;
        for (; 2 * joined <= wide; joined *= 2) join(joined);
        if (joined < wide) join(wide - joined);
        std::copy_n(row.begin(), windows_.size(), windows_.begin());
    }

    /// Returns the highest value of these columns, which are as many as a window has, or one more. Columns beyond the
    /// tile do not count.
    std::uint16_t highest(int first, int last) const
    {
        return std::max(windows_[std::size_t(left + first)], windows_[std::size_t(left + last + 1 - wide_)]);
    }

private:
    static constexpr int left = BoundsTile::side + 8;  ///< columns before the tile that a window may begin in

    /// Eight neighbouring values in one register. The type is an extension of GCC and clang.
    struct Eight {
        static constexpr int width = 8;
        std::uint16_t __attribute__((vector_size(16))) values;

        static Eight highest(const std::uint16_t* a, const std::uint16_t* b)
        {
            Eight left, right;
            std::memcpy(&left, a, sizeof left);
            std::memcpy(&right, b, sizeof right);
            return {left.values > right.values ? left.values : right.values};
        }
        void write(std::uint16_t* to) const { std::memcpy(to, &values, sizeof values); }
    };

    int wide_ = 1;
    std::array<std::uint16_t, left + BoundsTile::side + 1> windows_{};  ///< from `left` columns before the tile on
};

}  // namespace spawnfield
