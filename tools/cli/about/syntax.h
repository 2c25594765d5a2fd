#pragma once

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace spawnfield::cli {

/// What a value of an option is, as far as a shell can complete it.
enum class ValueKind { none, choice, file, folder, other };

/// The type of an option with so many choices that its help lists them elsewhere.
inline const std::string long_choice = "WORD";

struct OptionSyntax {
    std::vector<std::string> names = {};  ///< "--out", "-o"; a positional argument has one name, without dashes
    std::string description = {};
    std::string group = {};                 ///< its heading of --help
    std::string type = {};                  ///< what stands for a value in help: "FILE", "N"; empty for a flag
    ValueKind kind = ValueKind::none;       ///< none: a flag
    std::vector<std::string> choices = {};  ///< only with ValueKind::choice
    int values = 0;                         ///< number of values after each use; 0 for a flag
    bool is_required = false, is_repeatable = false;
    std::vector<std::string> needs = {}, excludes = {};  ///< names of other options
};

struct CommandSyntax {
    std::string name, description;
    std::string footer;                     ///< with examples
    std::vector<OptionSyntax> positionals;  ///< in their order
    std::vector<OptionSyntax> options;      ///< in the order of --help
    std::vector<CommandSyntax> commands;
};

/// Returns the command line of an app and of its commands.
CommandSyntax syntax_of(CLI::App& app);

/// Returns the first sentence of a description, with at most 80 characters, for lists of completions.
std::string brief(const std::string& description);

/// Returns the word with a backslash before each of the characters.
std::string with_backslashes(const std::string& text, const std::string& characters);

/// Returns the text as a word in single quotes for bash and zsh.
std::string quoted_for_sh(const std::string& text);

}  // namespace spawnfield::cli
