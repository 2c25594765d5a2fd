#include "valley_land.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace worlds {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double plain_height = 50, town_height = 50.3, hill_height = 56;  // m
constexpr double broad_height = 1.2, rough_height = 0.5;                   // m, amplitude of the waves

/// Returns 1 in the middle of a disc and 0 on its rim and beyond, with a level tangent at both.
double bell(const Disc& disc, const Vec2& p)
{
    const double distance = std::min(1.0, (p - disc.centre).norm() / disc.radius);
    return 0.5 + 0.5 * std::cos(pi * distance);
}

}  // namespace

Waves waves_between(Random& random, double shortest, double longest)
{
    constexpr int count = 8;
    Waves out;
    for (int i = 0; i < count; ++i) {
        const double wavelength = random.between(shortest, longest);
        const double direction = 2 * pi * (i + random.between(0, 1)) / count;
        out.add(direction, wavelength, random.between(0, 2 * pi));
    }
    return out;
}

double swing(const Waves& waves, const Vec2& p) { return waves.sum_at(p) / double(waves.count()); }

ValleyLand::ValleyLand(Random& random)
    : broad_(waves_between(random, 120, 260)), rough_(waves_between(random, 18, 40)),
      bay_phase_(random.between(0, 2 * pi)),
      cape_phase_(random.between(0, 2 * pi)), lake_{{random.between(120, 130), random.between(112, 122)}, 63},
      town_{{random.between(290, 300), random.between(205, 215)}, 85}, hill_{{random.between(460, 468),
                                                                              random.between(456, 464)},
                                                                             125}
{
}

/// Returns 0 in the middle of the lake and 1 at its shore, which has bays and capes.
double ValleyLand::from_shore(const Vec2& p) const
{
    const Vec2 out = p - lake_.centre;
    const double direction = std::atan2(out.y(), out.x());
    const double shore = 0.8 + 0.12 * std::sin(2 * direction + bay_phase_) +
                         0.07 * std::sin(3 * direction + cape_phase_);
    return out.norm() / (shore * lake_.radius);
}

double ValleyLand::unevenness(const Vec2& p) const
{
    const double east_of_town = smooth_step(370, 400, p.x() + 45 * swing(broad_, p));
    const double south = 1 - smooth_step(60, 100, p.y() + 45 * swing(broad_, p));
    return std::max(east_of_town, south * smooth_step(230, 270, p.x()));
}

/// Returns the height of the land without the town and the lake, m.
double ValleyLand::plain(const Vec2& p) const
{
    return plain_height + broad_height * swing(broad_, p) + rough_height * unevenness(p) * swing(rough_, p) +
           hill_height * bell(hill_, p);
}

double ValleyLand::height(const Vec2& p) const
{
    const double built = 1 - smooth_step(town_.radius, town_.radius + 30, (p - town_.centre).norm());
    const double land = plain(p) + built * (town_height + 0.004 * (p - town_.centre).x() - plain(p));
    const double shore = from_shore(p);
    if (shore <= 1) return water - (water - lake_bed) * (1 - shore * shore);
    return water + (land - water) * (1 - std::exp(-2.5 * (shore - 1)));
}

double ValleyLand::slope(const Vec2& p) const
{
    const Vec2 dx(0.5, 0), dy(0, 0.5);
    return std::atan(Vec2(height(p + dx) - height(p - dx), height(p + dy) - height(p - dy)).norm());
}

}  // namespace worlds
