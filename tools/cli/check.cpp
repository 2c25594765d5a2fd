#include "cli.h"

namespace spawnfield::cli {
namespace {

struct CheckArgs : QueryArgs {
    std::string poses, out;
};

int run_check(const CheckArgs& args)
{
    Summary summary("check", args);
    QueryOptions options;
    fill(options, args, "check");
    options.exact_time = &summary.exact_time;
    const PoseTable table = open_poses(args, args.poses);
    for (const std::string& name : replaced_columns(table)) notice(args, args.poses + ": column " + name + " is replaced by a new one");
    const auto session = open_session(args);
    summary.lap("load");
    const std::vector<Judgement> judgements = check_poses(session->map, *session->checker, table.poses, options);
    summary.lap("query");
    VerdictCounts counts{};
    for (const Judgement& judged : judgements) {
        ++counts[std::size_t(judged.verdict)];
        summary.exact_checks += judged.exact_check;
    }
    write_output(args.out, [&](const auto& sink) { sink(verdicts_csv(table, judgements, session->map.geometry.parts())); });
    summary.lap("write");
    summary.set_counts(counts);
    summary.map_hash = session->map.hash;
    summary.finish();
    return done;
}

}  // namespace

void add_check(CLI::App& app, Run& run)
{
    auto args = std::make_shared<CheckArgs>();
    CLI::App& command = *app.add_subcommand("check", "Verdict and reason for each pose of a CSV file");
    add_query(command, *args);
    command
        .add_option("--poses,-p", args->poses,
                    "CSV file: x,y,z[,roll,pitch,yaw | ,roll_deg,pitch_deg,yaw_deg | ,qx,qy,qz,qw]; m, rad, degrees; "
                    "other columns are kept, but "
                    "verdict,ground,height_above,hit replaced (- for standard input)")
        ->required();
    add_allow_empty(command, *args);
    command.add_option("--out,-o", args->out, "CSV file to write (default: standard output)");
    command.footer("Example:\n"
                   "  printf 'x,y,z,yaw\\n0,0,0.1,0\\n7,7,0.1,0\\n' > /tmp/two_poses.csv\n"
                   "  spawnfield check /tmp/training --robot box:0.99,0.67,0.39 --poses /tmp/two_poses.csv");
    command.callback([=, &run] { run = [=] { return run_check(*args); }; });
}

}  // namespace spawnfield::cli
