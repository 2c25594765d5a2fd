#include "check_pairs.h"
#include "messages.h"
#include "numbers.h"
#include "output.h"
#include "results.h"
#include "session.h"
#include "spelling.h"
#include "streams.h"

#include <spawnfield/error.h>
#include <spawnfield/verdict_report.h>

#include <cmath>
#include <optional>

namespace spawnfield::cli {
namespace {

struct CheckArgs : QueryArgs {
    std::string poses, out, format = "csv";
    bool require_valid = false;
    std::optional<double> repair, repair_step;  ///< m
    std::string repaired;
    CheckPairsArgs pairs;
};

/// Returns how poses are repaired; nothing without --repair. Throws ArgumentError for values beyond their limits.
std::optional<RepairOptions> repair_options(const CheckArgs& args, const CLI::App& command)
{
    if (!args.repair) {
        refuse(command, {"--repair-step", "--repaired"}, "needs --repair M");
        return std::nullopt;
    }
    if (!(*args.repair > 0) || !std::isfinite(*args.repair)) throw bad_value("--repair", *args.repair, "> 0 m");
    const double smallest = *args.repair / largest_repair_grid;
    if (args.repair_step && (!(*args.repair_step >= smallest) || !std::isfinite(*args.repair_step)))
        throw bad_value("--repair-step", *args.repair_step,
                        "at least " + number(smallest) + " m, so that the grid has at most 3 million places");
    return RepairOptions{.radius = *args.repair,
                         .step = args.repair_step,
                         .stance = args.stance(),
                         .threads = args.threads,
                         .progress = progress_bar(args, "repair")};
}

/// Writes the verdicts and, with --repaired, the repaired poses: both files, or none.
void write_results(const CheckArgs& args, const VerdictReport& report)
{
    const auto write_verdicts = [&](const auto& sink) {
        if (args.format == "json")
            write_verdicts_json(report, sink);
        else if (args.format == "junit")
            write_verdicts_junit(report, sink);
        else
            write_verdicts_csv(report, sink, args.threads);
    };
    write_output(args, args.out, write_verdicts, [&] {
        if (args.repaired.empty()) return;
        write_output(args, args.repaired, [&](const auto& sink) { sink(repaired_csv(report.table, *report.repairs)); });
    });
}

/// Prints a notice about columns of the input that the verdicts replace.
void notice_about_columns(const CheckArgs& args, const PoseTable& table)
{
    const std::vector<std::string> replaced = replaced_columns(table, args.is_settled(), args.repair.has_value());
    if (replaced.size() == 1)
        notice(args, input_name(args.poses) + ": the new column " + replaced[0] + " replaces the old one");
    else if (!replaced.empty())
        notice(args,
               input_name(args.poses) + ": new columns replace the old ones: " + CLI::detail::join(replaced, ", "));
}

/// The verdicts on the poses of a table.
struct Checked {
    std::vector<SettledPose> settled;  ///< empty for poses as given
    std::vector<Judgement> judgements;
};

Checked check_poses(const CheckArgs& args, const Judge& judge, const PoseTable& table, const Progress& progress)
{
    const RunOptions run{.threads = args.threads, .progress = progress};
    Checked out;
    if (!args.is_settled()) {
        out.judgements = judge.check(table.poses, run);
        return out;
    }
    out.settled = judge.settle(table.poses, run);
    for (const SettledPose& pose : out.settled) out.judgements.push_back(judgement_of(pose));
    return out;
}

VerdictReport report_of(const CheckArgs& args, const PoseTable& table, const Checked& checked, const Judge& judge)
{
    return {table, checked.judgements, judge, args.is_settled() ? &checked.settled : nullptr};
}

/// What is counted of all poses.
struct Totals {
    VerdictCounts counts;
    std::uint64_t exact_checks = 0;
    std::uint64_t tilted = 0;  ///< only for settled poses
    NotValid not_valid;        ///< only with --require-valid

    void add(const CheckArgs& args, const VerdictReport& report)
    {
        for (const Judgement& judged : report.judgements) {
            ++counts[judged.verdict];
            exact_checks += judged.exact_check;
        }
        if (args.is_settled()) tilted += count_tilted(report.table);
        if (args.require_valid) not_valid.add(report);
    }
};

/// Returns the progress of a part of the file; its shares before and after are NaN if the size is not known.
Progress progress_of_part(const CheckArgs& args, const Progress& whole, double from, double to)
{
    return [=, &args](double share) {
        if (std::isnan(to))
            stop_if_interrupted(args);
        else
            whole(from + share * (to - from));
    };
}

/// Checks the poses part by part, the first of which is `table`, and writes CSV.
void check_in_parts(const CheckArgs& args, const Judge& judge, PoseParts& parts, PoseTable table, Totals& totals,
                    Summary& summary)
{
    const Progress progress = progress_bar(args, "check");
    write_output(args, args.out, [&](const auto& sink) {
        double done = 0;
        for (;;) {
            const double share = parts.share();
            const Checked checked = check_poses(args, judge, table, progress_of_part(args, progress, done, share));
            VerdictReport report = report_of(args, table, checked, judge);
            report.first = totals.counts.total();
            summary.lap("query");
            write_verdicts_csv(report, sink, args.threads);
            summary.lap("write");
            totals.add(args, report);
            if (!parts.has_next()) break;
            table = parts.next();
            summary.lap("load");
            done = share;
        }
    });
}

/// Returns the repairs of the poses that are not valid, and puts them into the summary.
RepairList repair(const Judge& judge, const PoseTable& table, const Checked& checked, const RepairOptions& options,
                  Totals& totals, Summary& summary)
{
    RepairList out = repair_poses(judge, table.poses, checked.judgements, options);
    for (const std::optional<Repair>& repair : out.repairs) totals.exact_checks += repair ? repair->exact_checks : 0;
    summary.repairs = {out.repaired, out.turned, out.unrepaired};
    summary.extra.push_back(std::to_string(out.repaired) + " repaired (" + std::to_string(out.turned) + " turned), " +
                            std::to_string(out.unrepaired) + " without a repair");
    return out;
}

/// Returns what "no repair" means, if there are such poses; otherwise "".
std::string unrepaired_words(const CheckArgs& args, const RepairList& repairs)
{
    if (repairs.unrepaired == 0) return "";
    const RepairOptions& search = repairs.options;
    return counted(repairs.unrepaired, "pose") + (repairs.unrepaired == 1 ? " has" : " have") + " no repair: within " +
           rounded(search.radius) + " m, no place on a grid with a step of " + rounded(*search.step) +
           " m is valid at any of " + counted(std::uint64_t(search.headings), "heading") +
           "; a larger --repair or a smaller --repair-step may find one" +
           (args.repaired.empty() ? "" : "; " + args.repaired + " has the old poses there");
}

/// Throws ArgumentError for options that do not go together with --pairs, and lets the robot down.
Ending run_pairs_of_check(CheckArgs args, const CLI::App& command, Summary& summary)
{
    refuse(command, {"--poses", "--repair", "--repair-step", "--repaired"}, "has no effect with --pairs; leave it out");
    if (args.given_stance == "level")
        throw ArgumentError(
            "--pairs is only for settled robots, because paths lead between settled poses; leave --stance level out");
    args.settle = true;
    return run_check_pairs(args, args.pairs, command, {args.out, args.format, args.require_valid}, summary);
}

/// Checks all poses at once, and returns a notice for the end, or "".
std::string check_at_once(const CheckArgs& args, const Judge& judge, const std::optional<RepairOptions>& options,
                          PoseTable table, Totals& totals, Summary& summary)
{
    Checked checked = check_poses(args, judge, table, progress_bar(args, "check"));
    std::optional<RepairList> repairs;
    if (options) repairs = repair(judge, table, checked, *options, totals, summary);
    VerdictReport report = report_of(args, table, checked, judge);
    report.repairs = repairs ? &*repairs : nullptr;
    totals.add(args, report);
    summary.lap("query");
    write_results(args, report);
    const std::string words = repairs ? unrepaired_words(args, *repairs) : "";
    keep(args, FoundVerdicts{std::move(table), std::move(checked.judgements), std::move(checked.settled),
                             std::move(repairs), judge});
    return words;
}

Ending run_check(const CheckArgs& args, const CLI::App& command, Summary& summary)
{
    if (command.count("--pairs") > 0) return run_pairs_of_check(args, command, summary);
    if (command.count("--poses") == 0) throw ArgumentError("--poses is required, or --pairs");
    refuse_check_pairs_options(command);
    const std::optional<RepairOptions> options = repair_options(args, command);
    const bool in_parts = args.format == "csv" && !options && !args.host->wants_values();
    constexpr std::size_t poses_of_part = 1 << 16;
    PoseParts parts(args, args.poses, in_parts ? poses_of_part : PoseStream::all);
    PoseTable table = parts.next();
    notice_about_columns(args, table);
    const Session session = open_session(args, summary);
    notices_about_stance(args, command, session.robot);
    summary.lap("load");
    Totals totals;
    Ending ending;
    if (in_parts)
        check_in_parts(args, *session.judge, parts, std::move(table), totals, summary);
    else
        ending.notice = check_at_once(args, *session.judge, options, std::move(table), totals, summary);
    notice_about_tilted(args, args.poses, totals.tilted);
    summary.set_verdicts(totals.counts, totals.exact_checks);
    if (!totals.not_valid.is_empty()) {
        ending.status = not_valid;
        ending.complaint = "--require-valid: " + totals.not_valid.words();
    }
    return ending;
}

}  // namespace

void add_check(CLI::App& app, ChosenCommand& chosen)
{
    auto args = std::make_shared<CheckArgs>();
    CLI::App& command = *app.add_subcommand("check", "Verdict and reason for each pose of a CSV file");
    add_map_and_robot(command, *args);
    command.add_option(
        "--poses,-p", args->poses,
        "CSV file: x,y,z[,roll,pitch,yaw | ,roll_deg,pitch_deg,yaw_deg | ,qx,qy,qz,qw]; m, rad, degrees. "
        "Other columns are copied; verdict,ground,height_above,hit are replaced (- for standard input)");
    command.add_option("--out,-o", args->out, "File to write (default: standard output)");
    command
        .add_option(
            "--format", args->format,
            "csv: the input's columns and the verdict; json; or junit: a test case for each pose or pair (default "
            "csv)")
        ->check(one_of({"csv", "json", "junit"}));
    command.add_flag("--require-valid", args->require_valid,
                     "End with status 3 if a pose is not valid, or with --repair if it is also not repaired; all rows "
                     "are written in any case");
    start_group(command, help_group::repair);
    command.add_option("--repair", args->repair,
                       "m. For each pose that is not valid, add the nearest valid pose within this distance: with the "
                       "same heading if there is one, otherwise with one of 15 others");
    command.add_option("--repair-step", args->repair_step,
                       "m. Places for repairs lie on a grid with this step (default: a twentieth of --repair, or a "
                       "quarter of the robot's shorter side if that is less)");
    command
        .add_option("--repaired", args->repaired,
                    "CSV file to write: the poses of --poses with repairs in the place of those that are not valid "
                    "(- for standard output)")
        ->check(not_empty());
    add_verdict_options(command, *args);
    add_stance(command, *args, Stance::Level);
    start_group(command, help_group::reach);
    add_check_pairs(command, args->pairs);
    add_robot_and_run(command, *args);
    add_allow_empty(command, *args);
    command.footer(
        "Example:\n"
        "  printf 'x,y,z,yaw\\n0,0,0.1,0\\n7,7,0.1,0\\n' > /tmp/two_poses.csv\n"
        "  spawnfield check /tmp/training --robot box:0.99,0.67,0.39 --poses /tmp/two_poses.csv\n"
        "  spawnfield check /tmp/training --robot box:0.99,0.67,0.39 --poses /tmp/two_poses.csv --repair 1 --repaired "
        "/tmp/repaired_poses.csv\n"
        "  spawnfield sample /tmp/training --robot box:0.99,0.67,0.39 --pairs 20 --reach-step 0.3 -o /tmp/pairs.csv\n"
        "  spawnfield check /tmp/training --robot box:0.99,0.67,0.39 --pairs /tmp/pairs.csv --reach-step 0.3");
    set_work(command, args, chosen, run_check);
}

}  // namespace spawnfield::cli
