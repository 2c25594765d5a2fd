#include "command.h"
#include "messages.h"
#include "numbers.h"
#include "output.h"
#include "session.h"
#include "spelling.h"
#include "streams.h"

#include <spawnfield/verdict_report.h>

#include <algorithm>

namespace spawnfield::cli {
namespace {

struct CheckArgs : QueryArgs {
    std::string poses, out, format = "csv";
    bool require_valid = false;
};

void write_verdicts(const CheckArgs& args, const VerdictReport& report)
{
    write_output(args.out, [&](const auto& sink) {
        if (args.format == "json")
            write_verdicts_json(report, sink);
        else if (args.format == "junit")
            write_verdicts_junit(report, sink);
        else if (report.settled != nullptr)
            sink(settled_csv(report.table, *report.settled, report.judge));
        else
            sink(verdicts_csv(report.table, report.judgements, report.judge.map()));
    });
}

Ending run_check(const CheckArgs& args, const CLI::App& command, Summary& summary)
{
    const PoseTable table = open_poses(args, args.poses);
    if (const std::vector<std::string> replaced = replaced_columns(table, args.is_settled()); replaced.size() == 1)
        notice(args, input_name(args.poses) + ": the new column " + replaced[0] + " replaces the old one");
    else if (!replaced.empty())
        notice(args,
               input_name(args.poses) + ": new columns replace the old ones: " + CLI::detail::join(replaced, ", "));
    if (args.is_settled()) notice_about_tilted(args, args.poses, table);
    const Session session = open_session(args, summary);
    notices_about_stance(args, command, session.robot);
    summary.lap("load");
    const RunOptions run{.threads = args.threads, .progress = progress_bar(args, "check")};
    std::vector<SettledPose> settled;
    std::vector<Judgement> judgements;
    if (args.is_settled()) {
        settled = session.judge->settle(table.poses, run);
        for (const SettledPose& pose : settled) judgements.push_back(judgement_of(pose));
    } else {
        judgements = session.judge->check(table.poses, run);
    }
    summary.lap("query");
    VerdictCounts counts;
    std::uint64_t exact_checks = 0;
    for (const Judgement& judged : judgements) {
        ++counts[judged.verdict];
        exact_checks += judged.exact_check;
    }
    summary.set_verdicts(counts, exact_checks);
    const VerdictReport report{table, judgements, *session.judge, args.is_settled() ? &settled : nullptr};
    write_verdicts(args, report);
    if (!args.require_valid || counts[Verdict::Valid] == judgements.size()) return {};
    return {.status = not_valid, .complaint = "--require-valid: " + not_valid_words(report)};
}

}  // namespace

void add_check(CLI::App& app, ChosenCommand& chosen)
{
    auto args = std::make_shared<CheckArgs>();
    CLI::App& command = *app.add_subcommand("check", "Verdict and reason for each pose of a CSV file");
    add_map_and_robot(command, *args);
    command
        .add_option("--poses,-p", args->poses,
                    "CSV file: x,y,z[,roll,pitch,yaw | ,roll_deg,pitch_deg,yaw_deg | ,qx,qy,qz,qw]; m, rad, degrees. "
                    "Other columns are copied; verdict,ground,height_above,hit are replaced (- for standard input)")
        ->required();
    command.add_option("--out,-o", args->out, "File to write (default: standard output)");
    command
        .add_option("--format", args->format,
                    "csv: the input's columns and the verdict; json; or junit: a test case for each pose (default csv)")
        ->check(one_of({"csv", "json", "junit"}));
    command.add_flag("--require-valid", args->require_valid,
                     "End with status 3 if a pose is not valid; all rows are written in any case");
    add_verdict_options(command, *args);
    add_stance(command, *args, Stance::Level);
    add_robot_and_run(command, *args);
    add_allow_empty(command, *args);
    command.footer(
        "Example:\n"
        "  printf 'x,y,z,yaw\\n0,0,0.1,0\\n7,7,0.1,0\\n' > /tmp/two_poses.csv\n"
        "  spawnfield check /tmp/training --robot box:0.99,0.67,0.39 --poses /tmp/two_poses.csv");
    set_work(command, args, chosen, run_check);
}

}  // namespace spawnfield::cli
