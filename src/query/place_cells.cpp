#include "query/place_cells.h"

#include <algorithm>
#include <cmath>

namespace spawnfield {
namespace {

constexpr double most_place_cells = 1 << 20, smallest_place_cell = 0.02;  // number, and m
constexpr double cell_slack = 1e-6;                                       // m; larger than the rounding of coordinates

std::uint32_t count_of(double length, double side)
{
    return std::uint32_t(std::clamp(std::ceil(length / side), 1.0, most_place_cells));
}

}  // namespace

/// A raster in which rectangles are marked in a time that does not depend on their size: the corners of a rectangle
/// change the sums of all cells after them (a summed area table, backwards).
class PlaceCells::Marks {
public:
    explicit Marks(const PlaceCells& cells)
        : cells_(cells), corners_((std::size_t{cells.cols_} + 1) * (std::size_t{cells.rows_} + 1))
    {
    }

    /// Marks all cells within `reach` of boxes, m.
    void add(const std::vector<ElementBox>& boxes, double reach)
    {
        for (const ElementBox& box : boxes) {
            const auto [from_x, to_x] = range(box.min[0] - reach, box.max[0] + reach, 0, cells_.width_, cells_.cols_);
            const auto [from_y, to_y] = range(box.min[1] - reach, box.max[1] + reach, 1, cells_.height_, cells_.rows_);
            if (from_x >= to_x || from_y >= to_y) continue;
            ++at(from_x, from_y);
            --at(to_x, from_y);
            --at(from_x, to_y);
            ++at(to_x, to_y);
        }
    }

    /// Clears the flags of cells that are not marked.
    void keep_marked(std::vector<std::uint8_t>& flags)
    {
        for (std::uint32_t row = 0; row < cells_.rows_; ++row) {
            std::int64_t in_row = 0;
            for (std::uint32_t col = 0; col < cells_.cols_; ++col) {
                in_row += at(col, row);
                at(col, row) = in_row + (row > 0 ? at(col, row - 1) : 0);
                if (at(col, row) == 0) flags[std::size_t{row} * cells_.cols_ + col] = 0;
            }
        }
    }

private:
    std::int64_t& at(std::uint32_t col, std::uint32_t row)
    {
        return corners_[std::size_t{row} * (cells_.cols_ + 1) + col];
    }

    /// Returns the first cell that an interval meets along an axis, and the one after the last.
    std::pair<std::uint32_t, std::uint32_t> range(double low, double high, int axis, double side,
                                                  std::uint32_t count) const
    {
        const double start = cells_.box_.min[axis];
        const auto limited = [&](double value) { return std::uint32_t(std::clamp(value, 0.0, double(count))); };
        return {limited(std::floor((low - cell_slack - start) / side)),
                limited(std::floor((high + cell_slack - start) / side) + 1)};
    }

    const PlaceCells& cells_;
    std::vector<std::int64_t> corners_;
};

PlaceCells::PlaceCells(const PlaceJudge& places, const Bounds& box) : box_(box)
{
    const Eigen::Vector2d size = (box.max - box.min).head<2>();
    if (!(size.minCoeff() >= 0)) return;
    const double side = std::max(std::sqrt(size.x() * size.y() / most_place_cells), smallest_place_cell);
    cols_ = count_of(size.x(), side);
    rows_ = count_of(size.y(), side);
    width_ = size.x() / cols_;
    height_ = size.y() / rows_;
    std::vector<std::uint8_t> flags(std::size_t{cols_} * rows_, 1);
    for (const PlaceJudge::NearParts& near : places.near()) {
        if (std::isinf(near.high)) continue;
        Marks marks(*this);
        marks.add(near.parts.boxes(), near.high + places.reach());
        marks.keep_marked(flags);
    }
    if (places.on_parts()) {
        Marks marks(*this);
        marks.add(places.on_parts()->boxes(), places.reach());
        marks.keep_marked(flags);
    }
    for (std::uint32_t cell = 0; cell < flags.size(); ++cell)
        if (flags[cell] != 0 && places.may_be_at_distances(at(cell))) cells_.push_back(cell);
}

Rect PlaceCells::at(std::uint32_t cell) const
{
    const std::uint32_t col = cell % cols_, row = cell / cols_;
    const auto x = [&](std::uint32_t c) { return std::min(box_.max.x(), box_.min.x() + c * width_); };
    const auto y = [&](std::uint32_t r) { return std::min(box_.max.y(), box_.min.y() + r * height_); };
    return {x(col), y(row), x(col + 1), y(row + 1)};
}

Eigen::Vector2d PlaceCells::draw(Draw& from) const
{
    const Rect cell = at(cells_[std::min(cells_.size() - 1, std::size_t(from.unit() * double(cells_.size())))]);
    const double x = from.uniform(cell.low_x, cell.high_x), y = from.uniform(cell.low_y, cell.high_y);
    return {x, y};
}

}  // namespace spawnfield
