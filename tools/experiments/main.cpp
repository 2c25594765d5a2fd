#include "report.h"

#include <spawnfield/output_file.h>

#include <CLI/CLI.hpp>

#include <chrono>
#include <iostream>

using namespace spawnfield;
using namespace experiments;

namespace {

void run(const Settings& settings, const std::string& command)
{
    const auto start = std::chrono::steady_clock::now();
    const std::filesystem::path pictures = settings.folder / "experiments";
    std::filesystem::create_directories(pictures);
    const bool quick = settings.quick;
    const Environment cubes = environment(
        settings, "benchmark-cubes", [&](std::uint64_t) { return worlds::benchmark_cubes(quick ? 20 : 500); }, 0.1);
    const Environment balls = environment(
        settings, "benchmark-balls", [&](std::uint64_t) { return worlds::benchmark_balls(quick ? 20 : 500); }, 0.1);
    const Districts districts = {
        environment(settings, "low-complexity", worlds::low_complexity, quick ? 1 : 0.1),
        environment(
            settings, "complex", [](std::uint64_t seed) { return worlds::complex_district(seed); }, quick ? 2 : 0.25)};
    const Environment deck = environment(
        settings, "complex-deck",
        [](std::uint64_t seed) { return worlds::complex_district(seed, worlds::Bridge::DeckAlone); }, quick ? 2 : 0.25);

    Results results;
    for (const std::vector<Run>& runs : {aerial_runs(settings), collision_runs(settings, cubes, balls),
                                         raster_runs(settings, districts), search_runs(settings, districts)})
        results.runs.insert(results.runs.end(), runs.begin(), runs.end());
    results.milestones = milestones(settings, districts);
    results.column_finds = column_finds(settings, districts.low);
    results.cases = draw_cases(settings, districts, deck, pictures);
    results.spawns = draw_spawns(settings, districts, pictures);
    results.total_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();

    write_file_atomically(settings.folder / "runs.csv", runs_csv(results.runs));
    write_file_atomically(settings.folder / "thesis.csv", thesis_csv());
    write_file_atomically(settings.folder / "milestones.csv", milestones_csv(results.milestones));
    write_file_atomically(settings.folder / "column_finds.csv", column_finds_csv(results.column_finds));
    write_file_atomically(
        settings.folder / "experiments.md",
        report(settings, {&cubes, &balls, &districts.low, &districts.complex, &deck}, results, command, "experiments"));
}

}  // namespace

int main(int argc, char** argv)
{
    CLI::App app{
        "Runs the eight experiments of the thesis that spawnfield grew from, and writes tables, pictures and a report"};
    Settings settings;
    std::string command = "spawnfield_experiments";
    app.add_option("-o,--output", settings.folder, "Folder of all results; it is created if it does not exist")
        ->required();
    app.add_flag("--quick", settings.quick,
                 "Coarse steps and maps: checks counts and invariants; the times have no meaning");
    app.add_option("--threads", settings.threads, "Number of threads; 0: all cores (default 0)")
        ->check(CLI::Range(0, 1024));
    app.add_option("--command", command, "Command that the report names as its origin")->capture_default_str();
    app.footer(
        "Example:\n  spawnfield_experiments --quick -o /tmp/experiments\ntools/experiments.sh runs it and draws the "
        "plots.");
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : 2;  // 2 means wrong usage, as in spawnfield
    }
    settings.on_step = [](const std::string& what) { std::cerr << what << std::endl; };
    try {
        run(settings, command);
    } catch (const std::exception& error) {
        std::cerr << "spawnfield_experiments: " << error.what() << "\n";
        return 1;
    }
    std::cout << (settings.folder / "experiments.md").string() << "\n";
}
