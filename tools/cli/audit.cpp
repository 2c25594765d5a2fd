#include "command.h"
#include "ground_args.h"
#include "host.h"
#include "messages.h"
#include "numbers.h"
#include "output.h"
#include "reach_args.h"
#include "scene_args.h"
#include "session.h"
#include "spelling.h"

#include <spawnfield/audit.h>
#include <spawnfield/bake.h>
#include <spawnfield/error.h>
#include <spawnfield/input_file.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>

namespace spawnfield::cli {
namespace {

namespace fs = std::filesystem;

struct AuditArgs : QueryArgs, SceneArgs {
    std::vector<std::string> robots;
    std::string poses, rules, out, format = "text", bounds, z;
    double resolution = 0, step = 0, repair = 1, gap = 0.02, overlap = 0.01, min_room = 1;
    ReachArgs reach;
};

/// What is missing is always a finding, so this option of other commands has no meaning here.
const std::string no_option_here = "--allow-missing";

/// Options about the scene, which have no effect on a map that is baked already.
const std::vector<std::string>& bake_options()
{
    static const std::vector<std::string> options = [] {
        std::vector<std::string> out{"--resolution", "--bounds", "--z"};
        std::copy_if(scene_option_names.begin(), scene_option_names.end(), std::back_inserter(out),
                     [](const std::string& option) { return option != no_option_here; });
        return out;
    }();
    return options;
}

double parse_not_negative(const std::string& option, double value, const std::string& unit)
{
    if (!(value >= 0 && std::isfinite(value))) throw bad_value(option, value, ">= 0 " + unit);
    return value;
}

/// Returns the options without poses and progress. Throws ArgumentError.
AuditOptions audit_options(const AuditArgs& args, const CLI::App& command)
{
    AuditOptions out{.reach = reach_options(args, args.reach),
                     .min_room = parse_not_negative("--min-room", args.min_room, "m2"),
                     .repair = parse_positive("--repair", args.repair),
                     .threads = args.threads};
    if (command.count("--step") > 0) out.step = parse_positive("--step", args.step);
    return out;
}

bool is_map(const std::string& name) { return is_folder(name) && does_exist(fs::path(name) / "map.yaml"); }

/// Reads the map, or the scene and makes its map in memory. Sets AuditReport::map and AuditReport::missing.
void open_world(const AuditArgs& args, const CLI::App& command, Summary& summary, AuditReport& report)
{
    const Map* const map_in_memory = args.host->input<Map>(args.map);
    if (map_in_memory != nullptr || is_map(args.map)) {
        refuse(command, bake_options(), "is only for scenes; " + args.map + " is a map");
        report.map = map_in_memory != nullptr ? *map_in_memory : read_map(args.map);
        summary.map_hash = report.map.hash;
        return;
    }
    BakeOptions baking{
        .max_memory = memory_limit(args), .threads = args.threads, .progress = progress_bar(args, "bake")};
    if (command.count("--resolution") > 0) baking.resolution = parse_positive("--resolution", args.resolution);
    if (!args.z.empty() && !args.bounds.empty())
        throw ArgumentError("--z and --bounds both limit heights; give one of them");
    if (!args.bounds.empty()) baking.bounds = parse_bounds("--bounds", args.bounds, false);
    if (!args.z.empty()) baking.z = parse_z("--z", args.z);
    SceneOptions reading = scene_options(args, args);
    reading.bounds = baking.bounds;
    reading.allow_missing = !args.strict;  // what is missing is a finding
    const Scene* const scene_in_memory = args.host->input<Scene>(args.map);
    const Scene scene = scene_in_memory != nullptr ? *scene_in_memory : read_scene(args, args.map, reading);
    std::vector<std::string> other = scene.notices;
    std::erase_if(other, [&](const std::string& text) {
        return std::find(scene.missing.begin(), scene.missing.end(), text) != scene.missing.end();
    });
    notices(args, other);
    if (!scene.has_terrain())
        throw FileError(args.map,
                        "has no terrain, so no robot can stand anywhere; label a part `terrain` (--label "
                        "'GLOB=terrain')");
    report.missing = scene.missing;
    report.map = make_map(scene, baking);
}

std::vector<NamedPose> named_poses(const AuditArgs& args)
{
    std::vector<NamedPose> out;
    if (args.poses.empty()) return out;
    const PoseTable table = open_poses(args, args.poses);
    notice_about_tilted(args, args.poses, count_tilted(table));
    const std::vector<std::string> names = pose_names(table);
    for (std::size_t i = 0; i < names.size(); ++i) out.push_back({names[i], table.poses[i]});
    return out;
}

std::vector<Robot> load_robots(const AuditArgs& args, const CLI::App& command)
{
    std::vector<Robot> out;
    for (const std::string& name : args.robots) {
        out.push_back(open_robot(args, name, robot_options(args)));
        notices_about_stance(args, command, out.back());
    }
    return out;
}

/// Prints a notice for each glob that matches no part, because it is most often a typing error.
void notice_about_globs(const AuditArgs& args, const std::vector<std::string>& globs, const Map& map)
{
    for (const std::string& glob : globs)
        if (parts_that_match(map.geometry, glob).empty())
            notice(args, args.rules + ": allow: \"" + glob + "\" matches no part of the world");
}

void write_report(const AuditArgs& args, const AuditReport& report)
{
    write_output(args, args.out, [&](const auto& sink) {
        if (args.format == "json")
            write_audit_json(report, sink);
        else if (args.format == "junit")
            write_audit_junit(report, sink);
        else if (args.format == "html")
            write_audit_html(report, sink, args.threads);
        else
            sink(audit_text(report));
    });
}

/// Returns the end of the command: status 3 and the broken rules, if there are any.
Ending ending_of(const AuditReport& report)
{
    std::string list;
    std::size_t broken = 0;
    for (const RuleResult& result : report.rules) {
        if (result.is_kept) continue;
        ++broken;
        list += "\n  " + result.rule + ": " + result.words;
    }
    if (broken == 0) return {};
    return {.status = rule_broken,
            .complaint = std::to_string(broken) + " of " + counted(report.rules.size(), "rule") +
                         (broken == 1 ? " is broken:" : " are broken:") + list};
}

Ending run_audit(const AuditArgs& args, const CLI::App& command, Summary& summary)
{
    const AuditRules rules = args.rules.empty() ? AuditRules() : read_audit_rules(args.rules);
    AuditOptions options = audit_options(args, command);
    // Not as one initializer: if a part of it throws, gcc 12 destroys the map of the report twice.
    AuditReport report;
    report.part_limits.gap = parse_not_negative("--gap", args.gap, "m");
    report.part_limits.overlap = parse_positive("--overlap", args.overlap);
    report.part_limits.allow = rules.allow;
    report.part_limits.threads = args.threads;
    report.min_room = options.min_room;
    const JudgeOptions limits = judge_options(args, summary.exact_time());
    report.poses = options.poses = audited_poses(rules, named_poses(args));
    const std::vector<Robot> robots = load_robots(args, command);
    open_world(args, command, summary, report);
    notice_about_globs(args, rules.allow, report.map);
    summary.lap("load");
    VerdictCounts counts;
    std::uint64_t exact_checks = 0;
    for (const Robot& robot : robots) {
        options.progress = progress_bar(args, "audit, " + robot.name);
        report.robots.push_back(audit_robot({report.map, robot, limits}, options));
        const RobotAudit& audit = report.robots.back();
        if (!audit.notice.empty()) notice(args, audit.notice);
        counts += audit.raster.counts;
        exact_checks += audit.raster.exact_checks;
    }
    report.part_limits.progress = progress_bar(args, "audit, parts");
    report.parts = find_wrong_parts(report.map, report.part_limits);
    report.rules = results_of(rules, report);
    summary.lap("query");
    write_report(args, report);
    summary.set_verdicts(counts, exact_checks);
    return ending_of(report);
}

void add_finding_options(CLI::App& command, AuditArgs& args)
{
    command.add_option("--step", args.step,
                       "m between the poses from which the free area is computed (default: 150 along the longer side)");
    command.add_option("--repair", args.repair,
                       "m: radius in which the nearest valid pose is searched for one that is not valid (default 1)");
    command.add_option("--min-room", args.min_room, "m2: smallest area of a closed room (default 1)");
    command.add_option(
        "--gap", args.gap,
        "m: things that are at most this far from each other touch, so they do not float (default 0.02)");
    command.add_option("--overlap", args.overlap, "m: parts that overlap by less are not reported (default 0.01)");
}

void add_bake_options(CLI::App& command, AuditArgs& args)
{
    add_scene_options(command, args);
    add_label_options(command, args);
    command.add_option("--resolution", args.resolution, "Side of a terrain cell, m (default 0.1)");
    command.add_option("--bounds", args.bounds, "x0,y0,z0,x1,y1,z1 in m (default: the scene's)");
    command.add_option("--z", args.z, "LOW:HIGH in m: only z limits; x and y are the scene's (5: or :8 for one limit)");
}

}  // namespace

void add_audit(CLI::App& app, ChosenCommand& chosen)
{
    auto args = std::make_shared<AuditArgs>();
    args->confines_usually = true;  // audits are for worlds from anywhere
    CLI::App& command = *app.add_subcommand("audit", "Report on a world and its faults, with rules for CI");
    command.add_option("scene", args->map, "Scene or world file, as for `bake`, or a map folder")->required();
    command
        .add_option("--robot,-r", args->robots,
                    "robot.yaml, a .urdf, an SDF model, or box:LX,LY,LZ[@x,y,z] (m). Repeatable")
        ->required()
        ->allow_extra_args(false)
        ->check(not_empty());
    command.add_option("--poses,-p", args->poses,
                       "CSV file of start poses, as for `check`; each robot is let down at all of them (- for standard "
                       "input)");
    command
        .add_option("--rules", args->rules,
                    "YAML file of rules: min_free_area, max_islands, max_closed_rooms, max_overlaps, max_floating, "
                    "max_sunken, max_missing, require, allow. The status is 3 if one is broken")
        ->check(not_empty());
    command.add_option("--out,-o", args->out, "File to write (default: standard output)");
    command
        .add_option("--format", args->format,
                    "text; json; junit: test cases; or html: one file with pictures (default text)")
        ->check(one_of({"text", "json", "junit", "html"}));
    command.add_flag_callback(
        "--html", [args] { args->format = "html"; }, "The same as --format html");
    add_finding_options(command, *args);
    add_verdict_options(command, *args);
    add_stance(command, *args, Stance::Settled);
    add_reach(command, args->reach);
    add_bake_options(command, *args);
    for (const std::string& option :
         {std::string("--settle"), std::string("--stance"), std::string("--collision"), no_option_here})
        command.remove_option(command.get_option(option));
    start_group(command, help_group::robot);
    add_model_path(command, *args);
    add_trusted(command, *args);
    add_robot_options(command, *args);
    add_common(command, *args);
    add_allow_empty(command, *args);
    command.footer(
        "Example:\n"
        "  spawnfield audit maps/training/scene.yaml --robot maps/robots/husky.yaml\n"
        "  printf 'min_free_area: 100\\nmax_floating: 0\\nrequire: [[0, 0, 0.1, 0]]\\n' > /tmp/rules.yaml\n"
        "  spawnfield audit maps/training/scene.yaml --robot maps/robots/husky.yaml --rules /tmp/rules.yaml --format "
        "html -o /tmp/audit.html");
    set_work(command, args, chosen, run_audit);
}

}  // namespace spawnfield::cli
