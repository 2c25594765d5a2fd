#pragma once

#include <cstdint>
#include <vector>

namespace spawnfield {

/// A rectangle of grid cells: rows first_row .. end_row - 1, columns first_col .. end_col - 1.
struct CellRectangle {
    int first_row = 0, end_row = 0, first_col = 0, end_col = 0;
};

/// Returns rectangles that cover exactly the cells for which is_in(row, col) is true, each cell once. The cells are
/// visited row by row, from row 0. Each rectangle is first made as wide as possible, then extended over as many rows as
/// possible. O(rows x cols).
template <class IsIn>
std::vector<CellRectangle> blocks_of(int rows, int cols, const IsIn& is_in)
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
    std::vector<CellRectangle> out;
    for (int row = 0; row < rows; ++row)
        for (int col = 0; col < cols; ++col) {
            if (!cell(row, col)) continue;
            CellRectangle rectangle{row, row + 1, col, col + 1};
            while (rectangle.end_col < cols && cell(row, rectangle.end_col)) ++rectangle.end_col;
            while (rectangle.end_row < rows && all_remain(rectangle.end_row, rectangle.first_col, rectangle.end_col))
                ++rectangle.end_row;
            for (int r = rectangle.first_row; r < rectangle.end_row; ++r)
                for (int c = rectangle.first_col; c < rectangle.end_col; ++c) cell(r, c) = 0;
            out.push_back(rectangle);
        }
    return out;
}

}  // namespace spawnfield
