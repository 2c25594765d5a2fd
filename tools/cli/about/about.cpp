#include "about.h"

#include "completion.h"
#include "library_versions.h"
#include "manual.h"
#include "output.h"
#include "spelling.h"

namespace spawnfield::cli {
namespace {

struct AboutArgs : CommonArgs {
    CLI::App* app = nullptr;
    std::string shell;
};

/// The text is the only thing that these commands print: scripts often run them at the start of a shell.
std::shared_ptr<AboutArgs> quiet_args(CLI::App& app)
{
    auto args = std::make_shared<AboutArgs>();
    args->app = &app;
    args->quiet = true;
    return args;
}

Ending print(const AboutArgs& args, const std::string& text)
{
    write_output(args, "", [&](const auto& sink) { sink(text); });
    return {};
}

Ending run_completion(const AboutArgs& args, const CLI::App&, Summary&)
{
    const CommandSyntax program = syntax_of(*args.app);
    return print(args, args.shell == "bash"  ? bash_completion(program)
                       : args.shell == "zsh" ? zsh_completion(program)
                                             : fish_completion(program));
}

Ending run_man(const AboutArgs& args, const CLI::App&, Summary&) { return print(args, manual(syntax_of(*args.app))); }

void add_completion(CLI::App& app, ChosenCommand& chosen)
{
    const auto args = quiet_args(app);
    CLI::App& command = *app.add_subcommand("completion", "Print a script for completion with the Tab key");
    command
        .add_option("shell", args->shell,
                    "The shell: bash, zsh or fish. An installed package has these scripts where the shells find them")
        ->required()
        ->check(one_of({"bash", "zsh", "fish"}));
    command.footer(
        "Example:\n  eval \"$(spawnfield completion bash)\"\n"
        "  spawnfield completion fish > ~/.config/fish/completions/spawnfield.fish");
    set_work(command, args, chosen, run_completion);
}

void add_man(CLI::App& app, ChosenCommand& chosen)
{
    CLI::App& command = *app.add_subcommand("man", "Print the man page, for `man -l -`");
    command.footer("Example:\n  spawnfield man | man -l -");
    set_work(command, quiet_args(app), chosen, run_man);
}

}  // namespace

void add_about(CLI::App& app, ChosenCommand& chosen)
{
    app.set_version_flag("--version", &version_text, "Print the versions of the program and of its libraries and exit");
    add_completion(app, chosen);
    add_man(app, chosen);
}

}  // namespace spawnfield::cli
