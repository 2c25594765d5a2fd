#include "help_format.h"

#include <sstream>

namespace spawnfield::cli {

std::string HelpFormat::make_option_desc(const CLI::Option* option) const
{
    const std::size_t width = 120 - get_column_width();
    std::istringstream words(CLI::Formatter::make_option_desc(option));
    std::string out, line;
    for (std::string word; words >> word;) {
        if (!line.empty() && line.size() + 1 + word.size() > width) {
            out += line + "\n";
            line.clear();
        }
        line += (line.empty() ? "" : " ") + word;
    }
    return out + line;
}

std::string HelpFormat::make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const
{
    return CLI::detail::find_and_replace(CLI::Formatter::make_help(app, std::move(name), mode), "\n\n\n", "\n\n");
}

}  // namespace spawnfield::cli
