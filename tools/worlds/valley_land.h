#pragma once

#include "landform.h"
#include "random.h"

namespace worlds {

using Vec2 = Eigen::Vector2d;

/// Returns eight waves in all directions, with wavelengths between two limits, m.
Waves waves_between(Random& random, double shortest, double longest);

/// Returns the sum of the waves, scaled to -1 .. 1.
double swing(const Waves& waves, const Vec2& p);

/// A disc on the map.
struct Disc {
    Vec2 centre;    ///< m
    double radius;  ///< m
};

/// Heights of a valley of 500 x 500 m: a plain with a lake, level ground for a town, uneven ground, and a hill.
class ValleyLand {
public:
    static constexpr double water = 46.5;     ///< m, height of the lake's surface
    static constexpr double lake_bed = 31.2;  ///< m, height of the lowest ground

    explicit ValleyLand(Random& random);

    const Disc& lake() const { return lake_; }  ///< contains all of the water
    const Disc& town() const { return town_; }
    const Disc& hill() const { return hill_; }

    double height(const Vec2& p) const;      ///< m
    double slope(const Vec2& p) const;       ///< rad
    double unevenness(const Vec2& p) const;  ///< 0 .. 1: the share of rough ground
    bool is_dry(const Vec2& p, double above_water = 0.3) const { return height(p) > water + above_water; }

private:
    double from_shore(const Vec2& p) const;
    double plain(const Vec2& p) const;

    Waves broad_, rough_;
    double bay_phase_, cape_phase_;
    Disc lake_, town_, hill_;
};

}  // namespace worlds
