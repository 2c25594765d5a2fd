#pragma once

#include "query_args.h"

namespace spawnfield::cli {

/// Options of random draws, for `search`, `sample` and `experiment`.
struct DrawArgs {
    long long count = 0, max_failures = 100000;
    std::uint64_t seed = 0;
    double min_distance = 0;
};
void add_draws(CLI::App& command, DrawArgs& args);
void add_max_failures(CLI::App& command, DrawArgs& args);

/// Throws ArgumentError for counts and distances out of range.
void check_draws(const DrawArgs& args);

/// Returns a search's options without the yaw. `bounds` is the value of --bounds, or empty; flat_allowed: it may have
/// four numbers. Throws ArgumentError.
SearchOptions search_options(const QueryArgs& args, const DrawArgs& draws, const std::string& bounds,
                             const std::string& label, bool flat_allowed = false);

}  // namespace spawnfield::cli
