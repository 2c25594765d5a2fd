#pragma once

#include "setup.h"

namespace experiments {

/// How answers are found: by the free-space mask, with FCL for the poses that it cannot decide, or by FCL at every
/// position (--exhaustive).
enum class Mode { Mask, Fcl };
inline const char* to_string(Mode mode) { return mode == Mode::Mask ? "mask" : "fcl"; }

/// One run of one experiment.
struct Run {
    int test = 0;  ///< 1 to 8, the numbers of the thesis
    std::string environment = {}, robot = {};
    std::string obstacle = {};  ///< test 2: "cubes" or "balls"
    Mode mode = Mode::Mask;
    double step = 0;     ///< m; for a search: its minimum distance
    int repetition = 0;  ///< for a search also its seed
    std::uint64_t positions =
        0;  ///< number of checked positions: columns in 2D, poses in 3D, draws of a search that kept their distance
    std::uint64_t valid = 0, invalid = 0, aerial = 0;  ///< in the thesis's terms: off_terrain is aerial
    std::uint64_t exact_checks = 0;
    double seconds = 0;  ///< of the query with the preparation of the mask; without reading map and robot
};

/// The time until a search had found `found` spawns.
struct Milestone {
    std::string environment;
    bool with_distance = true;
    int repetition = 0;
    std::size_t found = 0;
    double seconds = 0;
};

/// Which rasters find a valid place in a column.
struct ColumnFinds {
    double x, y;
    bool in_2d, in_3d, in_3d_snapped;
};

/// The environments of tests 3 to 8.
struct Districts {
    Environment low, complex;
};

/// Runs test 1: aerial positions in the empty environment, 10 x 10 columns.
std::vector<Run> aerial_runs(const Settings& settings);

/// Runs test 2: collisions with 50,000 obstacles; every position collides.
std::vector<Run> collision_runs(const Settings& settings, const Environment& cubes, const Environment& balls);

/// Runs tests 3 to 6: rasters with the limits and steps of the thesis. Throws std::runtime_error if a count differs
/// between repetitions, or from the count of FCL at every position.
std::vector<Run> raster_runs(const Settings& settings, const Districts& districts);

/// Runs tests 7 and 8: random searches for 2,000 spawns, with a distance of 2.5 m from all checked positions and
/// without.
std::vector<Run> search_runs(const Settings& settings, const Districts& districts);

/// Runs the search of test 7 or 8 with seed 1 and with the distance check.
spawnfield::SpawnList first_search(const Settings& settings, const Districts& districts, int test);

/// Runs the searches of tests 7 and 8 again, each for one to eight eighths of the spawns.
std::vector<Milestone> milestones(const Settings& settings, const Districts& districts);

/// Compares 2D and 3D rasters at steps of 2.5 m; valid poses are at most 1 m above the ground.
std::vector<ColumnFinds> column_finds(const Settings& settings, const Environment& low);

}  // namespace experiments
