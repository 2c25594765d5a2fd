#pragma once

#include <Eigen/Core>

#include <vector>

namespace worlds {

/// A sum of plane sine waves, each of amplitude 1.
class Waves {
public:
    /// Direction and phase in rad, wavelength in m.
    void add(double direction, double wavelength, double phase);

    double at(const Eigen::Vector2d& p) const;
    std::size_t count() const { return waves_.size(); }

private:
    struct Wave {
        Eigen::Vector2d turns;  ///< rad per m along x and y
        double phase;           ///< rad
    };
    std::vector<Wave> waves_;
};

/// 0 up to `from`, 1 from `to` on, smooth between them.
double smooth_step(double from, double to, double x);

}  // namespace worlds
