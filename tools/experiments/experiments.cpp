#include "experiments.h"

#include "common/machine.h"
#include "thesis.h"

#include <spawnfield/thesis.h>

#include <chrono>
#include <map>
#include <stdexcept>

using namespace spawnfield;

namespace experiments {
namespace {

double seconds_of(const std::function<void()>& work)
{
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void add_counts(const VerdictCounts& counts, Run& run)
{
    std::array<std::uint64_t, thesis_class_count> sums{};
    for (const Verdict verdict : all_verdicts) sums[std::size_t(thesis_class_of(verdict))] += counts[verdict];
    run.valid = sums[std::size_t(ThesisClass::Valid)];
    run.invalid = sums[std::size_t(ThesisClass::Invalid)];
    run.aerial = sums[std::size_t(ThesisClass::Aerial)];
}

Run run_raster(const Environment& environment, const Robot& robot, Mode mode, const RasterOptions& options, Run run)
{
    const Judge judge(environment.map, robot, {.exhaustive = mode == Mode::Fcl});
    RasterResult result;
    run.seconds = seconds_of([&] { result = raster(judge, options); });
    run.environment = environment.name;
    run.robot = robot.name;
    run.mode = mode;
    run.step = options.step;
    run.positions = std::uint64_t(result.grid.cols) * std::uint64_t(result.grid.rows) *
                    std::uint64_t(options.dims == 3 ? result.grid.heights : 1);
    run.exact_checks = result.exact_checks;
    add_counts(result.counts, run);
    return run;
}

void check_same(const std::vector<Run>& runs)
{
    for (const Run& run : runs)
        if (run.valid != runs[0].valid || run.invalid != runs[0].invalid || run.aerial != runs[0].aerial ||
            run.positions != runs[0].positions)
            throw std::runtime_error(tools::formatted(
                "test %d, %s, step %g: %s finds %llu valid of %llu, %s %llu of %llu", run.test, run.robot.c_str(),
                run.step, to_string(run.mode), (unsigned long long)run.valid, (unsigned long long)run.positions,
                to_string(runs[0].mode), (unsigned long long)runs[0].valid, (unsigned long long)runs[0].positions));
}

/// Runs a raster several times with the mask and several times with FCL at every position. Throws std::runtime_error if
/// their counts differ.
std::vector<Run> repeated(const Environment& environment, const Robot& robot, const RasterOptions& options,
                          const Run& like, int mask_times, int fcl_times)
{
    std::vector<Run> runs;
    for (int i = 0; i < mask_times + fcl_times; ++i) {
        const bool with_mask = i < mask_times;
        runs.push_back(run_raster(environment, robot, with_mask ? Mode::Mask : Mode::Fcl, options, like));
        runs.back().repetition = with_mask ? i + 1 : i - mask_times + 1;
    }
    check_same(runs);
    return runs;
}

template <class T>
void append(std::vector<T>& to, const std::vector<T>& more)
{
    to.insert(to.end(), more.begin(), more.end());
}

RasterOptions benchmark_options(const Settings& settings, int heights)
{
    return {.dims = 3, .step = 1, .bounds = {{0, 0, 0}, {9, 9, double(heights - 1)}}, .threads = settings.threads};
}

/// Returns the limits of the rasters and searches in the thesis. The thesis's counts for tests 4 and 6 show that its
/// area is a square, 1 m longer in y, at steps of 1.5 m and more.
Bounds limits(int test, double step)
{
    if (test % 2 == 1) return {{0, 0, 31}, {500, 500, 124}};
    return {{-128, -212, 0}, {1152, step > 1 ? 1068.0 : 1067.0, 80}};
}

RasterOptions raster_options(const Settings& settings, int test, double step)
{
    return {.dims = test <= 4 ? 3 : 2,
            .step = step,
            .bounds = limits(test, step),
            .offset = 1.0,
            .threads = settings.threads};
}

SearchOptions search_options(const Settings& settings, int test, bool with_distance, int seed)
{
    return {.count = settings.quick ? 50u : 2000u,
            .min_distance = with_distance ? 2.5 : 0,
            .seed = std::uint64_t(seed),
            .bounds = limits(test, 1),
            .max_failures = 100000,
            .threads = settings.threads};
}

Run run_search(const Environment& environment, const Robot& robot, const SearchOptions& options, int test)
{
    const Judge judge(environment.map, robot);
    SpawnList list;
    Run run{.test = test,
            .environment = environment.name,
            .robot = robot.name,
            .step = options.min_distance,
            .repetition = int(options.seed)};
    run.seconds = seconds_of([&] { list = search(judge, options); });
    run.exact_checks = list.exact_checks;
    add_counts(list.counts, run);
    run.positions = run.valid + run.invalid + run.aerial;
    return run;
}

const Environment& environment_of(const Districts& districts, int test)
{
    return test % 2 == 1 ? districts.low : districts.complex;
}

}  // namespace

std::vector<Run> aerial_runs(const Settings& settings)
{
    std::vector<Run> runs;
    for (const thesis::Aerial& figure : thesis::aerial()) {
        const int heights = int(figure.positions / 100);
        settings.on_step(tools::formatted("test 1: %d positions", heights * 100));
        const Environment empty = empty_environment(heights);
        for (const char* const name : {"box", "hull"})
            append(runs, repeated(empty, robot(settings, name), benchmark_options(settings, heights), {.test = 1},
                                  settings.quick ? 2 : 10, 1));
    }
    return runs;
}

std::vector<Run> collision_runs(const Settings& settings, const Environment& cubes, const Environment& balls)
{
    std::vector<Run> runs;
    for (const thesis::Collision& figure : thesis::collision()) {
        settings.on_step(std::string("test 2: ") + figure.robot + " against " + figure.obstacle);
        const Environment& environment = figure.obstacle == std::string("cubes") ? cubes : balls;
        RasterOptions options = benchmark_options(settings, int(environment.map.bounds.max.z()) + 1);
        options.height_check = false;
        const Run like{.test = 2, .obstacle = figure.obstacle};
        append(runs, repeated(environment, robot(settings, figure.robot), options, like, settings.quick ? 2 : 10,
                              settings.quick ? 1 : 3));
        if (runs.back().invalid != runs.back().positions)
            throw std::runtime_error("test 2: " + std::to_string(runs.back().positions - runs.back().invalid) +
                                     " positions do not collide; every position must");
    }
    return runs;
}

std::vector<Run> raster_runs(const Settings& settings, const Districts& districts)
{
    std::vector<Run> runs;
    for (int test = 3; test <= 6; ++test)
        for (const thesis::Raster& figure : thesis::raster(test)) {
            const double step = settings.quick ? 16 * figure.step : figure.step;
            settings.on_step(tools::formatted("test %d: step %g m", test, step));
            for (const char* const name : {"box", "hull"}) {
                append(runs, repeated(environment_of(districts, test), robot(settings, name),
                                      raster_options(settings, test, step), {.test = test}, settings.quick ? 2 : 5, 1));
                if (!settings.quick && runs.back().positions != figure.positions)
                    throw std::runtime_error(tools::formatted(
                        "test %d, step %g: the raster has %llu positions; the thesis needs %llu", test, step,
                        (unsigned long long)runs.back().positions, (unsigned long long)figure.positions));
            }
        }
    return runs;
}

std::vector<Run> search_runs(const Settings& settings, const Districts& districts)
{
    std::vector<Run> runs;
    const Robot box = robot(settings, "box");
    for (const int test : {7, 8})
        for (const bool with_distance : {true, false}) {
            settings.on_step(tools::formatted("test %d: %s distance check", test, with_distance ? "with" : "without"));
            for (int seed = 1; seed <= (settings.quick ? 2 : 20); ++seed)
                runs.push_back(run_search(environment_of(districts, test), box,
                                          search_options(settings, test, with_distance, seed), test));
        }
    return runs;
}

SpawnList first_search(const Settings& settings, const Districts& districts, int test)
{
    const Environment& environment = environment_of(districts, test);
    return search(Judge(environment.map, robot(settings, "box")), search_options(settings, test, true, 1));
}

std::vector<Milestone> milestones(const Settings& settings, const Districts& districts)
{
    std::vector<Milestone> out;
    const Robot box = robot(settings, "box");
    for (const int test : {7, 8})
        for (const bool with_distance : {true, false})
            for (int seed = 1; seed <= (settings.quick ? 1 : 5); ++seed) {
                SearchOptions options = search_options(settings, test, with_distance, seed);
                for (std::size_t part = 1, count = options.count; part <= 8; ++part) {
                    options.count = count * part / 8;
                    const Run run = run_search(environment_of(districts, test), box, options, test);
                    out.push_back({run.environment, with_distance, seed, std::size_t(run.valid), run.seconds});
                }
            }
    return out;
}

std::vector<ColumnFinds> column_finds(const Settings& settings, const Environment& low)
{
    settings.on_step("comparing 2D and 3D rasters");
    const Judge judge(low.map, robot(settings, "box"));
    std::map<std::pair<double, double>, ColumnFinds> columns;
    const auto add_finds = [&](const RasterOptions& options, bool ColumnFinds::*found) {
        for (const RasterPose& pose : raster(judge, options).poses)
            columns.try_emplace({pose.y, pose.x}, ColumnFinds{pose.x, pose.y, false, false, false}).first->second.*
                found |= pose.verdict == Verdict::Valid;
    };
    RasterOptions options = raster_options(settings, 5, settings.quick ? 20 : 2.5);
    add_finds(options, &ColumnFinds::in_2d);
    options.dims = 3;
    add_finds(options, &ColumnFinds::in_3d);
    options.snap = true;
    add_finds(options, &ColumnFinds::in_3d_snapped);
    std::vector<ColumnFinds> out;
    for (const auto& [place, finds] : columns) out.push_back(finds);
    return out;
}

}  // namespace experiments
