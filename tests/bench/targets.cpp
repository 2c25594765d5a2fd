#include "targets.h"

#include "process.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <limits>

using namespace spawnfield;

namespace bench {
namespace {

constexpr double any = std::numeric_limits<double>::infinity();
constexpr double mega = 1e6;

double median(std::vector<double> values)
{
    std::sort(values.begin(), values.end());
    return (values[(values.size() - 1) / 2] + values[values.size() / 2]) / 2;
}

/// A stage of a workbench with its target.
struct Target {
    const char *scene, *stage, *work;
    int threads = 0;           ///< for which the target holds; 0: all cores
    double seconds = any;      ///< upper limit
    double ms_per_1000 = any;  ///< upper limit
    double over_fcl = 0;       ///< lower limit of the time of (b) divided by ours
};

constexpr Target in_process[] = {
    {.scene = "hills",
     .stage = "raster2d@1.0",
     .work = "2D raster, step 0.5 m, offset 1.0 m",
     .seconds = 0.5,
     .over_fcl = 20},
    {.scene = "hills",
     .stage = "raster2d@0.1",
     .work = "2D raster, step 0.5 m, offset 0.1 m",
     .seconds = 1.5,
     .over_fcl = 5},
    {.scene = "hills",
     .stage = "raster2d-1m@0.5",
     .work = "2D raster, step 1 m, offset 0.5 m",
     .threads = 1,
     .ms_per_1000 = 0.15},
    {.scene = "hills", .stage = "raster3d", .work = "3D raster, steps of 0.5 m", .seconds = 2},
    {.scene = "hills", .stage = "check", .work = "check of 1,000,000 poses near the ground", .seconds = 2},
    {.scene = "hills", .stage = "sample", .work = "2,000 samples 2.5 m apart, in process"},
    {.scene = "hills", .stage = "search", .work = "search, 2,000 valid, 2.5 m apart", .seconds = 0.5},
    {.scene = "hills", .stage = "fcl set-up", .work = "set-up of (b), plain FCL"},
    {.scene = "hills", .stage = "recast set-up", .work = "set-up of (c), Recast"},
    {.scene = "town", .stage = "raster2d-top@0.1", .work = "2D raster, step 2 m, offset 0.1 m, top layer"},
    {.scene = "floors", .stage = "raster2d@0.1", .work = "2D raster, step 0.1 m, offset 0.1 m, all layers"},
    {.scene = "floors", .stage = "raster2d-top@0.1", .work = "2D raster, step 0.1 m, offset 0.1 m, top layer"},
    {.scene = "grid-box", .stage = "raster3d", .work = "50,000 collisions, box robot", .ms_per_1000 = 0.25},
    {.scene = "grid-hull",
     .stage = "raster3d",
     .work = "50,000 collisions, hull robot, convex meshes",
     .ms_per_1000 = 0.25},
    {.scene = "empty", .stage = "raster3d", .work = "1,000,000 aerial poses", .ms_per_1000 = 0.01},
};

std::string text_of(const Target& target)
{
    std::string text;
    if (target.seconds < any) text = formatted("<= %.4g s", target.seconds);
    if (target.ms_per_1000 < any) text = formatted("<= %.4g ms per 1,000", target.ms_per_1000);
    if (target.over_fcl > 0) text += formatted(", >= %g x (b)", target.over_fcl);
    return text;
}

// ---- Stages within this process ----

bool is_reached(const Target& target, const Row& ours, const std::optional<double>& over_fcl)
{
    return ours.median <= target.seconds && ours.seconds_per_item() * 1e6 <= target.ms_per_1000 &&
           (target.over_fcl == 0 || (over_fcl && *over_fcl >= target.over_fcl));
}

TargetRow measure(const Target& target, const Workbench::Stage& stage, int threads, bool judged, int rounds)
{
    TargetRow out{target.scene, target.work, threads};
    const std::vector<Row> rows = run_in_turns(target.scene, stage, threads, rounds);
    const Row& ours = rows.front();
    out.memory = double(ours.own_memory);
    for (const Row& row : rows) {
        if (row.stage.ends_with(" exhaustive")) out.over_exhaustive = times_slower(row, ours);
        if (row.stage.ends_with(" fcl")) out.over_fcl = times_slower(row, ours);
    }
    const bool per_1000 = target.ms_per_1000 < any;
    out.measured = per_1000 ? ours.seconds_per_item() * 1e6 : ours.median;
    out.unit = per_1000 ? "ms per 1,000" : "s";
    out.exact_share = double(ours.exact_checks) / double(ours.items);
    const std::string words = text_of(target);
    if (!judged || words.empty()) return out;
    out.target = words;
    out.reached = is_reached(target, ours, out.over_fcl);
    return out;
}

using OnRow = std::function<void(TargetRow)>;

Extent extent_of(const TargetOptions& options) { return options.quick ? Extent::Quick : Extent::Full; }

void measure_stages(const TargetOptions& options, const OnRow& on_row)
{
    for (const Setting& setting : settings(extent_of(options))) {
        Workbench workbench(setting);
        for (const Workbench::Stage& stage : workbench.stages())
            for (const Target& target : in_process) {
                if (setting.name != target.scene || stage.name != target.stage) continue;
                for (const int threads : stage.parallel ? options.threads : std::vector<int>{1}) {
                    const bool judged = threads == (target.threads == 0 ? options.threads.back() : target.threads);
                    on_row(measure(target, stage, threads, judged, options.rounds));
                }
                for (const std::string& line : workbench.comparisons(setting.name + " " + stage.name))
                    options.on_comparison(line);
            }
    }
}

// ---- Whole programs ----

[[noreturn]] void fail(const std::filesystem::path& program, const ProcessRun& run)
{
    throw std::runtime_error(program.string() + " ended with status " + std::to_string(run.status) + ", needs 0");
}

/// Reads a line that this program prints with --write-maps.
BakedMap baked_map_of(const std::string& line)
{
    const std::size_t bytes = line.rfind(','), seconds = line.rfind(',', bytes - 1);
    return {line.substr(0, seconds), std::strtod(line.c_str() + seconds + 1, nullptr),
            std::strtoull(line.c_str() + bytes + 1, nullptr, 10)};
}

struct Bake {
    BakedMap map;
    double seconds = 0;      ///< median
    double peak_memory = 0;  ///< bytes, including the scene and making it
};

/// Bakes a scene in a separate process, so that its memory can be measured.
Bake bake_by_process(const std::string& scene, const TempFolder& folder, const TargetOptions& options)
{
    std::vector<std::string> args = {"--write-maps", folder.path().string(), "--scene", scene};
    args.push_back(options.quick ? "--quick" : "--full");
    Bake out;
    std::vector<double> seconds;
    for (int round = 0; round < std::min(options.rounds, 3); ++round) {
        const ProcessRun run = run_process(this_program(), args);
        if (run.status != 0) fail(this_program(), run);
        out.map = baked_map_of(run.output);
        seconds.push_back(out.map.seconds);
        out.peak_memory = std::max(out.peak_memory, double(run.peak_memory));
    }
    out.seconds = median(seconds);
    return out;
}

struct Query {
    double seconds = 0, query = 0;  ///< medians of the whole process, and of its query alone
    double peak_memory = 0;         ///< bytes
};

/// Runs a command of spawnfield on a map: once untimed, then `rounds` times.
Query query_by_process(std::vector<std::string> args, const TempFolder& folder, int rounds)
{
    const std::filesystem::path program = spawnfield_program(), summary = folder / "summary.json";
    args.insert(args.end(),
                {"--robot", "box:0.99,0.67,0.39", "-o", "/dev/null", "--quiet", "--summary", summary.string()});
    Query out;
    std::vector<double> seconds, query;
    for (int round = -1; round < rounds; ++round) {
        const ProcessRun run = run_process(program, args);
        if (run.status != 0 && run.status != 3) fail(program, run);
        if (round < 0) continue;
        seconds.push_back(run.seconds);
        query.push_back(nlohmann::json::parse(bytes_of(summary))["seconds"]["query"].get<double>());
        out.peak_memory = std::max(out.peak_memory, double(run.peak_memory));
    }
    out.seconds = median(seconds);
    out.query = median(query);
    return out;
}

TargetRow row(const std::string& scene, const std::string& work, double measured, const char* unit, double memory)
{
    TargetRow out{scene, work};
    out.measured = measured;
    out.unit = unit;
    out.memory = memory;
    return out;
}

/// Sets the upper limit of a row, in the unit of the row, and whether it is reached.
TargetRow at_most(double limit, TargetRow row)
{
    row.target = formatted("<= %.4g %s", limit, row.unit.c_str());
    row.reached = row.measured <= limit;
    return row;
}

std::vector<std::string> sample_args(const std::filesystem::path& map, bool quick)
{
    return {"sample", map.string(), "-n", quick ? "20" : "2000", "--min-distance", "2.5"};
}

void measure_bake_and_sample(const TargetOptions& options, const TempFolder& folder, const OnRow& on_row)
{
    const Bake bake = bake_by_process("hills", folder, options);
    on_row(at_most(5, row("hills", "bake at 0.1 m", bake.seconds, "s", bake.peak_memory)));
    on_row(at_most(1000, row("hills", "bake at 0.1 m, peak memory", bake.peak_memory / mega, "MB", bake.peak_memory)));
    on_row(at_most(250, row("hills", "bake at 0.1 m, on disk", double(bake.map.bytes) / mega, "MB", 0)));
    if (spawnfield_program().empty()) return;
    const Query sample = query_by_process(sample_args(bake.map.folder, options.quick), folder, options.rounds);
    on_row(at_most(
        100, row("hills", "2,000 samples 2.5 m apart, whole process", sample.seconds * 1e3, "ms", sample.peak_memory)));
    on_row(at_most(
        10, row("hills", "2,000 samples 2.5 m apart, query alone", sample.query * 1e3, "ms", sample.peak_memory)));
}

/// The cost of a tiled landscape.
struct AreaCost {
    int area;  ///< number of tiles
    Bake bake;
    Query raster, sample;
};

AreaCost measure_area(int area, const TargetOptions& options, const TempFolder& folder)
{
    AreaCost out{area, bake_by_process("hills-" + std::to_string(area) + "x", folder, options), {}, {}};
    const std::filesystem::path& map = out.bake.map.folder;
    out.raster = query_by_process({"raster", map.string(), "--dims", "2", "--step", "1", "--offset", "0.5"}, folder,
                                  options.rounds);
    out.sample = query_by_process(sample_args(map, options.quick), folder, options.rounds);
    std::filesystem::remove_all(map);
    return out;
}

/// Reports the cost per tile as a multiple of the cost of a single tile.
void report_growth(const AreaCost& one, const AreaCost& many, const OnRow& on_row)
{
    const std::string scene = "hills-" + std::to_string(many.area) + "x";
    const auto growth = [&](double of_many, double of_one) { return of_many / many.area / of_one; };
    const auto report_growth_of = [&](const char* work, double times, double memory) {
        on_row(at_most(1.15, row(scene, work, times, "times", memory)));
    };
    report_growth_of("bake at 0.5 m, time for each tile", growth(many.bake.seconds, one.bake.seconds),
                     many.bake.peak_memory);
    report_growth_of("2D raster, step 1 m, query for each tile", growth(many.raster.query, one.raster.query),
                     many.raster.peak_memory);
    report_growth_of("2,000 samples, memory of the process", many.sample.peak_memory / one.sample.peak_memory,
                     many.sample.peak_memory);
    on_row(row(scene, "2,000 samples, whole process", many.sample.seconds * 1e3, "ms", many.sample.peak_memory));
}

void measure_growth(const TargetOptions& options, const TempFolder& folder, const OnRow& on_row)
{
    const AreaCost one = measure_area(1, options, folder);
    on_row(row("hills-1x", "bake at 0.5 m", one.bake.seconds, "s", one.bake.peak_memory));
    on_row(row("hills-1x", "2D raster, step 1 m, query", one.raster.query, "s", one.raster.peak_memory));
    on_row(row("hills-1x", "2,000 samples, whole process", one.sample.seconds * 1e3, "ms", one.sample.peak_memory));
    report_growth(one, measure_area(4, options, folder), on_row);
    if (options.largest) report_growth(one, measure_area(16, options, folder), on_row);
}

std::string ratio(const std::optional<double>& value) { return value ? formatted("%.2f", *value) : "-"; }

}  // namespace

BakedMap bake_setting(const Setting& setting, const std::filesystem::path& parent, int threads)
{
    BakedMap out{parent / setting.name};
    Scene scene = setting.make();
    const Workbench workbench(setting);
    const auto start = std::chrono::steady_clock::now();
    out.bytes = workbench.bake_into(out.folder, std::move(scene), threads).bytes;
    out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return out;
}

std::string to_line(const BakedMap& map)
{
    return map.folder.string() + formatted(",%.6f,%llu\n", map.seconds, static_cast<unsigned long long>(map.bytes));
}

std::vector<TargetRow> measure_targets(const TargetOptions& options)
{
    std::vector<TargetRow> rows;
    const OnRow keep = [&](TargetRow row) {
        if (options.quick) row.target.clear(), row.reached.reset();
        rows.push_back(std::move(row));
        options.on_row(rows.back());
    };
    {
        const TempFolder folder;
        measure_bake_and_sample(options, folder, keep);
        if (!spawnfield_program().empty()) measure_growth(options, folder, keep);
    }
    measure_stages(options, keep);
    return rows;
}

std::string target_head()
{
    return formatted("%-9s %-46s %7s %-24s %10s %-12s %7s %7s %-8s %8s %8s\n", "scene", "work", "threads", "target",
                     "measured", "", "/ (a)", "/ (b)", "reached", "MB", "exact %");
}

std::string target_line(const TargetRow& row)
{
    const std::string threads = row.threads == 0 ? "" : std::to_string(row.threads);
    const std::string memory = row.memory > 0 ? formatted("%.0f", row.memory / mega) : "-";
    const std::string share = row.exact_share ? formatted("%.2f", 100 * *row.exact_share) : "-";
    return formatted("%-9s %-46s %7s %-24s %10.4g %-12s %7s %7s %-8s %8s %8s\n", row.scene.c_str(), row.work.c_str(),
                     threads.c_str(), row.target.c_str(), row.measured, row.unit.c_str(),
                     ratio(row.over_exhaustive).c_str(), ratio(row.over_fcl).c_str(),
                     !row.reached   ? ""
                     : *row.reached ? "yes"
                                    : "NO",
                     memory.c_str(), share.c_str());
}

std::string target_csv(const std::vector<TargetRow>& rows)
{
    std::string out =
        "scene,work,threads,target,measured,unit,times_exhaustive,times_fcl,reached,memory_mb,exact_share\n";
    const auto number = [](const std::optional<double>& value) {
        return value ? formatted("%.6g", *value) : std::string();
    };
    for (const TargetRow& row : rows)
        out += formatted("%s,\"%s\",%d,\"%s\",%.6g,\"%s\",%s,%s,%s,%.1f,%s\n", row.scene.c_str(), row.work.c_str(),
                         row.threads, row.target.c_str(), row.measured, row.unit.c_str(),
                         number(row.over_exhaustive).c_str(), number(row.over_fcl).c_str(),
                         !row.reached   ? ""
                         : *row.reached ? "yes"
                                        : "no",
                         row.memory / mega, number(row.exact_share).c_str());
    return out;
}

}  // namespace bench
