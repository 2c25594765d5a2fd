#include "../compare.h"

#include <CLI/CLI.hpp>

#include <chrono>
#include <iostream>

using namespace spawnfield;

namespace {

struct FuzzArgs {
    double seconds = 60;
    std::uint64_t seed = 1, scenes = 0;
    bool independent = false, keep_going = false;
};

void add_options(CLI::App& app, FuzzArgs& args)
{
    app.add_option("--seconds", args.seconds, "Start no new scene after this time (default 60)")
        ->check(CLI::PositiveNumber);
    app.add_option("--seed", args.seed, "Seed of the first scene; the next scenes use the next seeds (default 1)");
    app.add_option("--scenes", args.scenes, "Maximum number of scenes (default: as many as the time allows)");
    app.add_flag("--independent", args.independent,
                 "Instead, compare check with a second implementation in the tests that uses neither FCL nor a mask");
    app.add_flag("--keep-going", args.keep_going, "Continue after a difference; the exit status is 1 all the same");
    app.footer(
        "Example, and how to repeat a scene that it printed:\n"
        "  spawnfield_fuzz --seconds 600 --seed 1\n"
        "  spawnfield_fuzz --seed 4711 --scenes 1");
}

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

void print_difference(const HardCase& hard, const compare::Tally& tally)
{
    std::cout << "seed " << hard.seed << ": " << tally.differences << " differences\n"
              << "resolution " << hard.resolution << ", offset " << hard.offset << ", " << hard.scene.parts.size()
              << " parts:";
    for (std::size_t i = 0; i < hard.scene.parts.size(); ++i) std::cout << " " << i << " " << hard.scene.parts[i].name;
    std::cout << "\nrobot " << hard.robot.name << "\n"
              << compare::described(hard.robot) << "first: " << tally.first << "\n"
              << "repeat: spawnfield_fuzz --seed " << hard.seed << " --scenes 1" << std::endl;
}

void print_progress(std::uint64_t scenes, double seconds, const compare::Tally& all)
{
    std::cout << scenes << " scenes, " << all.poses << " poses, " << all.exact << " of " << all.asked
              << " checked exactly, " << all.differences << " differences, " << int(seconds) << " s" << std::endl;
}

int run(const FuzzArgs& args)
{
    const Clock::time_point start = Clock::now();
    compare::Tally all;
    double printed_at = 0;
    std::uint64_t scenes = 0;
    for (; seconds_since(start) < args.seconds && (args.scenes == 0 || scenes < args.scenes); ++scenes) {
        const HardCase hard = hard_case(args.seed + scenes);
        const compare::Tally tally = args.independent
                                         ? compare::independently(hard_case(args.seed + scenes, {.razor = false}))
                                         : compare::of_case(hard).sum();
        all.add(tally);
        if (tally.differences > 0) print_difference(hard, tally);
        if (tally.differences > 0 && !args.keep_going) return 1;
        if (seconds_since(start) - printed_at < 10) continue;
        printed_at = seconds_since(start);
        print_progress(scenes + 1, printed_at, all);
    }
    print_progress(scenes, seconds_since(start), all);
    return all.differences > 0 ? 1 : 0;
}

}  // namespace

int main(int argc, char** argv)
{
    CLI::App app{
        "Runs all queries in random hard scenes, once with the free-space mask and once exhaustively, and checks that "
        "the answers are the same"};
    FuzzArgs args;
    add_options(app, args);
    CLI11_PARSE(app, argc, argv);
    try {
        return run(args);
    } catch (const std::exception& error) {
        std::cerr << "spawnfield_fuzz: " << error.what() << "\n";
        return 1;
    }
}
