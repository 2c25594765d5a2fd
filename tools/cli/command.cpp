#include "command.h"

#include "messages.h"

namespace spawnfield::cli {

int run_command(const ChosenCommand& chosen)
{
    Summary summary(chosen.name, *chosen.args);
    const Ending ending = chosen.work(summary);
    summary.lap("write");
    summary.finish();
    if (!ending.notice.empty()) notice(*chosen.args, ending.notice);
    if (!ending.complaint.empty()) complain(ending.complaint);
    return ending.status;
}

}  // namespace spawnfield::cli
