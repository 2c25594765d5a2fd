#pragma once

#include <CLI/CLI.hpp>

#include <string>

namespace spawnfield::cli {

/// --help in lines of at most 120 columns, with one empty line between the groups of options.
class HelpFormat : public CLI::Formatter {
public:
    std::string make_option_desc(const CLI::Option* option) const override;
    std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override;
};

}  // namespace spawnfield::cli
