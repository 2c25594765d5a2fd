#pragma once

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace spawnfield::cli {

/// Returns "; did you mean --min-distance?" if some of the words are similar to `text`, else nothing.
std::string suggestion(const std::string& text, const std::vector<std::string>& words);

/// Accepts one of these words. The message about another word lists them, with a suggestion.
CLI::Validator one_of(std::vector<std::string> words);

/// Returns the words that one_of() accepts for the option's values. Empty if the option has no such check.
std::vector<std::string> choices_of(CLI::Option& option);

/// Returns a line about the first unknown option of the chosen command, with a suggestion. Empty if there is none.
std::string unknown_option(const CLI::App& app);

}  // namespace spawnfield::cli
