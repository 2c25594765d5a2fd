#include "spelling.h"

#include "command.h"
#include "common_args.h"

#include <algorithm>
#include <numeric>

namespace spawnfield::cli {
namespace {

/// Returns the smallest number of letters to insert, delete, replace or swap with their neighbour (Damerau: optimal
/// string alignment).
std::size_t edit_distance(const std::string& a, const std::string& b)
{
    std::vector<std::size_t> before, last(b.size() + 1), row(b.size() + 1);
    std::iota(last.begin(), last.end(), std::size_t(0));
    for (std::size_t i = 1; i <= a.size(); ++i) {
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] != b[j - 1])});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                row[j] = std::min(row[j], before[j - 2] + 1);
        }
        before = std::exchange(last, row);
    }
    return last.back();
}

std::vector<std::string> words_that(const std::vector<std::string>& words,
                                    const std::function<bool(const std::string&)>& test)
{
    std::vector<std::string> out;
    std::copy_if(words.begin(), words.end(), std::back_inserter(out), test);
    return out;
}

/// Returns the words that begin or end with the text (`--distance-to` and `--min-distance` for `--distance`) if one
/// begins with it. Otherwise, returns those nearest to it, or else those that contain it. A word that ends with it is
/// nearer than one with two other letters.
std::vector<std::string> likely(const std::string& text, const std::vector<std::string>& words)
{
    const std::string core = text.substr(std::min(text.find_first_not_of('-'), text.size()));
    const auto begins = [&](const std::string& word) { return word.starts_with(text); };
    const auto ends = [&](const std::string& word) { return core.size() > 3 && word.ends_with('-' + core); };
    if (core.size() > 1 && std::any_of(words.begin(), words.end(), begins))
        return words_that(words, [&](const std::string& word) { return begins(word) || ends(word); });
    std::size_t nearest = 1 + core.size() / 4;
    for (const std::string& word : words) nearest = std::min(nearest, edit_distance(text, word));
    if (nearest > 1)
        if (auto longer = words_that(words, ends); !longer.empty()) return longer;
    const auto near = words_that(words, [&](const std::string& word) {
        return word.size() > nearest + 1 && edit_distance(text, word) == nearest;
    });
    if (!near.empty() || core.size() < 4) return near;
    return words_that(words, [&](const std::string& word) { return word.find(core) != std::string::npos; });
}

/// Returns "a", "a or b", "a, b or c".
std::string choice_of(const std::vector<std::string>& words, const std::string& last = "or")
{
    std::string out;
    for (std::size_t i = 0; i < words.size(); ++i)
        out += (i == 0 ? "" : i + 1 == words.size() ? " " + last + " " : ", ") + words[i];
    return out;
}

/// Begins the name of each validator that one_of() makes; the words follow, with commas between them. Help does not
/// show the name, so it remains if an option has no list of words in its help.
const std::string name_of_choice = "one of ";

std::vector<std::string> option_names(const CLI::App& command)
{
    std::vector<std::string> names;
    for (const CLI::Option* const option : command.get_options()) {
        for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
        for (const std::string& name : option->get_snames()) names.push_back("-" + name);
    }
    return names;
}

/// If a command lacks an option about robots at rest, returns which commands have it. Else returns an empty text.
std::string where_robots_settle(const std::string& option)
{
    CLI::App all;
    ChosenCommand none;
    add_commands(all, "", none);
    std::vector<std::string> commands;
    for (const CLI::App* const command : all.get_subcommands({}))
        if (const CLI::Option* const found = command->get_option_no_throw(option);
            found != nullptr && found->get_group() == help_group::rest)
            commands.push_back(command->get_name());
    if (commands.empty()) return "";
    return "; settled robots are only for " + choice_of(commands, "and");
}

}  // namespace

std::string suggestion(const std::string& text, const std::vector<std::string>& words)
{
    constexpr std::size_t most = 4;
    std::vector<std::string> found = likely(text, words);
    const std::string other = "--region";  // what `sample` calls the --bounds of other commands
    if (found.empty() && text == "--bounds" && std::find(words.begin(), words.end(), other) != words.end())
        found = {other};
    return found.empty() || found.size() > most ? "" : "; did you mean " + choice_of(found) + "?";
}

CLI::Validator one_of(std::vector<std::string> words)
{
    const std::string list = CLI::detail::join(words, ",");
    return {[words = std::move(words)](const std::string& text) {
                if (std::find(words.begin(), words.end(), text) != words.end()) return std::string();
                return "\"" + text + "\" is not one of " + CLI::detail::join(words, ", ") + suggestion(text, words);
            },
            "{" + list + "}", name_of_choice + list};
}

std::vector<std::string> choices_of(CLI::Option& option)
{
    try {
        for (int i = 0;; ++i)
            if (const std::string& name = option.get_validator(i)->get_name(); name.starts_with(name_of_choice))
                return CLI::detail::split(name.substr(name_of_choice.size()), ',');
    } catch (const CLI::OptionNotFound&) {  // there are only i validators
        return {};
    }
}

std::string unknown_option(const CLI::App& app)
{
    const auto chosen = app.get_subcommands();
    const CLI::App& command = chosen.empty() ? app : *chosen.back();
    for (const std::string& text : command.remaining(true)) {
        if (text.size() < 2 || text[0] != '-') continue;
        const std::string name = text.substr(0, text.find('='));
        const std::string settling = where_robots_settle(name);
        return name + " is not an option of " + command.get_name() +
               (settling.empty() ? suggestion(name, option_names(command)) : settling);
    }
    return "";
}

}  // namespace spawnfield::cli
