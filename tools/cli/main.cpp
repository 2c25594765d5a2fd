#include "cli.h"
#include "interrupt.h"

#include <spawnfield/error.h>

#include <iostream>

namespace {

using namespace spawnfield;
using namespace spawnfield::cli;

int tell(int status, const std::string& message)
{
    clear_progress_bar();
    std::cerr << "spawnfield: " << message << "\n";
    return status;
}

int guarded(const Run& run)
{
    try {
        return run();
    } catch (const Interrupted&) {
        return tell(interrupted, "interrupted; nothing was written");
    } catch (const ArgumentError& error) {
        return tell(wrong_usage, error.what());
    } catch (const FileError& error) {
        return tell(input_refused, error.what());
    } catch (const std::bad_alloc&) {
        return tell(failure, "out of memory; a coarser --resolution or --step, or smaller --bounds, needs less");
    } catch (const std::exception& error) {
        return tell(failure, error.what());
    }
}

}  // namespace

int main(int argc, char** argv)
{
    CLI::App app{"spawnfield: where can this robot stand in this world?", "spawnfield"};
    app.set_version_flag("--version", version());
    app.require_subcommand(1);
    app.footer("Example:\n"
               "  spawnfield bake maps/training/scene.yaml -o /tmp/training\n"
               "  spawnfield sample /tmp/training --robot maps/robots/husky.yaml -n 10");
    Run run;
    add_bake(app, run);
    add_info(app, run);
    add_check(app, run);
    add_raster(app, run);
    add_search(app, run);
    add_sample(app, run);
    add_heatmap(app, run);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? done : wrong_usage;
    }
    catch_interrupts();
    return guarded(run);
}
