#include "landform.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace worlds {

using Eigen::Vector2d;

void Waves::add(double direction, double wavelength, double phase)
{
    const double per_metre = 2 * std::numbers::pi / wavelength;
    waves_.push_back({per_metre * Vector2d(std::cos(direction), std::sin(direction)), phase});
}

double Waves::sum_at(const Vector2d& p) const
{
    double sum = 0;
    for (const auto& [turns, phase] : waves_) sum += std::sin(turns.dot(p) + phase);
    return sum;
}

double smooth_step(double from, double to, double x)
{
    const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
    return t * t * (3 - 2 * t);
}

}  // namespace worlds
