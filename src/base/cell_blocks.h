#pragma once

#include <cstdint>
#include <vector>

namespace spawnfield {

/// Cells of a grid, rows and columns first .. last - 1.
struct CellBlock {
    int first_row = 0, last_row = 0, first_col = 0, last_col = 0;
};

/// Blocks that cover exactly the cells for which is_in(row, col) holds, each cell once: from the first row on, as wide
/// as can be, then as high as can be. O(rows x cols).
template <class IsIn>
std::vector<CellBlock> blocks_of(int rows, int cols, const IsIn& is_in)
{
    std::vector<std::uint8_t> open(std::size_t(rows) * std::size_t(cols));
    const auto at = [&](int row, int col) -> std::uint8_t& {
        return open[std::size_t(row) * std::size_t(cols) + std::size_t(col)];
    };
    for (int row = 0; row < rows; ++row)
        for (int col = 0; col < cols; ++col) at(row, col) = is_in(row, col);
    const auto all_open = [&](int row, int first, int last) {
        for (int col = first; col < last; ++col)
            if (!at(row, col)) return false;
        return true;
    };
    std::vector<CellBlock> out;
    for (int row = 0; row < rows; ++row)
        for (int col = 0; col < cols; ++col) {
            if (!at(row, col)) continue;
            CellBlock block{row, row + 1, col, col + 1};
            while (block.last_col < cols && at(row, block.last_col)) ++block.last_col;
            while (block.last_row < rows && all_open(block.last_row, block.first_col, block.last_col)) ++block.last_row;
            for (int r = block.first_row; r < block.last_row; ++r)
                for (int c = block.first_col; c < block.last_col; ++c) at(r, c) = 0;
            out.push_back(block);
        }
    return out;
}

}  // namespace spawnfield
