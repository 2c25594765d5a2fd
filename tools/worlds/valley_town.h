#pragma once

#include "placer.h"

namespace worlds {

/// The turned frame of a town: its two streets run along u and v through its centre.
struct TownFrame {
    Vec2 centre;
    double turn;  ///< rad from x to u

    Vec2 point(double u, double v) const
    {
        const double c = std::cos(turn), s = std::sin(turn);
        return centre + Vec2(c * u - s * v, s * u + c * v);
    }
};

/// A square with a fountain where two streets cross, houses along them and behind, a church, gardens, lamps, cars.
void add_town(Placer& placer, Random& random, const TownFrame& frame);

}  // namespace worlds
