#pragma once

#include <Eigen/Core>

#include <vector>

namespace worlds {

/// A sum of plane sine waves, each of amplitude 1.
class Waves {
public:
    /// Adds a wave. Direction and phase are in rad, the wavelength in m.
    void add(double direction, double wavelength, double phase);

    double sum_at(const Eigen::Vector2d& p) const;
    std::size_t count() const { return waves_.size(); }

private:
    struct Wave {
        Eigen::Vector2d turns;  ///< rad per m along x and y
        double phase;           ///< rad
    };
    std::vector<Wave> waves_;
};

/// Returns 0 up to `from`, 1 from `to` on, and a smooth transition between them.
double smooth_step(double from, double to, double x);

}  // namespace worlds
