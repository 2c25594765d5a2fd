#pragma once

#include "base/rect.h"
#include "query/draw.h"
#include "query/place_judge.h"

#include <spawnfield/types.h>

namespace spawnfield {

/// The cells of a region in which a robot may comply with PlaceRules: those near the parts and in the rings of the
/// rules. In the other cells it certainly does not. All cells have the same size, so that a random point in a random
/// cell is uniform by area. Rules about sight, clearance and `not_on` do not leave out cells.
class PlaceCells {
public:
    PlaceCells(const PlaceJudge& places, const Bounds& box);

    bool is_empty() const { return cells_.empty(); }
    double area() const { return double(cells_.size()) * width_ * height_; }  ///< m2

    /// Returns a random point in a random cell.
    Eigen::Vector2d draw(Draw& from) const;

private:
    class Marks;
    Rect at(std::uint32_t cell) const;

    Bounds box_;
    std::uint32_t cols_ = 0, rows_ = 0;
    double width_ = 0, height_ = 0;  ///< of a cell, m
    std::vector<std::uint32_t> cells_;
};

}  // namespace spawnfield
