#pragma once

#include "free_space/bounds_tile.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace spawnfield {

/// The highest value of neighbouring columns of a tile. It computes this for all windows of columns at once, eight at a
/// time, so that the answer for one window takes two reads.
class RowMaxima {
public:
    using Values = std::array<std::uint16_t, BoundsTile::side>;  ///< one for each column of the tile
    static constexpr int widest = BoundsTile::side - 1;          ///< columns of a window

    int wide() const { return wide_; }
    /// Sets the columns' values, and how wide windows are: 1 .. widest columns.
    void set(const Values& values, int wide)
    {
        wide_ = wide;
        std::copy(values.begin(), values.end(), values_.begin() + left);
        const int first = left - (wide / Eight::width + 1) * Eight::width;
        for (int at = first; at < left + int(BoundsTile::side); at += Eight::width) {
            const std::uint16_t* const from = values_.data() + at;
            Eight highest = Eight::read(from);
            for (int k = 1; k < wide; ++k) highest.raise(Eight::read(from + k));
            highest.write(windows_.data() + at);
        }
    }

    /// Returns the highest value of these columns, which are as many as a window has, or one more. Columns beyond the
    /// tile do not count.
    std::uint16_t highest(int first, int last) const
    {
        return std::max(windows_[std::size_t(left + first)], windows_[std::size_t(left + last + 1 - wide_)]);
    }

private:
    /// Eight neighbouring values in one register. The type is an extension of GCC and clang.
    struct Eight {
        static constexpr int width = 8;
        std::uint16_t __attribute__((vector_size(16))) values;

        static Eight read(const std::uint16_t* from)
        {
            Eight out;
            std::memcpy(&out, from, sizeof out);
            return out;
        }
        void raise(const Eight& by) { values = values > by.values ? values : by.values; }
        void write(std::uint16_t* to) const { std::memcpy(to, &values, sizeof values); }
    };

    static constexpr int left = BoundsTile::side + Eight::width;  ///< columns before the tile; windows may begin there

    int wide_ = 1;
    // From `left` columns before the tile on. Columns beyond the tile are zero.
    std::array<std::uint16_t, 2 * left + BoundsTile::side> values_{}, windows_{};  ///< windows begin in their column
};

}  // namespace spawnfield
