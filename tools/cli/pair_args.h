#pragma once

#include "session.h"

#include <spawnfield/pairs.h>

#include <limits>

namespace spawnfield::cli {

/// Options on pairs of a start and a goal.
struct PairArgs {
    long long count = 0;
    double min_path = 0, max_path = std::numeric_limits<double>::infinity(), detour = 1;  ///< m, m, ratio
    std::string path;                                                                     ///< file
    bool fast_paths = false;
    std::string scene_id;
};

/// Values of --format that only pairs have.
inline const std::vector<std::string> pair_formats{"habitat", "nav2-goals"};

/// Adds --min-path, --max-path, --detour and --fast-paths.
void add_pair_limits(CLI::App& command, PairArgs& args);
inline const std::vector<std::string> pair_limit_names{"--min-path", "--max-path", "--detour", "--fast-paths"};

/// Returns the options that add_pair_limits() adds. Throws ArgumentError for values beyond their limits.
PairOptions pair_limits(const PairArgs& args);

/// Adds --pairs for `sample`, and all that belongs to it.
void add_pairs(CLI::App& command, PairArgs& args);

/// Throws ArgumentError if one of these options was given without --pairs. `format` is the value of --format.
void refuse_pair_options(const CLI::App& command, const std::string& format);

/// Returns the options of pairs, except PairOptions::spawns. Throws ArgumentError for options that do not go together.
PairOptions pair_options(const PairArgs& args, const CLI::App& command, bool is_settled, const std::string& format);

/// Writes the pairs to the file `out`, and the paths if they are wanted: both files, or none.
void write_pairs(const CommonArgs& common, const PairArgs& args, const std::string& format, const std::string& out,
                 const Session& session, const PairList& list, const PairOptions& options);

/// Returns why there are fewer pairs than wanted, and what may give more.
std::string shortfall_of_pairs(const PairList& list, std::size_t wanted);

}  // namespace spawnfield::cli
