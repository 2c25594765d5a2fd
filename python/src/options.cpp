#include "arrays.h"
#include "bindings.h"
#include "command.h"
#include "host.h"

#include <spawnfield/error.h>

#include <nanobind/stl/string.h>

namespace spawnfield::python {
namespace {

nb::dict about(const CLI::Option& option)
{
    nb::dict out;
    out["positional"] = option.get_positional();
    out["names"] = nb::list();
    for (const std::string& name : option.get_lnames()) nb::cast<nb::list>(out["names"]).append(name);
    out["group"] = option.get_group();
    out["help"] = option.get_description();
    out["values"] = option.get_items_expected_max() == 0 ? 0 : option.get_type_size();
    out["repeatable"] = option.get_expected_max() > 1;
    out["required"] = option.get_required();
    return out;
}

/// Returns the options of all commands: for each command, its description and a list of options.
nb::dict commands()
{
    cli::SilentHost host;  // the commands are only described, never run
    cli::ChosenCommand chosen{.host = &host};
    CLI::App app;
    cli::add_commands(app, "spawnfield", chosen);
    nb::dict out;
    for (const CLI::App* const command : app.get_subcommands([](CLI::App*) { return true; })) {
        nb::list options;
        for (const CLI::Option* const option : static_cast<const CLI::App*>(command)->get_options())
            if (option != command->get_help_ptr()) options.append(about(*option));
        nb::dict entry;
        entry["description"] = command->get_description();
        entry["options"] = options;
        out[command->get_name().c_str()] = entry;
    }
    return out;
}

}  // namespace

void bind_options(nb::module_& module) { module.def("commands", &commands); }

}  // namespace spawnfield::python
