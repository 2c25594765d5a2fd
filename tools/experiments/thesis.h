#pragma once

#include <cstdint>
#include <vector>

/// Figures that the thesis printed: Ropelato, feasible spawn locations in Unity (PhysX), Clearpath Husky, Ryzen 7
/// 3700X.
namespace thesis {

struct Raster {
    double step;  ///< m
    std::uint64_t checks, valid, invalid;
    double seconds;
    std::uint64_t positions;  ///< that its limits and step give, limits included: what it did not round
};

struct Random {
    double mean;      ///< s
    double variance;  ///< s^2
};

/// Test 1: positions in the empty environment and seconds.
struct Aerial {
    std::uint64_t positions;
    double seconds;
};
const std::vector<Aerial>& aerial();

/// Test 2: ms for 1,000 positions; robot / obstacle.
struct Collision {
    const char* robot;
    const char* obstacle;
    double ms_per_1000;
};
const std::vector<Collision>& collision();

/// Tests 3 to 6: 3D and 2D rasters of the low-complexity and the complex environment.
const std::vector<Raster>& raster(int test);

/// Tests 7 and 8: random search there.
Random random_search(int test);

/// How many times faster than the thesis a test is to be.
double goal(int test);

/// Step from which on its 3D rasters took less time than its 2D ones, m.
inline constexpr double break_even = 1.8;

}  // namespace thesis
