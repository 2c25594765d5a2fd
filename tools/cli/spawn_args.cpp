#include "spawn_args.h"

#include "common/seed.h"
#include "messages.h"
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
                       "Stop after this many draws in a row without a spawn (default 100000)");
}

void check_draws(const DrawArgs& args)
{
    if (args.count < 1) throw bad_value("-n", double(args.count), ">= 1");
    if (args.count > static_cast<long long>(max_spawns))
        throw bad_value("-n", double(args.count), "at most " + std::to_string(max_spawns));
    parse_finite("--min-distance", args.min_distance, "m");
    if (args.min_distance < 0) throw bad_value("--min-distance", args.min_distance, ">= 0 m");
}

SearchOptions search_options(const QueryArgs& args, const DrawArgs& draws, const std::string& bounds,
                             const std::string& label, bool flat_allowed)
{
    check_draws(draws);
    if (draws.max_failures < 1) throw bad_value("--max-failures", double(draws.max_failures), ">= 1");
    return {.count = std::size_t(draws.count),
            .min_distance = draws.min_distance,
            .seed = draws.seed,
            .bounds = bounds.empty() ? Bounds{} : parse_bounds("--bounds", bounds, flat_allowed),
            .max_failures = std::uint64_t(draws.max_failures),
            .threads = args.threads,
            .progress = progress_bar(args, label)};
}

}  // namespace spawnfield::cli
