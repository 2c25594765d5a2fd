#pragma once

#include <cstdint>
#include <vector>

/// Figures that are printed in the thesis: Ropelato, feasible spawn locations in Unity (PhysX), with a Clearpath Husky,
/// on a Ryzen 7 3700X.
namespace thesis {

struct Raster {
    double step;  ///< m
    std::uint64_t checks, valid, invalid;
    double seconds;
    std::uint64_t positions;  ///< exact number of positions for its limits (inclusive) and step; `checks` is rounded
};

struct Random {
    double mean;      ///< s
    double variance;  ///< s^2
};

/// Test 1: positions in the empty environment, and seconds.
struct Aerial {
    std::uint64_t positions;
    double seconds;
};
const std::vector<Aerial>& aerial();

/// Test 2: time of a robot against an obstacle.
struct Collision {
    const char* robot;
    const char* obstacle;
    double ms_per_1000;  ///< ms for 1,000 positions
};
const std::vector<Collision>& collision();

/// Tests 3 to 6: 3D and 2D rasters of the low-complexity and the complex environment.
const std::vector<Raster>& raster(int test);

/// Tests 7 and 8: random search in these environments.
Random random_search(int test);

/// Returns how many times faster than the thesis a test must be.
double goal(int test);

/// Step in m from which on the 3D rasters of the thesis took less time than its 2D rasters.
inline constexpr double break_even = 1.8;

}  // namespace thesis
