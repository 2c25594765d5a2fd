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
        const ProcessRun run = run_process(program, args);
        if (run.status != 0 && run.status != 3) fail(program, run);
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

/// Returns the median time of `info` on a map, s. It is short, so it runs often; the first run is untimed.
double info_seconds(const std::filesystem::path& map, int rounds)
{
    std::vector<double> seconds;
    for (int round = -1; round < std::max(rounds, 20); ++round) {
        const ProcessRun run = run_process(spawnfield_program(), {"info", map.string()});
        if (run.status != 0) fail(spawnfield_program(), run);
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

std::vector<std::string> sample_args(const std::filesystem::path& map, bool quick)
{
    return {"sample", map.string(), "-n", quick ? "20" : "2000", "--min-distance", "2.5"};
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
    const Query few = query_by_process(sample_args(map, options.quick), folder, options.rounds);
    report(100, "2,000 samples 2.5 m apart, whole process", few.seconds * 1e3, "ms", few.peak_memory);
    report(10, "2,000 samples 2.5 m apart, query alone", few.query * 1e3, "ms", few.peak_memory);
    report(64, "2,000 samples 2.5 m apart, peak memory", few.peak_memory / mega, "MB", few.peak_memory);
    const Query many = query_by_process(
        {"sample", map.string(), "-n", options.quick ? "1000" : "1000000", "--min-distance", "0"}, folder,
        options.rounds);
    report(1, "1,000,000 samples, CPU time of the process", many.cpu_seconds, "s", many.peak_memory);
    on_row(row("hills", "1,000,000 samples, whole process", many.seconds, "s", many.peak_memory));
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
    on_row(at_most(8, row("hills", "info, whole process", info_seconds(hills, options.rounds) * 1e3, "ms", 0)));
    measure_growth(options, folder, on_row);
}

}  // namespace bench
