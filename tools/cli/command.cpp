#include "command.h"

#include "messages.h"
#include "numbers.h"

namespace spawnfield::cli {

Ending interrupted_ending(std::size_t found, const std::string& noun, std::optional<std::size_t> wanted)
{
    return {.status = interrupted,
            .complaint = "interrupted: " + counted(found, noun) + (wanted ? " of " + std::to_string(*wanted) : "") +
                         (found == 1 ? " was" : " were") + " found and written"};
}

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
