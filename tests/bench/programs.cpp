#include "programs.h"

#include "process.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <limits>

using namespace spawnfield;

namespace bench {
namespace {

constexpr double no_limit = std::numeric_limits<double>::infinity();
constexpr double mega = 1e6;

/// Runs a program. Throws std::runtime_error if it fails; status 3 (fewer spawns than wanted) is no failure.
ProcessRun checked_run(const std::filesystem::path& program, const std::vector<std::string>& args)
{
    ProcessRun run = run_process(program, args);
    if (run.status != 0 && run.status != 3)
        throw std::runtime_error(program.string() + " ended with status " + std::to_string(run.status) + ", needs 0");
    return run;
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

/// Returns the file of triangles that is written beside a map.
std::filesystem::path triangles_of(std::filesystem::path map) { return map += ".triangles"; }

/// Bakes a scene in a separate process, so that its memory can be measured.
Bake bake_by_process(const std::string& scene, const TempFolder& folder, const TargetOptions& options,
                     int most_rounds = 3)
{
    std::vector<std::string> args = {"--write-maps", folder.path().string(), "--scene", scene};
    args.push_back(options.quick ? "--quick" : "--full");
    Bake out;
    std::vector<double> seconds;
    for (int round = 0; round < std::min(options.rounds, most_rounds); ++round) {
        const ProcessRun run = checked_run(this_program(), args);
        out.map = baked_map_of(run.output);
        seconds.push_back(out.map.seconds);
        out.peak_memory = std::max(out.peak_memory, double(run.peak_memory));
    }
    out.seconds = median(seconds);
    return out;
}

struct Query {
    double seconds = 0, query = 0;  ///< medians of the whole process, and of its query alone
    double cpu_seconds = 0;         ///< median of the whole process
    double peak_memory = 0;         ///< bytes
};

/// Runs a command of spawnfield on a map: once untimed, then `rounds` times.
Query query_by_process(std::vector<std::string> args, const TempFolder& folder, int rounds)
{
    const std::filesystem::path program = spawnfield_program(), summary = folder / "summary.json";
    args.insert(args.end(),
                {"--robot", "box:0.99,0.67,0.39", "-o", "/dev/null", "--quiet", "--summary", summary.string()});
    Query out;
    std::vector<double> seconds, cpu_seconds, query;
    for (int round = -1; round < rounds; ++round) {
        const ProcessRun run = checked_run(program, args);
        if (round < 0) continue;
        seconds.push_back(run.seconds);
        cpu_seconds.push_back(run.cpu_seconds);
        query.push_back(nlohmann::json::parse(bytes_of(summary))["seconds"]["query"].get<double>());
        out.peak_memory = std::max(out.peak_memory, double(run.peak_memory));
    }
    out.seconds = median(seconds);
    out.cpu_seconds = median(cpu_seconds);
    out.query = median(query);
    return out;
}

/// Returns the median time of `info` on a map, s; the first run is untimed.
double info_seconds(const std::filesystem::path& map, int rounds)
{
    std::vector<double> seconds;
    for (int round = -1; round < rounds; ++round) {
        const ProcessRun run = checked_run(spawnfield_program(), {"info", map.string()});
        if (round >= 0) seconds.push_back(run.seconds);
    }
    return median(seconds);
}

TargetRow row(const std::string& scene, const std::string& work, double measured, const char* unit, double memory)
{
    TargetRow out{scene, work};
    out.measured = measured;
    out.unit = unit;
    out.memory = memory;
    return out;
}

/// Sets the upper limit of a row, in the unit of the row, and whether it is reached. An infinite limit is none.
TargetRow at_most(double limit, TargetRow row)
{
    if (!std::isfinite(limit)) return row;
    row.target = formatted("<= %.4g %s", limit, row.unit.c_str());
    row.reached = row.measured <= limit;
    return row;
}

std::vector<std::string> sample_args(const std::filesystem::path& map, bool quick, const std::string& stance = "level")
{
    return {"sample", map.string(), "-n", quick ? "20" : "2000", "--min-distance", "2.5", "--stance", stance};
}

/// Upper limits of a bake; infinite: none.
struct BakeGoals {
    double seconds, memory, disk;  ///< memory and disk in MB
};

std::filesystem::path measure_bake(const std::string& scene, const BakeGoals& goals, const TargetOptions& options,
                                   const TempFolder& folder, const OnRow& on_row)
{
    const Bake bake = bake_by_process(scene, folder, options);
    const auto report = [&](double limit, const char* work, double measured, const char* unit, double memory) {
        on_row(at_most(limit, row(scene, work, measured, unit, memory)));
    };
    report(goals.seconds, "bake at 0.1 m", bake.seconds, "s", bake.peak_memory);
    report(goals.memory, "bake at 0.1 m, peak memory", bake.peak_memory / mega, "MB", bake.peak_memory);
    report(goals.disk, "bake at 0.1 m, on disk", double(bake.map.bytes) / mega, "MB", 0);
    return bake.map.folder;
}

/// Measures samples on the map of hills: few that are far apart, and many.
void measure_samples(const std::filesystem::path& map, const TargetOptions& options, const TempFolder& folder,
                     const OnRow& on_row)
{
    const auto report = [&](double limit, const char* work, double measured, const char* unit, double memory) {
        on_row(at_most(limit, row("hills", work, measured, unit, memory)));
    };
    const int many_rounds = options.rounds_of_short_runs();
    const Query few = query_by_process(sample_args(map, options.quick), folder, many_rounds);
    report(100, "2,000 samples 2.5 m apart, whole process", few.seconds * 1e3, "ms", few.peak_memory);
    report(10, "2,000 samples 2.5 m apart, query alone", few.query * 1e3, "ms", few.peak_memory);
    report(64, "2,000 samples 2.5 m apart, peak memory", few.peak_memory / mega, "MB", few.peak_memory);
    const Query settled = query_by_process(sample_args(map, options.quick, "settled"), folder, many_rounds);
    report(200, "2,000 settled samples 2.5 m apart, whole process", settled.seconds * 1e3, "ms", settled.peak_memory);
    const auto many_at = [&](const char* offset) {
        return query_by_process({"sample", map.string(), "-n", options.quick ? "1000" : "1000000", "--min-distance",
                                 "0", "--stance", "level", "--offset", offset},
                                folder, options.rounds);
    };
    const Query high = many_at("1.0"), many = many_at("auto");
    report(1, "1,000,000 samples, offset 1.0 m, CPU time", high.cpu_seconds, "s", high.peak_memory);
    on_row(row("hills", "1,000,000 samples, offset auto, CPU time", many.cpu_seconds, "s", many.peak_memory));
    on_row(row("hills", "1,000,000 samples, offset auto, whole process", many.seconds, "s", many.peak_memory));
}

/// A raster of top layers by whole programs: spawnfield on a baked map, and EmbreeOnly on the triangles.
struct Race {
    const char *scene, *work;
    double step, offset;  ///< m
};

/// Returns a text with the counts by verdict of both: "hills whole process: spawnfield outside,0 … valid,80; Embree
/// alone outside,0 … valid,80".
std::string race_counts(const Race& race, const std::filesystem::path& summary, std::string theirs)
{
    const nlohmann::ordered_json ours = nlohmann::ordered_json::parse(bytes_of(summary));
    std::string text = std::string(race.scene) + " whole process: spawnfield";
    for (const auto& [verdict, count] : ours["counts"].items())
        text += " " + verdict + "," + std::to_string(count.get<std::uint64_t>());
    std::replace(theirs.begin(), theirs.end(), '\n', ' ');
    return text + "; Embree alone " + theirs;
}

/// Measures the two programs of a race in turns.
void measure_race(const Race& race, const std::filesystem::path& map, const TargetOptions& options,
                  const TempFolder& folder, const OnRow& on_row)
{
    const std::filesystem::path summary = folder / "race.json";
    const std::string step = formatted("%g", options.quick ? 4 : race.step), offset = formatted("%g", race.offset);
    const std::vector<std::string> ours = {"raster",    map.string(),    "--robot", "box:0.99,0.67,0.39", "--dims",
                                           "2",         "--step",        step,      "--offset",           offset,
                                           "--layers",  "top",           "-o",      "/dev/null",          "--quiet",
                                           "--summary", summary.string()};
    const std::vector<std::string> theirs = {
        "--embree-process", triangles_of(map).string(), "--step", step, "--offset", offset};
    std::vector<double> our_seconds, their_seconds;
    double memory = 0;
    std::string their_counts;
    for (int round = -1; round < options.rounds; ++round) {
        const ProcessRun run = checked_run(spawnfield_program(), ours);
        if (round >= 0) our_seconds.push_back(run.seconds);
        memory = std::max(memory, double(run.peak_memory));
        if (!EmbreeOnly::is_available()) continue;
        const ProcessRun other = checked_run(this_program(), theirs);
        if (round >= 0) their_seconds.push_back(other.seconds);
        their_counts = other.output;
    }
    TargetRow out = row(race.scene, race.work, median(our_seconds), "s", memory);
    if (!their_seconds.empty()) {
        out.over_embree = median(their_seconds) / out.measured;
        out.target = ">= 2 x (d)";
        out.reached = *out.over_embree >= 2;
    }
    on_row(out);
    if (!their_counts.empty()) options.on_comparison(race_counts(race, summary, their_counts));
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
    const auto report = [&](double limit, const char* work, double times, double memory) {
        on_row(at_most(limit, row(scene, work, times, "times", memory)));
    };
    report(1.15, "bake at 0.5 m, time for each tile", growth(many.bake.seconds, one.bake.seconds),
           many.bake.peak_memory);
    report(1.15, "2D raster, step 1 m, query for each tile", growth(many.raster.query, one.raster.query),
           many.raster.peak_memory);
    report(2, "2,000 samples, memory of the process", many.sample.peak_memory / one.sample.peak_memory,
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

}  // namespace

BakedMap bake_setting(const Setting& setting, const std::filesystem::path& parent, int threads)
{
    BakedMap out{parent / setting.name};
    Scene scene = setting.make();
    std::filesystem::create_directories(parent);
    if (has_top_raster(setting))
        write_triangles(triangles_of(out.folder),
                        triangle_scene_of(scene, setting.bounds.is_empty() ? scene.bounds() : setting.bounds));
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

void measure_programs(const TargetOptions& options, const OnRow& on_row)
{
    const TempFolder folder;
    const std::filesystem::path city = measure_bake("city", {6, no_limit, 150}, options, folder, on_row);
    std::filesystem::remove_all(city);
    const std::filesystem::path hills = measure_bake("hills", {4, 1000, 200}, options, folder, on_row);
    if (spawnfield_program().empty()) return;
    measure_samples(hills, options, folder, on_row);
    on_row(at_most(
        8, row("hills", "info, whole process", info_seconds(hills, options.rounds_of_short_runs()) * 1e3, "ms", 0)));
    measure_race({"hills", "2D raster, step 1 m, offset 0.5 m, whole process", 1, 0.5}, hills, options, folder, on_row);
    std::filesystem::remove_all(hills);
    const std::filesystem::path town = bake_by_process("town", folder, options, 1).map.folder;
    measure_race({"town", "2D raster, 2.5 m, offset 0.1 m, top, whole process", 2.5, 0.1}, town, options, folder,
                 on_row);
    std::filesystem::remove_all(town);
    measure_growth(options, folder, on_row);
}

}  // namespace bench
