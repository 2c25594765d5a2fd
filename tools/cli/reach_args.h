#pragma once

#include "query_args.h"

#include <spawnfield/reach.h>

namespace spawnfield::cli {

/// Options on how the robot drives.
struct ReachArgs {
    std::string drive = "differential";
    double max_step = 0.03;            ///< m
    std::optional<double> reach_step;  ///< m
};

/// Adds, below the heading "Reach", --drive, --max-step and --reach-step.
void add_reach(CLI::App& command, ReachArgs& args);
inline const std::vector<std::string> reach_option_names{"--drive", "--max-step", "--reach-step"};

/// Finds where the robot can drive. `command` is the name that the progress bar shows.
ReachGraph make_reach_graph(const CommonArgs& common, const ReachArgs& args, const Judge& judge,
                            const std::string& command);

}  // namespace spawnfield::cli
