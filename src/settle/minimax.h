#pragma once

#include "base/polygon2.h"

#include <spawnfield/types.h>

#include <array>
#include <span>

namespace spawnfield {

/// A plane over two variables: height + gradient . d.
struct MinimaxRow {
    double height;
    Vec2 gradient;
};

/// The lowest point of the highest of several planes.
struct Minimax {
    Vec2 at = Vec2::Zero();
    double value = 0;
    /// Three rows that hold the point up, with weights >= 0. The weights of all planes among them add up to 1, and
    /// their gradients, so weighted, to 0. A row of -1 is a limit of the variables and no plane.
    std::array<int, 3> rows{-1, -1, -1};
    std::array<double, 3> weights{};

    bool is_at_limit() const;  ///< a limit of the variables holds the point
};

/// Finds the d with |d.x|, |d.y| <= limit at which the highest of the planes (at least one) is lowest: a linear program
/// with three variables. Source: the dual simplex method (Lemke, The dual method of solving the linear programming
/// problem, 1954).
Minimax lowest_of_highest(std::span<const MinimaxRow> rows, double limit);

}  // namespace spawnfield
