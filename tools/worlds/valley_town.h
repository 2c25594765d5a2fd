#pragma once

#include "placer.h"

namespace worlds {

/// The rotated frame of a town. Its two streets run along u and v through its centre.
struct TownFrame {
    Vec2 centre;
    double turn;  ///< rad from x to u

    Vec2 point(double u, double v) const
    {
        const double c = std::cos(turn), s = std::sin(turn);
        return centre + Vec2(c * u - s * v, s * u + c * v);
    }
};

/// Adds a town: a square with a fountain where two streets cross, houses along the streets and behind them, a church,
/// gardens, lamps and cars.
void add_town(Placer& placer, Random& random, const TownFrame& frame);

}  // namespace worlds
