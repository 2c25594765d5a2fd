#pragma once

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace spawnfield::cli {

/// "; did you mean --min-distance?" if some of the words are like `text`, else empty.
std::string suggestion(const std::string& text, const std::vector<std::string>& words);

/// Accepts one of these words; the complaint about another lists them, with a suggestion.
CLI::Validator one_of(std::vector<std::string> words);

/// A line on what cannot be an option of the chosen command: its first unknown one, with a suggestion. Empty if there
/// is none.
std::string unknown_option(const CLI::App& app);

}  // namespace spawnfield::cli
