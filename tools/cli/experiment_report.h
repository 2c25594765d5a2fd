#pragma once

#include <spawnfield/types.h>

#include <optional>
#include <string>
#include <vector>

namespace spawnfield::cli {

/// One raster or one random search of an experiment.
struct ExperimentRun {
    int number = 1;                      ///< number among the runs of its step, beginning with 1
    std::optional<double> step, step_z;  ///< m; only for rasters; step_z only for 3D rasters
    std::optional<std::uint64_t> seed;   ///< only for searches
    VerdictCounts counts;
    std::uint64_t exact_checks = 0;
    double seconds = 0;  ///< of the query alone
};

struct Experiment {
    std::string command_line, map, map_hash, robot;
    unsigned threads = 1;
    std::optional<std::uint64_t> seed;  ///< of the first search
    std::vector<ExperimentRun> runs;    ///< those of one step after each other
    bool has_page = false;              ///< there is a review.html beside the report
};

/// Returns a CSV table with a row for each run: run,step,step_z,poses, the count of each verdict,
/// exact_checks,seconds,seed. A field is empty if it does not apply.
std::string experiment_csv(const std::vector<ExperimentRun>& runs);

/// Returns a description of the experiment, and a table with a row for each step: the means over its runs, and the
/// sample variance of their seconds (n - 1; empty for a single run).
std::string experiment_markdown(const Experiment& experiment);

}  // namespace spawnfield::cli
