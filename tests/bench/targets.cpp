#include "targets.h"

#include "programs.h"

#include <limits>

using namespace spawnfield;

namespace bench {
namespace {

constexpr double any = std::numeric_limits<double>::infinity();
constexpr double mega = 1e6;

/// A stage of a workbench with its target.
struct Target {
    const char *scene, *stage, *work;
    int threads = 0;           ///< for which the target holds; 0: all cores
    double seconds = any;      ///< upper limit
    double ms_per_1000 = any;  ///< upper limit
    double over_fcl = 0;       ///< lower limit of the time of (b) divided by ours
    double over_embree = 0;    ///< lower limit of the time of (d) divided by ours
    double headings = any;     ///< upper limit of the time of all headings divided by that of one
};

constexpr Target in_process[] = {
    {.scene = "hills",
     .stage = "raster2d@1.0",
     .work = "2D raster, step 0.5 m, offset 1.0 m",
     .seconds = 0.5,
     .over_fcl = 20,
     .over_embree = 3},
    {.scene = "hills",
     .stage = "raster2d@0.1",
     .work = "2D raster, step 0.5 m, offset 0.1 m",
     .seconds = 1.5,
     .over_fcl = 15,
     .over_embree = 3},
    {.scene = "hills",
     .stage = "raster2d-1m@0.5",
     .work = "2D raster, step 1 m, offset 0.5 m",
     .threads = 1,
     .ms_per_1000 = 0.15,
     .over_embree = 3},
    {.scene = "hills",
     .stage = "raster2d-16-headings@0.5",
     .work = "16 headings of the 2D raster, step 1 m",
     .headings = 5},
    {.scene = "hills", .stage = "settled", .work = "settled 2D raster, step 0.5 m", .seconds = 6},
    {.scene = "hills", .stage = "settled-1m", .work = "settled 2D raster, step 1 m", .threads = 1, .ms_per_1000 = 20},
    {.scene = "hills",
     .stage = "settled-16-headings",
     .work = "16 headings of the settled 2D raster, step 4 m",
     .headings = 6},
    {.scene = "hills", .stage = "raster3d", .work = "3D raster, steps of 0.5 m", .seconds = 2},
    {.scene = "hills", .stage = "check", .work = "check of 1,000,000 poses near the ground", .seconds = 2},
    {.scene = "hills", .stage = "sample", .work = "2,000 samples 2.5 m apart, in process"},
    {.scene = "hills", .stage = "search", .work = "search, 2,000 valid, 2.5 m apart", .seconds = 0.5},
    {.scene = "hills", .stage = "fcl set-up", .work = "set-up of (b), plain FCL"},
    {.scene = "hills", .stage = "embree set-up", .work = "set-up of (d), Embree alone"},
    {.scene = "hills", .stage = "recast set-up", .work = "set-up of (c), Recast"},
    {.scene = "town", .stage = "raster2d-top@0.1", .work = "2D raster, step 2 m, offset 0.1 m, top layer"},
    {.scene = "town",
     .stage = "raster2d-2.5m-top@0.1",
     .work = "2D raster, step 2.5 m, offset 0.1 m, top layer",
     .threads = 1,
     .seconds = 0.04,
     .over_embree = 3},
    {.scene = "city", .stage = "raster2d@0.1", .work = "2D raster, step 0.5 m, offset 0.1 m, all layers"},
    {.scene = "city", .stage = "settled", .work = "settled 2D raster, step 0.5 m, all layers"},
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
    if (target.headings < any) text = formatted("<= %g x one heading", target.headings);
    if (target.over_fcl > 0) text += formatted(", >= %g x (b)", target.over_fcl);
    if (target.over_embree > 0) text += formatted(", >= %g x (d)", target.over_embree);
    return text;
}

// ---- Stages within this process ----

/// Sets the median in the unit of the target: time, time per item, or time as a multiple of that of one heading.
void set_measured(const Target& target, const std::vector<Row>& rows, TargetRow& out)
{
    const Row& ours = rows.front();
    out.measured = ours.median;
    out.unit = "s";
    if (target.ms_per_1000 < any) {
        out.measured = ours.seconds_per_item() * 1e6;
        out.unit = "ms per 1,000";
    }
    if (target.headings < any) {
        out.measured = ours.median / rows.at(1).median;
        out.unit = "times";
    }
}

bool is_reached(const Target& target, const TargetRow& row, const Row& ours)
{
    return (target.headings == any || row.measured <= target.headings) && ours.median <= target.seconds &&
           ours.seconds_per_item() * 1e6 <= target.ms_per_1000 && row.over_fcl.value_or(0) >= target.over_fcl &&
           row.over_embree.value_or(0) >= target.over_embree;
}

TargetRow measure(const Target& target, const Workbench::Stage& stage, int threads, bool judged, Rounds rounds)
{
    TargetRow out{target.scene, target.work, threads};
    const std::vector<Row> rows = run_in_turns(target.scene, stage, threads, rounds);
    const Row& ours = rows.front();
    out.memory = double(ours.own_memory);
    for (const Row& row : rows) {
        if (row.stage.ends_with(" exhaustive")) out.over_exhaustive = times_slower(row, ours);
        if (row.stage.ends_with(" fcl")) out.over_fcl = times_slower(row, ours);
        if (row.stage.ends_with(" embree")) out.over_embree = times_slower(row, ours);
        if (row.stage.ends_with(" embree-query")) out.over_embree_query = times_slower(row, ours);
    }
    set_measured(target, rows, out);
    out.exact_share = double(ours.exact_checks) / double(ours.items);
    const std::string words = text_of(target);
    if (!judged || words.empty()) return out;
    out.target = words;
    out.reached = is_reached(target, out, ours);
    return out;
}

Extent extent_of(const TargetOptions& options) { return options.quick ? Extent::Quick : Extent::Full; }

void measure_stages(const TargetOptions& options, const OnRow& on_row)
{
    const Rounds rounds{options.rounds, options.rounds_of_short_runs()};
    for (const Setting& setting : settings(extent_of(options))) {
        Workbench workbench(setting);
        for (const Workbench::Stage& stage : workbench.stages())
            for (const Target& target : in_process) {
                if (setting.name != target.scene || stage.name != target.stage) continue;
                for (const int threads : stage.parallel ? options.threads : std::vector<int>{1}) {
                    const bool judged = threads == (target.threads == 0 ? options.threads.back() : target.threads);
                    on_row(measure(target, stage, threads, judged, rounds));
                }
                for (const std::string& line : workbench.comparisons(setting.name + " " + stage.name))
                    options.on_comparison(line);
            }
    }
}

// ---- The table ----

std::string ratio(const std::optional<double>& value) { return value ? formatted("%.2f", *value) : "-"; }

}  // namespace

std::vector<TargetRow> measure_targets(const TargetOptions& options)
{
    std::vector<TargetRow> rows;
    const OnRow keep = [&](TargetRow row) {
        if (options.quick) row.target.clear(), row.reached.reset();
        rows.push_back(std::move(row));
        options.on_row(rows.back());
    };
    measure_programs(options, keep);
    measure_stages(options, keep);
    return rows;
}

std::string target_head()
{
    return formatted("%-9s %-52s %7s %-38s %10s %-12s %7s %7s %7s %7s %-8s %8s %8s\n", "scene", "work", "threads",
                     "target", "measured", "", "/ (a)", "/ (b)", "/ (d)", "/ query", "reached", "MB", "exact %");
}

std::string target_line(const TargetRow& row)
{
    const std::string threads = row.threads == 0 ? "" : std::to_string(row.threads);
    const std::string memory = row.memory > 0 ? formatted("%.0f", row.memory / mega) : "-";
    const std::string share = row.exact_share ? formatted("%.2f", 100 * *row.exact_share) : "-";
    return formatted("%-9s %-52s %7s %-38s %10.4g %-12s %7s %7s %7s %7s %-8s %8s %8s\n", row.scene.c_str(),
                     row.work.c_str(), threads.c_str(), row.target.c_str(), row.measured, row.unit.c_str(),
                     ratio(row.over_exhaustive).c_str(), ratio(row.over_fcl).c_str(), ratio(row.over_embree).c_str(),
                     ratio(row.over_embree_query).c_str(),
                     !row.reached   ? ""
                     : *row.reached ? "yes"
                                    : "NO",
                     memory.c_str(), share.c_str());
}

std::string target_csv(const std::vector<TargetRow>& rows)
{
    std::string out =
        "scene,work,threads,target,measured,unit,times_exhaustive,times_fcl,times_embree,times_embree_query,reached,"
        "memory_mb,exact_share\n";
    const auto number = [](const std::optional<double>& value) {
        return value ? formatted("%.6g", *value) : std::string();
    };
    for (const TargetRow& row : rows)
        out += formatted("%s,\"%s\",%d,\"%s\",%.6g,\"%s\",%s,%s,%s,%s,%s,%.1f,%s\n", row.scene.c_str(),
                         row.work.c_str(), row.threads, row.target.c_str(), row.measured, row.unit.c_str(),
                         number(row.over_exhaustive).c_str(), number(row.over_fcl).c_str(),
                         number(row.over_embree).c_str(), number(row.over_embree_query).c_str(),
                         !row.reached   ? ""
                         : *row.reached ? "yes"
                                        : "no",
                         row.memory / mega, number(row.exact_share).c_str());
    return out;
}

}  // namespace bench
