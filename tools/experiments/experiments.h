#pragma once

#include "setup.h"

namespace experiments {

/// How an answer came about: the free-space mask with FCL where it can't decide, or FCL at every position
/// (--exhaustive).
enum class Mode { Mask, Fcl };
inline const char* to_string(Mode mode) { return mode == Mode::Mask ? "mask" : "fcl"; }

/// One run of one experiment.
struct Run {
    int test = 0;  ///< 1 to 8, as the thesis counts them
    std::string environment = {}, robot = {};
    std::string obstacle = {};  ///< test 2: "cubes" or "balls"
    Mode mode = Mode::Mask;
    double step = 0;              ///< m; of a search: its least distance
    int repetition = 0;           ///< a search's seed too
    std::uint64_t positions = 0;  ///< checked: columns in 2D, poses in 3D, draws of a search that kept their distance
    std::uint64_t valid = 0, invalid = 0, aerial = 0;  ///< in the thesis's terms: off_terrain is aerial
    std::uint64_t exact_checks = 0;
    double seconds = 0;  ///< of the query, the mask's preparation with it; without reading map and robot
};

/// Seconds until a search had found so many.
struct Milestone {
    std::string environment;
    bool with_distance = true;
    int repetition = 0;
    std::size_t found = 0;
    double seconds = 0;
};

/// Which rasters find a place to stand in a column.
struct ColumnFinds {
    double x, y;
    bool in_2d, in_3d, in_3d_snapped;
};

/// The environments of tests 3 to 8.
struct Districts {
    Environment low, complex;
};

/// Test 1: aerial positions in the empty environment, 10 x 10 columns.
std::vector<Run> aerial_runs(const Settings& settings);

/// Test 2: collisions with 50,000 obstacles, each position one.
std::vector<Run> collision_runs(const Settings& settings, const Environment& cubes, const Environment& balls);

/// Tests 3 to 6: rasters with limits and steps of the thesis.
/// Throws std::runtime_error if a count differs between repetitions or from FCL's at every position.
std::vector<Run> raster_runs(const Settings& settings, const Districts& districts);

/// Tests 7 and 8: 2,000 spawns by random search, with a distance of 2.5 m from all checked positions and without.
std::vector<Run> search_runs(const Settings& settings, const Districts& districts);

/// The search with seed 1 and distance check of test 7 or 8.
spawnfield::SpawnList first_search(const Settings& settings, const Districts& districts, int test);

/// Searches of tests 7 and 8 again, for a part of the spawns each.
std::vector<Milestone> milestones(const Settings& settings, const Districts& districts);

/// 2D beside 3D at steps of 2.5 m and a height of up to 1 m above the ground.
std::vector<ColumnFinds> column_finds(const Settings& settings, const Environment& low);

}  // namespace experiments
