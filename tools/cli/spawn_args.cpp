#include "spawn_args.h"

#include "common/seed.h"
#include "numbers.h"

namespace spawnfield::cli {

void add_draws(CLI::App& command, DrawArgs& args)
{
    command.add_option("-n,--count", args.count, "Number of spawns");
    command.add_option("--min-distance", args.min_distance, "Smallest distance between positions, m (default 0)");
    command.add_option("--seed", args.seed, "The same seed gives the same spawns (default 0)")
        ->check(tools::seed_complaint);
}

void add_max_failures(CLI::App& command, DrawArgs& args)
{
    command.add_option("--max-failures", args.max_failures,
                       "Stop after so many draws in a row without a spawn (default 100000)");
}

void fill(SpawnOptions& options, const QueryArgs& args, const DrawArgs& draws, const std::string& label)
{
    fill(options, args, label);
    if (draws.count < 1) throw bad_value("-n", double(draws.count), ">= 1");
    if (draws.count > static_cast<long long>(max_spawns))
        throw bad_value("-n", double(draws.count), "at most " + std::to_string(max_spawns));
    options.count = std::size_t(draws.count);
    options.min_distance = parse_finite("--min-distance", draws.min_distance, "m");
    if (options.min_distance < 0) throw bad_value("--min-distance", options.min_distance, ">= 0 m");
    options.seed = draws.seed;
}

SearchOptions search_options(const QueryArgs& args, const DrawArgs& draws, const std::string& bounds,
                             const std::string& label, bool flat_allowed)
{
    SearchOptions options;
    fill(options, args, draws, label);
    if (!bounds.empty()) options.bounds = parse_bounds("--bounds", bounds, flat_allowed);
    if (draws.max_failures < 1) throw bad_value("--max-failures", double(draws.max_failures), ">= 1");
    options.max_failures = std::uint64_t(draws.max_failures);
    return options;
}

}  // namespace spawnfield::cli
