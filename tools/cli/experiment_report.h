#pragma once

#include <spawnfield/types.h>

#include <optional>
#include <string>
#include <vector>

namespace spawnfield::cli {

/// One raster or one random search of an experiment.
struct ExperimentRun {
    int number = 1;                      ///< among those of its step, from 1 on
    std::optional<double> step, step_z;  ///< m; of rasters, step_z of 3D ones
    std::optional<std::uint64_t> seed;   ///< of searches
    VerdictCounts counts;
    std::uint64_t exact_checks = 0;
    double seconds = 0;  ///< of the query alone
};

struct Experiment {
    std::string command_line, map, map_hash, robot;
    unsigned threads = 1;
    std::optional<std::uint64_t> seed;  ///< of the first search
    std::vector<ExperimentRun> runs;    ///< those of one step after each other
};

/// A row per run: run,step,step_z,poses, each verdict's count, exact_checks,seconds,seed; empty where it does not
/// apply.
std::string experiment_csv(const std::vector<ExperimentRun>& runs);

/// What was run where, and a table with a row per step: means over its runs, and the sample variance of their seconds
/// (n - 1; empty for a single run).
std::string experiment_markdown(const Experiment& experiment);

}  // namespace spawnfield::cli
