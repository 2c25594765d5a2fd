#pragma once

#include <cstdint>
#include <vector>

namespace spawnfield {

/// A block of grid cells: rows first_row .. last_row - 1, columns first_col .. last_col - 1.
struct CellBlock {
    int first_row = 0, last_row = 0, first_col = 0, last_col = 0;
};

/// Returns blocks that cover exactly the cells for which is_in(row, col) is true, each cell once. Starting from row 0,
/// each block is first made as wide as possible, then as high as possible. O(rows x cols).
template <class IsIn>
std::vector<CellBlock> blocks_of(int rows, int cols, const IsIn& is_in)
{
    std::vector<std::uint8_t> remaining(std::size_t(rows) * std::size_t(cols));
    const auto cell = [&](int row, int col) -> std::uint8_t& {
        return remaining[std::size_t(row) * std::size_t(cols) + std::size_t(col)];
    };
    for (int row = 0; row < rows; ++row)
        for (int col = 0; col < cols; ++col) cell(row, col) = is_in(row, col);
    const auto all_remain = [&](int row, int first, int last) {
        for (int col = first; col < last; ++col)
            if (!cell(row, col)) return false;
        return true;
    };
    std::vector<CellBlock> out;
    for (int row = 0; row < rows; ++row)
        for (int col = 0; col < cols; ++col) {
            if (!cell(row, col)) continue;
            CellBlock block{row, row + 1, col, col + 1};
            while (block.last_col < cols && cell(row, block.last_col)) ++block.last_col;
            while (block.last_row < rows && all_remain(block.last_row, block.first_col, block.last_col))
                ++block.last_row;
            for (int r = block.first_row; r < block.last_row; ++r)
                for (int c = block.first_col; c < block.last_col; ++c) cell(r, c) = 0;
            out.push_back(block);
        }
    return out;
}

}  // namespace spawnfield
