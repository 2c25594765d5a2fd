#include "report.h"

#include "common/machine.h"
#include "common/statistics.h"
#include "thesis.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <set>

using namespace spawnfield;
using tools::formatted;
using tools::sample_variance;

namespace experiments {
namespace {

using Count = unsigned long long;

// ---- Numbers ----

std::string seconds_text(double seconds)
{
    if (seconds < 1e-3) return formatted("%.3g µs", seconds * 1e6);
    return seconds < 1 ? formatted("%.3g ms", seconds * 1e3) : formatted("%.3g s", seconds);
}

/// Formats seconds as the thesis prints them.
std::string thesis_text(double seconds)
{
    return seconds < 1 ? formatted("%.1f ms", seconds * 1e3) : formatted("%.1f s", seconds);
}

std::string times_text(double times)
{
    return times >= 1000 ? formatted("%.0f ×", std::round(times / 100) * 100) : formatted("%.3g ×", times);
}

std::string grouped(std::uint64_t value)
{
    std::string text = std::to_string(value);
    for (std::ptrdiff_t i = std::ptrdiff_t(text.size()) - 3; i > 0; i -= 3) text.insert(std::size_t(i), ",");
    return text;
}

std::string percent(std::uint64_t part, std::uint64_t whole)
{
    return formatted("%.1f %%", whole == 0 ? 0.0 : 100 * double(part) / double(whole));
}

// ---- Runs ----

/// Runs of the same experiment, which differ only in their repetition.
struct Group {
    Run first;
    std::vector<double> seconds;  ///< of every run
};

/// Returns the groups of those runs for which counts(run) is true.
std::vector<Group> groups_of(const std::vector<Run>& runs, const std::function<bool(const Run&)>& counts)
{
    std::vector<Group> groups;
    for (const Run& run : runs) {
        if (!counts(run)) continue;
        const auto same = [&](const Group& group) {
            const Run& other = group.first;
            return other.test == run.test && other.environment == run.environment && other.robot == run.robot &&
                   other.obstacle == run.obstacle && other.step == run.step && other.mode == run.mode &&
                   (run.test >= 7 || other.positions == run.positions);
        };
        auto found = std::find_if(groups.begin(), groups.end(), same);
        if (found == groups.end()) found = groups.insert(groups.end(), Group{run, {}});
        found->seconds.push_back(run.seconds);
    }
    return groups;
}

/// Returns the group of the same raster with FCL at every position.
const Group& other_mode(const std::vector<Group>& groups, const Group& mask)
{
    return *std::find_if(groups.begin(), groups.end(), [&](const Group& group) {
        return group.first.mode == Mode::Fcl && group.first.robot == mask.first.robot &&
               group.first.step == mask.first.step && group.first.obstacle == mask.first.obstacle &&
               group.first.positions == mask.first.positions;
    });
}

/// For each test: how many times as fast as the thesis spawnfield is, for each figure of the thesis.
using Ratios = std::map<int, std::vector<double>>;

// ---- Sections ----

/// Returns the versions of the libraries that baked a map, from its map.yaml: {assimp: "5.2.4", …}.
std::string libraries(const Map& map)
{
    const std::string key = "libraries: ";
    std::ifstream file(map.folder / "map.yaml");
    for (std::string line; std::getline(file, line);)
        if (line.starts_with(key)) return line.substr(key.size());
    return "not known";
}

std::string environments_section(const std::vector<const Environment*>& environments)
{
    std::string text =
        "## Environments\n\n| environment | extent, m | triangles | boxes, capsules, cylinders | seed | made | baked "
        "at | baked in | map read in | map's hash |\n"
        "|---|---|---|---|---|---|---|---|---|---|\n";
    for (const Environment* const environment : environments) {
        const Map& map = environment->map;
        std::uint64_t triangles = 0, primitives = 0;
        for (const LabelCount& label : map.geometry.labels()) {
            triangles += label.triangles;
            primitives += label.primitives;
        }
        const Vec3 size = map.bounds.max - map.bounds.min;
        text += formatted("| %s | %.4g × %.4g × %.4g | %s | %s | %llu | %s | %g m | %s | %s | %s |\n",
                          environment->name.c_str(), size.x(), size.y(), size.z(), grouped(triangles).c_str(),
                          grouped(primitives).c_str(), Count(environment->seed),
                          seconds_text(environment->make_seconds).c_str(), map.resolution,
                          seconds_text(environment->bake_seconds).c_str(),
                          seconds_text(environment->read_seconds).c_str(), map.hash.c_str());
    }
    return text +
           "\nThe original environments are not public. These have the same extents, content and statistics "
           "([maps](../maps/README.md)\n"
           "shows them). Making and baking is done once for a world. The times below are those of the queries with the "
           "preparation\n"
           "of the mask, without reading map and robot.\n\n";
}

std::string aerial_section(const std::vector<Run>& runs, Ratios& ratios)
{
    std::string text =
        "## Test 1: aerial positions\n\nThe empty environment: 10 × 10 columns, step 1 m. Positions without ground are "
        "counted by arithmetic.\n\n"
        "| positions | robot | thesis | spawnfield, mean | variance, s² | ratio |\n|---|---|---|---|---|---|\n";
    for (const Group& group : groups_of(runs, [](const Run& run) { return run.test == 1 && run.mode == Mode::Mask; }))
        for (const thesis::Aerial& figure : thesis::aerial()) {
            if (figure.positions != group.first.positions) continue;
            const double mean = tools::mean(group.seconds);
            ratios[1].push_back(figure.seconds / mean);
            text += formatted("| %s | %s | %s | %s | %.2g | %s |\n", grouped(figure.positions).c_str(),
                              group.first.robot.c_str(), thesis_text(figure.seconds).c_str(),
                              seconds_text(mean).c_str(), sample_variance(group.seconds),
                              times_text(figure.seconds / mean).c_str());
        }
    return text + "\n";
}

std::string collision_section(const std::vector<Run>& runs, Ratios& ratios)
{
    std::string text =
        "## Test 2: collisions\n\n10 × 10 × 500 obstacles, 1 m apart, with a position in each, so every position "
        "collides (`--no-height-check`).\n"
        "Times are for 1,000 positions.\n\n"
        "| robot / obstacle | thesis | spawnfield, mean | variance, ms² | ratio | FCL at every position, mean | "
        "variance, ms² | ratio |\n"
        "|---|---|---|---|---|---|---|---|\n";
    const std::vector<Group> groups = groups_of(runs, [](const Run& run) { return run.test == 2; });
    for (const Group& group : groups)
        for (const thesis::Collision& figure : thesis::collision()) {
            if (group.first.mode != Mode::Mask || figure.robot != group.first.robot ||
                figure.obstacle != group.first.obstacle)
                continue;
            const Group& fcl = other_mode(groups, group);
            const double scale = 1e6 / double(group.first.positions), mean = scale * tools::mean(group.seconds),
                         fcl_mean = scale * tools::mean(fcl.seconds);
            ratios[2].push_back(figure.ms_per_1000 / mean);
            text += formatted("| %s / %s | %.1f ms | %.3g ms | %.2g | %s | %.3g ms | %.2g | %s |\n", figure.robot,
                              figure.obstacle, figure.ms_per_1000, mean, scale * scale * sample_variance(group.seconds),
                              times_text(figure.ms_per_1000 / mean).c_str(), fcl_mean,
                              scale * scale * sample_variance(fcl.seconds),
                              times_text(figure.ms_per_1000 / fcl_mean).c_str());
        }
    return text + "\n";
}

/// Returns the table row of a group. The thesis's columns stay empty if the thesis has no figure for the step. This is
/// so in quick runs, because their steps are coarser.
std::string raster_line(const Group& group, const std::vector<Group>& groups,
                        const std::vector<thesis::Raster>& figures, std::vector<double>& ratios)
{
    const Run& run = group.first;
    const double mean = tools::mean(group.seconds);
    std::string theirs = "| | | | ", ratio;
    for (const thesis::Raster& figure : figures)
        if (figure.step == run.step) {
            theirs = formatted("| %s | %s | %s | %s ", grouped(figure.checks).c_str(), grouped(figure.valid).c_str(),
                               grouped(figure.invalid).c_str(), thesis_text(figure.seconds).c_str());
            ratios.push_back(figure.seconds / mean);
            ratio = "**" + times_text(figure.seconds / mean) + "**";
        }
    return formatted("| %g m | %s ", run.step, run.robot.c_str()) + theirs +
           formatted("| %s | %s | %s | %s | %.1g | %s | %s | %s |\n", grouped(run.positions).c_str(),
                     grouped(run.valid).c_str(), grouped(run.invalid).c_str(), seconds_text(mean).c_str(),
                     sample_variance(group.seconds), percent(run.exact_checks, run.valid + run.invalid).c_str(),
                     ratio.c_str(), seconds_text(tools::mean(other_mode(groups, group).seconds)).c_str());
}

std::string raster_section(int test, const std::vector<Run>& runs, Ratios& ratios)
{
    const bool low = test % 2 == 1, in_3d = test <= 4;
    std::string text = formatted("## Test %d: %s raster, %s\n\n", test, in_3d ? "3D" : "2D",
                                 low ? "low-complexity" : "complex");
    text += in_3d ? "Positions up to 1.0 m above the ground are judged; higher ones are aerial.\n"
                  : "The robot's origin is 1.0 m above the ground.\n";
    if (!low)
        text +=
            "With steps of 1.5 m and more y ends at 1068 m, because the thesis's counts for these steps are those of a "
            "square.\n";
    text +=
        "\n| step | robot | thesis: checks | valid | invalid | time | spawnfield: checks | valid | invalid | time, "
        "mean | variance, s² | decided by FCL | ratio | FCL "
        "at every position |\n|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n";
    const std::vector<Group> groups = groups_of(runs, [&](const Run& run) { return run.test == test; });
    for (const Group& group : groups)
        if (group.first.mode == Mode::Mask) text += raster_line(group, groups, thesis::raster(test), ratios[test]);
    text += "\nThe number of checks follows from limits and steps, limits included";
    if (test == 3) text += "; the thesis rounds its first two";
    if (test == 4) text += "; the thesis rounds its first three";
    text +=
        ".\nThe numbers of valid and invalid positions differ because the environments differ, although their "
        "statistics are the\nsame.";
    return text + (in_3d ? " In 3D they also depend on how the ground's heights lie between the steps: with steps of "
                           "1.5 m and more,\neither all of a level plain is in reach of a step, or nothing of it.\n\n"
                         : "\n\n");
}

std::string search_section(int test, const std::vector<Run>& runs, Ratios& ratios)
{
    const thesis::Random figure = thesis::random_search(test);
    std::string text = formatted(
        "## Test %d: random search, %s\n\n2,000 spawns, 2.5 m away from all checked positions, at most 100,000 "
        "failures in a row. The thesis took %g s\n(variance %g s²).\n\n| distance check | runs | found | draws judged "
        "| mean | variance, s² | ratio |\n|---|---|---|---|---|---|---|\n",
        test, test == 7 ? "low-complexity" : "complex", figure.mean, figure.variance);
    for (const Group& group : groups_of(runs, [&](const Run& run) { return run.test == test; }))
        for (const std::size_t count : std::set{std::min<std::size_t>(5, group.seconds.size()), group.seconds.size()}) {
            const std::vector<double> seconds(group.seconds.begin(), group.seconds.begin() + std::ptrdiff_t(count));
            const bool with_distance = group.first.step > 0;
            const double mean = tools::mean(seconds);
            if (with_distance) ratios[test].push_back(figure.mean / mean);
            text += formatted("| %s | %zu | %s | %s | %s | %.2g | %s |\n", with_distance ? "2.5 m" : "none",
                              seconds.size(), grouped(group.first.valid).c_str(),
                              grouped(group.first.positions).c_str(), seconds_text(mean).c_str(),
                              sample_variance(seconds), with_distance ? times_text(figure.mean / mean).c_str() : "");
        }
    return text + "\nThe columns \"found\" and \"draws judged\" are those of the first run.\n\n";
}

std::string ratios_section(const Ratios& ratios)
{
    std::string text =
        "## Ratios: time of the thesis to time of spawnfield\n\nThe thesis ran in Unity (PhysX) on a Ryzen 7 3700X. "
        "Its scenes had the same extents and statistics, but other content.\n"
        "Because machine, engine and scene differ, the ratios show what a user gains, not which processor or "
        "collision\n"
        "library is faster.\n\n"
        "| test | least | most | goal | reached |\n|---|---|---|---|---|\n";
    for (const auto& [test, all] : ratios) {
        const auto [least, most] = std::minmax_element(all.begin(), all.end());
        text += formatted("| %d | %s | %s | %g × | %s |\n", test, times_text(*least).c_str(), times_text(*most).c_str(),
                          thesis::goal(test), *least >= thesis::goal(test) ? "yes" : "**no**");
    }
    return text + "\n";
}

/// Returns from which step on the 3D raster takes no more time than the 2D raster, for both environments.
std::string break_even_text(const std::vector<Run>& runs)
{
    std::string text;
    for (const int test : {3, 4}) {
        std::vector<double> steps;
        for (const Group& three : groups_of(runs, [&](const Run& run) {
                 return run.test == test && run.mode == Mode::Mask && run.robot == "box";
             }))
            for (const Group& two : groups_of(runs, [&](const Run& run) {
                     return run.test == test + 2 && run.mode == Mode::Mask && run.robot == "box";
                 }))
                if (two.first.step == three.first.step && tools::mean(three.seconds) <= tools::mean(two.seconds))
                    steps.push_back(two.first.step);
        text += std::string(test == 3 ? "low-complexity, " : "; complex, ") +
                (steps.empty() ? "at no tested step"
                               : formatted("from %g m on", *std::min_element(steps.begin(), steps.end())));
    }
    return text;
}

std::string plots_section(const Results& results, const std::string& pictures)
{
    const auto image = [&](const std::string& file, const std::string& title) {
        return "![" + title + "](" + pictures + "/" + file + ")\n";
    };
    std::string text = "## Time against steps, 2D beside 3D\n\n" +
                       image("time_against_steps.png", "time against number of steps and step size");
    text += formatted(
        "\n3D takes no more time than 2D from a certain step on. The thesis: from 1.8 m on.\nspawnfield: %s.\n\n",
        break_even_text(results.runs).c_str());
    text += "## Time against spawns found\n\n" + image("time_against_spawns.png", "time against spawns found") +
            "\n## 2D beside 3D\n\n";
    std::uint64_t in_2d = 0, missed = 0, missed_snapped = 0;
    for (const ColumnFinds& finds : results.column_finds) {
        in_2d += finds.in_2d;
        missed += finds.in_2d && !finds.in_3d;
        missed_snapped += finds.in_2d && !finds.in_3d_snapped;
    }
    text += formatted(
        "The world is low-complexity, with steps of 2.5 m, up to 1 m above the ground. The 2D raster finds a place to "
        "stand in\n%s columns. The 3D raster misses %s of them (%s), because none of its steps is in reach above their "
        "ground.\nWith `--snap` it misses %s.\n\n",
        grouped(in_2d).c_str(), grouped(missed).c_str(), percent(missed, in_2d).c_str(),
        grouped(missed_snapped).c_str());
    text += image("columns_2d_3d.png", "2D beside 3D") +
            "\n## Special cases\n\nVerdicts of the box 0.3 m above the ground. "
            "Brown ground beside an obstacle is too near to it for a robot that looks\nalong x.\n\n";
    for (const Picture& picture : results.cases) text += image(picture.file, picture.title);
    text +=
        "\n## Random spawns\n\nThe spawns of the first runs of tests 7 and 8, drawn over the verdicts of the box 1 m "
        "above the ground.\n\n";
    for (const Picture& picture : results.spawns) text += image(picture.file, picture.title);
    return text;
}

}  // namespace

std::string runs_csv(const std::vector<Run>& runs)
{
    std::string text =
        "test,environment,robot,obstacle,mode,step,repetition,positions,valid,invalid,aerial,exact_checks,seconds\n";
    for (const Run& run : runs)
        text += formatted("%d,%s,%s,%s,%s,%g,%d,%llu,%llu,%llu,%llu,%llu,%.9g\n", run.test, run.environment.c_str(),
                          run.robot.c_str(), run.obstacle.c_str(), to_string(run.mode), run.step, run.repetition,
                          Count(run.positions), Count(run.valid), Count(run.invalid), Count(run.aerial),
                          Count(run.exact_checks), run.seconds);
    return text;
}

std::string milestones_csv(const std::vector<Milestone>& milestones)
{
    std::string text = "environment,distance_check,repetition,found,seconds\n";
    for (const Milestone& at : milestones)
        text += formatted("%s,%d,%d,%zu,%.9g\n", at.environment.c_str(), int(at.with_distance), at.repetition, at.found,
                          at.seconds);
    return text;
}

std::string column_finds_csv(const std::vector<ColumnFinds>& finds)
{
    std::string text = "x,y,in_2d,in_3d,in_3d_snapped\n";
    for (const ColumnFinds& at : finds)
        text += formatted("%g,%g,%d,%d,%d\n", at.x, at.y, int(at.in_2d), int(at.in_3d), int(at.in_3d_snapped));
    return text;
}

std::string thesis_csv()
{
    std::string text = "test,environment,robot,obstacle,mode,step,positions,valid,invalid,seconds\n";
    for (const thesis::Aerial& figure : thesis::aerial())
        text += formatted("1,empty,box,,thesis,1,%llu,0,0,%g\n", Count(figure.positions), figure.seconds);
    for (const thesis::Collision& figure : thesis::collision())
        text += formatted("2,,%s,%s,thesis,1,50000,0,50000,%g\n", figure.robot, figure.obstacle,
                          figure.ms_per_1000 * 0.05);
    for (int test = 3; test <= 6; ++test)
        for (const thesis::Raster& figure : thesis::raster(test))
            text += formatted("%d,%s,box,,thesis,%g,%llu,%llu,%llu,%g\n", test,
                              test % 2 == 1 ? "low-complexity" : "complex", figure.step, Count(figure.checks),
                              Count(figure.valid), Count(figure.invalid), figure.seconds);
    for (const int test : {7, 8})
        text += formatted("%d,%s,box,,thesis,2.5,,2000,,%g\n", test, test == 7 ? "low-complexity" : "complex",
                          thesis::random_search(test).mean);
    return text;
}

std::string report(const Settings& settings, const std::vector<const Environment*>& environments,
                   const Results& results, const std::string& command, const std::string& pictures)
{
    Ratios ratios;
    std::string tests = aerial_section(results.runs, ratios) + collision_section(results.runs, ratios);
    for (int test = 3; test <= 6; ++test) tests += raster_section(test, results.runs, ratios);
    for (const int test : {7, 8}) tests += search_section(test, results.runs, ratios);
    std::string text =
        "# The thesis's eight experiments\n\nRopelato's thesis on feasible spawn locations in Unity, from which "
        "spawnfield grew, timed eight tests. This report\n"
        "repeats them with the same parameters. The robot is the Husky's base as a box (0.99 × 0.67 × 0.39 m), or a "
        "convex hull\nof 196 triangles of that size.\n\n";
    if (settings.quick)
        text +=
            "**This was a quick run with coarse steps and maps, for counts and invariants. Its times have no "
            "meaning.**\n\n";
    text +=
        "Made by `" + command + "` with " + tools::machine() +
        formatted(
            ", in %.0f s, which includes making\nand baking the environments. Libraries: %s.\nSearches use the seeds 1 "
            "to 20.\n\n",
            results.total_seconds, libraries(environments.front()->map).c_str());
    return text + (settings.quick ? "" : ratios_section(ratios)) + environments_section(environments) + tests +
           plots_section(results, pictures);
}

}  // namespace experiments
