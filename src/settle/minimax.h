#pragma once

#include "base/polygon2.h"

#include <spawnfield/types.h>

#include <array>
#include <optional>
#include <span>

namespace spawnfield {

/// A plane over the variables d = (x, y). Its height at d is height + gradient . d.
struct MinimaxPlane {
    double height;
    Vec2 gradient;
};

/// The d at which the highest of several planes is lowest.
struct Minimax {
    Vec2 at = Vec2::Zero();
    double value = 0;  ///< height of the highest plane there
    /// The three constraints that hold this point, as indices of planes; -1 to -4: a limit of d. Their weights are >=
    /// 0, and those of the planes add up to 1. If no limit holds the point, the weighted sum of the gradients is 0.
    std::array<int, 3> planes{-1, -1, -1};
    std::array<double, 3> weights{};

    bool is_at_limit() const;  ///< a limit of d holds the point
};

/// Returns the d with |d.x|, |d.y| <= limit at which the highest of the planes (at least one) is lowest: a linear
/// program with three variables. After 1000 steps, it returns the point that it has reached. Source: the dual simplex
/// method (Lemke, The dual method of solving the linear programming problem, 1954). `near` may be the solution for
/// planes that were a little different: then it takes fewer steps.
Minimax lowest_of_highest(std::span<const MinimaxPlane> planes, double limit, const std::optional<Minimax>& near = {});

}  // namespace spawnfield
