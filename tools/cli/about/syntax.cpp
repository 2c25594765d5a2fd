#include "syntax.h"

#include "spelling.h"
#include "streams.h"

#include <algorithm>
#include <array>

namespace spawnfield::cli {
namespace {

/// Positional arguments that are always folders.
constexpr std::array folder_arguments{"map", "folder"};

bool contains(const auto& names, const std::string& name)
{
    return std::find(names.begin(), names.end(), name) != names.end();
}

bool is_number(const std::string& type)
{
    return type.starts_with("INT") || type.starts_with("UINT") || type.starts_with("FLOAT");
}

ValueKind kind_of(const OptionSyntax& option, const std::string& type)
{
    if (option.values == 0) return ValueKind::none;
    if (!option.choices.empty()) return ValueKind::choice;
    if (is_number(type)) return ValueKind::other;
    const std::string& name = option.names.front();
    if (type == "TEXT:DIR" || contains(folder_arguments, name)) return ValueKind::folder;
    return contains(input_options, name) || contains(output_options, name) ? ValueKind::file : ValueKind::other;
}

/// Returns what stands for a value in help.
std::string type_for(const OptionSyntax& option, const std::string& type)
{
    constexpr std::size_t longest_list = 30;
    if (option.kind == ValueKind::none) return "";
    if (option.kind == ValueKind::file) return "FILE";
    if (option.kind == ValueKind::folder) return "FOLDER";
    const std::string list = CLI::detail::join(option.choices, "|");
    if (option.kind == ValueKind::choice) return list.size() > longest_list ? long_choice : list;
    return type.starts_with("FLOAT") ? "NUMBER" : is_number(type) ? "N" : type;
}

/// The set is ordered by addresses, so the names are sorted.
std::vector<std::string> names_of(const std::set<CLI::Option*>& options)
{
    std::vector<std::string> out;
    for (const CLI::Option* const option : options) out.push_back(option->get_name());
    std::sort(out.begin(), out.end());
    return out;
}

OptionSyntax syntax_of(CLI::Option& option)
{
    OptionSyntax out{.names = {},
                     .description = option.get_description(),
                     .group = option.get_group(),
                     .type = {},
                     .choices = choices_of(option),
                     .values = option.get_items_expected_max() == 0 ? 0 : std::max(1, option.get_items_expected_min()),
                     .is_required = option.get_required(),
                     .is_repeatable = option.get_expected_max() > 1,
                     .needs = names_of(option.get_needs()),
                     .excludes = names_of(option.get_excludes())};
    for (const std::string& name : option.get_lnames()) out.names.push_back("--" + name);
    for (const std::string& name : option.get_snames()) out.names.push_back("-" + name);
    if (out.names.empty()) out.names.push_back(option.get_name(true));
    const std::string type = option.get_type_name();
    out.kind = kind_of(out, type);
    out.type = type_for(out, type);
    return out;
}

}  // namespace

CommandSyntax syntax_of(CLI::App& app)
{
    CommandSyntax out{app.get_name(), app.get_description(), app.get_footer(), {}, {}, {}};
    for (CLI::Option* const option : app.get_options())
        (option->get_positional() ? out.positionals : out.options).push_back(syntax_of(*option));
    for (CLI::App* const command : app.get_subcommands([](const CLI::App*) { return true; }))
        out.commands.push_back(syntax_of(*command));
    return out;
}

std::string brief(const std::string& description)
{
    constexpr std::size_t least = 12, most = 80;  // "m. Radius" is one sentence with its unit
    std::size_t end = description.find('\n');
    for (const char* const stop : {". ", "; "}) end = std::min(end, description.find(stop, least));
    const std::string sentence = description.substr(0, end);
    if (sentence.size() <= most) return sentence;
    const std::string shorter = sentence.substr(0, sentence.rfind(' ', most - 3));
    return shorter.substr(0, shorter.find_last_not_of(" ,:(") + 1) + "...";
}

std::string with_backslashes(const std::string& text, const std::string& characters)
{
    std::string out;
    for (const char c : text) out += (characters.find(c) == std::string::npos ? "" : "\\") + std::string(1, c);
    return out;
}

std::string quoted_for_sh(const std::string& text)
{
    return "'" + CLI::detail::find_and_replace(text, "'", "'\\''") + "'";
}

}  // namespace spawnfield::cli
