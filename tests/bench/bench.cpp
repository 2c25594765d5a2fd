#include "targets.h"

#include "query/raster_grid.h"

#include <spawnfield/output_file.h>

#include <CLI/CLI.hpp>

#include <iostream>
#include <thread>

namespace {

using namespace bench;
using namespace spawnfield;

struct BenchArgs {
    int rounds = 5;
    std::vector<int> threads;
    std::string csv, maps, scene, only, triangles;
    double step = 1, offset = 0.5;
    bool quick = false, full = false, targets = false;
};

void add_options(CLI::App& app, BenchArgs& args)
{
    app.add_option("--rounds", args.rounds, "Number of timed rounds after one untimed round (default 5)")
        ->check(CLI::Range(1, 1000));
    app.add_option("--threads", args.threads, "Numbers of threads (default: 1 and all cores)")
        ->delimiter(',')
        ->check(CLI::Range(1, 1024));
    app.add_option("--only", args.only,
                   "Only the stages whose \"scene stage\" contains this text, for example \"hills raster2d\"");
    app.add_option("--csv", args.csv,
                   "Write a table with the columns scene,stage,threads,items,ms,per_second,hash,median_ms,exact_checks "
                   "to this file; ms is the minimum");
    app.add_option(
           "--write-maps", args.maps,
           "Only bake the scenes into this folder; prints map,seconds,bytes. Also writes NAME.triangles, a file for "
           "--embree-process, for each scene of which alternative (d) makes a raster")
        ->excludes(app.add_flag(
            "--targets", args.targets,
            "Measure the table of targets for speed and memory: first whole programs, then stages and alternatives"));
    app.add_option("--scene", args.scene, "With --write-maps: bake only this scene, for example hills or hills-4x");
    app.add_option("--embree-process", args.triangles,
                   "Only make a 2D raster of top layers of this .triangles file with alternative (d), Embree alone; "
                   "prints verdict,count")
        ->excludes("--targets")
        ->excludes("--write-maps");
    app.add_option("--step", args.step, "With --embree-process: m between columns (default 1)")
        ->check(CLI::PositiveNumber);
    app.add_option("--offset", args.offset, "With --embree-process: m above the terrain (default 0.5)");
    auto* quick = app.add_flag(
        "--quick", args.quick,
        "Small scenes, one round, 1 and 2 threads: only shows that all stages work and compute the same");
    app.add_flag("--full", args.full,
                 "hills with cells of 0.1 m and rasters of 0.5 m; with --targets also with 16 times its area")
        ->excludes(quick);
    app.footer(
        "Example:\n"
        "  spawnfield_bench --targets --csv targets.csv\n"
        "  spawnfield_bench --only \"hills sample\" --threads 1,2\n"
        "  spawnfield_bench --write-maps /tmp/maps && spawnfield heatmap /tmp/maps/hills -o /tmp/hills.png \\\n"
        "      --robot maps/robots/husky.yaml --offset 0.3");
}

Extent extent_of(const BenchArgs& args)
{
    if (args.quick) return Extent::Quick;
    return args.full ? Extent::Full : Extent::Usual;
}

std::vector<int> thread_counts(const BenchArgs& args)
{
    if (!args.threads.empty()) return args.threads;
    const int cores = int(std::thread::hardware_concurrency());
    if (args.quick || cores == 2) return {1, 2};
    return cores > 1 ? std::vector<int>{1, cores} : std::vector<int>{1};
}

std::string ratios(const std::vector<Row>& rows)
{
    std::string text;
    for (std::size_t i = 1; i < rows.size(); ++i)
        text += formatted("          %s takes %.2f times as long per item\n", rows[i].stage.c_str(),
                          times_slower(rows[i], rows[0]));
    return text;
}

std::vector<Row> run_all(const BenchArgs& args)
{
    std::vector<Row> rows;
    for (const Setting& setting : settings(extent_of(args))) {
        Workbench workbench(setting);
        for (const Workbench::Stage& stage : workbench.stages()) {
            if ((setting.name + " " + stage.name).find(args.only) == std::string::npos) continue;
            for (const int threads : stage.parallel ? thread_counts(args) : std::vector<int>{1}) {
                const int rounds = args.quick ? 1 : args.rounds;
                const std::vector<Row> more = run_in_turns(setting.name, stage, threads, {rounds, rounds});
                for (const Row& row : more) std::cout << table_line(row);
                std::cout << ratios(more) << std::flush;
                rows.insert(rows.end(), more.begin(), more.end());
            }
        }
        for (const std::string& line : workbench.comparisons(args.only)) std::cout << line << "\n" << std::flush;
    }
    return rows;
}

std::string missing_alternatives()
{
    std::string text;
    if (!PlainFcl::is_available())
        text += "built without Embree: the alternatives (b), plain FCL, and (d), Embree alone, are left out\n";
    if (!NavMesh::is_available()) text += "built without Recast: alternative (c), a navigation mesh, is left out\n";
    return text;
}

/// Bakes the scene that --scene names, or all scenes except the tiled ones.
void write_maps(const BenchArgs& args)
{
    std::vector<Setting> wanted = settings(extent_of(args));
    if (!args.scene.empty()) {
        const std::vector<Setting> tiled = tiled_settings(extent_of(args));
        wanted.insert(wanted.end(), tiled.begin(), tiled.end());
        std::erase_if(wanted, [&](const Setting& setting) { return setting.name != args.scene; });
        if (wanted.empty()) throw std::runtime_error("--scene: unknown scene \"" + args.scene + "\"");
    }
    for (const Setting& setting : wanted) std::cout << to_line(bake_setting(setting, args.maps, 0)) << std::flush;
}

/// Does with Embree alone what `spawnfield raster` does as a whole program, except writing the poses.
void run_embree(const BenchArgs& args)
{
    if (!EmbreeOnly::is_available())
        throw std::runtime_error("--embree-process needs Embree, but this program was built without it");
    TriangleScene triangles = read_triangles(args.triangles);
    const RasterGrid grid = raster_grid(triangles.bounds, {.step = args.step});
    const EmbreeOnly embree(std::move(triangles), husky_box(), EmbreeOnly::Use::Once);
    VerdictCounts counts;
    for (const auto& pose : embree.raster_top(grid, args.offset, 0, EmbreeOnly::Search::PointQuery))
        if (pose) ++counts[pose->verdict];
    for (const Verdict verdict : all_verdicts) std::cout << to_string(verdict) << "," << counts[verdict] << "\n";
}

void reach_targets(const BenchArgs& args)
{
    std::cout << machine() << "\n" << missing_alternatives() << "\n" << target_head() << std::flush;
    TargetOptions options;
    options.quick = args.quick;
    options.largest = args.full;
    options.rounds = args.quick ? 1 : args.rounds;
    options.threads = thread_counts(args);
    options.on_row = [](const TargetRow& row) { std::cout << target_line(row) << std::flush; };
    options.on_comparison = [](const std::string& line) { std::cout << "          " << line << "\n" << std::flush; };
    const std::vector<TargetRow> rows = measure_targets(options);
    if (!args.csv.empty()) write_file_atomically(args.csv, target_csv(rows));
}

void measure(const BenchArgs& args)
{
    std::cout << machine() << "\n" << missing_alternatives() << "\n" << table_head() << std::flush;
    const std::vector<Row> rows = run_all(args);
    check_same(rows);
    if (rows.empty()) throw std::runtime_error("--only: no \"scene stage\" contains \"" + args.only + "\"");
    if (!args.csv.empty()) write_file_atomically(args.csv, csv(rows));
}

}  // namespace

int main(int argc, char** argv)
{
    CLI::App app{
        "Times every stage of spawnfield on its benchmark scenes, and checks that it computes the same with any number "
        "of threads."};
    BenchArgs args;
    add_options(app, args);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : 2;
    }
    try {
        if (args.targets)
            reach_targets(args);
        else if (!args.triangles.empty())
            run_embree(args);
        else if (args.maps.empty())
            measure(args);
        else
            write_maps(args);
    } catch (const std::exception& error) {
        std::cerr << "spawnfield_bench: " << error.what() << "\n";
        return 1;
    }
    return 0;
}
