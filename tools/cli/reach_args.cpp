#include "reach_args.h"

#include "messages.h"
#include "spelling.h"

namespace spawnfield::cli {

void add_reach(CLI::App& command, ReachArgs& args)
{
    start_group(command, help_group::reach);
    command
        .add_option("--drive", args.drive,
                    "How the robot moves: differential (ahead, back, and turns on the spot), or omni (also to the "
                    "sides) (default differential)")
        ->check(one_of({"differential", "omni"}).description(""));
    command.add_option("--max-step", args.max_step,
                       "m: largest step up or down in the ground that the robot overcomes (default 0.03)");
    command.add_option("--reach-step", args.reach_step,
                       "m between the places whose ways are examined (default: a quarter of the robot's smallest "
                       "width)");
}

ReachGraph make_reach_graph(const CommonArgs& common, const ReachArgs& args, const Judge& judge,
                            const std::string& command)
{
    return {judge,
            {.drive = args.drive == "omni" ? Drive::Omni : Drive::Differential,
             .max_step = args.max_step,
             .step = args.reach_step,
             .threads = common.threads,
             .progress = progress_bar(common, command)}};
}

}  // namespace spawnfield::cli
