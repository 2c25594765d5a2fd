#include "command.h"
#include "numbers.h"
#include "output.h"

#include <spawnfield/leftovers.h>

namespace spawnfield::cli {
namespace {

struct CleanArgs : CommonArgs {
    std::string folder;
    bool recursive = false, dry_run = false;
};

std::string line_about(const Leftover& left, bool dry_run)
{
    const std::string path = left.path.lexically_normal().string();
    if (left.put_back_to.empty()) return (dry_run ? "would remove " : "removed ") + path + "\n";
    return (dry_run ? "would rename " : "renamed ") + path + " to " + left.put_back_to.lexically_normal().string() +
           "\n";
}

std::string complaint_about(const Leftover& left)
{
    return left.path.lexically_normal().string() + ": cannot be " +
           (left.put_back_to.empty() ? "removed: " : "renamed: ") + left.failure;
}

Ending run_clean(const CleanArgs& args, const CLI::App&, Summary& summary)
{
    const std::vector<Leftover> all = clean_folder(args.folder, {.recursive = args.recursive, .dry_run = args.dry_run});
    std::string text, complaint;
    std::size_t done_ones = 0;
    for (const Leftover& left : all) {
        if (!left.failure.empty()) {
            complaint += (complaint.empty() ? "" : "\nspawnfield: ") + complaint_about(left);
            continue;
        }
        text += line_about(left, args.dry_run);
        ++done_ones;
    }
    write_output(args, "", [&](const auto& sink) { sink(text); });
    summary.extra = {args.folder, counted(done_ones, "leftover") + (args.dry_run ? " found" : " cleaned")};
    return {.status = complaint.empty() ? done : failure, .complaint = complaint};
}

}  // namespace

void add_clean(CLI::App& app, ChosenCommand& chosen)
{
    auto args = std::make_shared<CleanArgs>();
    CLI::App& command = *app.add_subcommand("clean", "Remove temporary files that killed runs left");
    command
        .add_option("folder", args->folder,
                    "Folder in which to look for files and folders NAME.tmp-… and NAME.old-… of killed runs. Those of "
                    "running programs stay. If NAME does not exist, NAME.old-… gets this name back")
        ->required()
        ->check(not_empty());
    command.add_flag("--recursive", args->recursive, "Also look in the folders below");
    command.add_flag("--dry-run", args->dry_run, "Only list what would be removed or renamed");
    add_common(command, *args);
    command.footer("Example:\n  spawnfield clean /tmp --dry-run");
    set_work(command, args, chosen, run_clean);
}

}  // namespace spawnfield::cli
