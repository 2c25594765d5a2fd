#include "program.h"

#include <spawnfield/types.h>

#include <catch2/catch.hpp>

#include <zlib.h>

#include <map>
#include <regex>
#include <sstream>

namespace {

using Words = std::vector<std::string>;

/// Returns the first group of each match of a regular expression.
Words all_matches(const std::string& text, const std::string& expression)
{
    const std::regex regex(expression);
    Words out;
    for (std::sregex_iterator match(text.begin(), text.end(), regex), end; match != end; ++match)
        out.push_back((*match)[1]);
    return out;
}

/// Returns the text between two texts, or nothing if they are not there.
std::string between(const std::string& text, const std::string& start, const std::string& end)
{
    const std::size_t from = text.find(start);
    return from == std::string::npos ? "" : text.substr(from, text.find(end, from + start.size()) - from);
}

/// Returns the names of the options of each command, as --help lists them. Those of the program have the name "".
std::map<std::string, Words> options_in_help(const TempFolder& folder)
{
    const auto options_of = [&](const std::string& command) {
        const std::string help = run_program(folder, command + " --help").out;
        Words out;
        for (const std::string& names : all_matches(help, "\n  (-[-,a-z]+)"))
            for (const std::string& name : all_matches(names, "([^,]+)")) out.push_back(name);
        return out;
    };
    const std::string help = run_program(folder, "--help").out;
    std::map<std::string, Words> out{{"", options_of("")}};
    for (const std::string& command : all_matches(between(help, "\nSubcommands:", "\n\n"), "\n  ([a-z]+)"))
        out[command] = options_of(command);
    return out;
}

std::string without_dashes(const std::string& option) { return option.substr(option.find_first_not_of('-')); }

}  // namespace

TEST_CASE("--version prints the version first, and then all libraries with their versions")
{
    const std::string text = run_program(TempFolder(), "--version").out;
    CHECK(text.starts_with(spawnfield::version() + "\n\n"));
    Words libraries;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        if (!line.starts_with("  ")) continue;
        CHECK(std::regex_match(line, std::regex("  [A-Za-z0-9-]+ [0-9]+\\.[0-9.]+( \\(package [^ ]+\\))?")));
        libraries.push_back(line.substr(2, line.find(' ', 2) - 2));
    }
    CHECK(libraries == Words{"libpng",  "oneTBB",      "qhull",    "xxHash",        "zlib",          "assimp",
                             "CLI11",   "cpp-httplib", "Eigen",    "FCL",           "libccd",        "libdeflate",
                             "libharu", "libsdformat", "libtiff",  "meshoptimizer", "nlohmann-json", "OctoMap",
                             "OpenCV",  "PROJ",        "tinyxml2", "urdfdom",       "yaml-cpp"});
    CHECK(text.find(std::string("  zlib ") + zlibVersion() + "\n") != std::string::npos);
}

TEST_CASE("completion scripts and the man page have every command and every option of --help")
{
    const TempFolder folder;
    const std::string bash = run_program(folder, "completion bash").out;
    const std::string zsh = run_program(folder, "completion zsh").out;
    const std::string fish = run_program(folder, "completion fish").out;
    std::string man = run_program(folder, "man").out;
    man = std::regex_replace(man, std::regex("\\\\-"), "-");
    const auto all = options_in_help(folder);
    CHECK(all.size() >= 14);
    CHECK(all.at("sample").size() > 60);
    for (const auto& [command, options] : all) {
        if (command.empty()) continue;
        const std::string in_bash = between(bash, "    " + command + ")\n", "\n      ;;"),
                          in_zsh = between(zsh, "_spawnfield_" + command + "() {", "\n}"),
                          in_man = between(man, ".SH \"spawnfield " + command + "\"\n", "\n.SH ");
        CHECK(fish.find(" -a " + command + " -d ") != std::string::npos);
        for (const std::string& option : options) {
            INFO(command << " " << option);
            CHECK(std::regex_search(in_bash, std::regex("options='[^']*" + option + "[ ']")));
            CHECK(std::regex_search(in_zsh, std::regex("\\)?\\*?" + option + "[=+]?\\[")));
            CHECK(in_man.find("\\fB" + option + "\\fR") != std::string::npos);
            const std::string in_fish = (option.starts_with("--") ? " -l " : " -s ") + without_dashes(option) + " ";
            CHECK(std::regex_search(fish, std::regex("__spawnfield_command_is " + command + "'[^\n]*" + in_fish)));
        }
    }
}

TEST_CASE("the scripts know choices that --help lists elsewhere, files, folders and options with two values")
{
    const TempFolder folder;
    const std::string bash = run_program(folder, "completion bash").out;
    const std::string sample = between(bash, "    sample)\n", "\n      ;;");
    CHECK(sample.find(" --format) kind='words:csv json ") != std::string::npos);
    CHECK(sample.find(" --drive) kind='words:differential omni legged car' count=1 ;;") != std::string::npos);
    CHECK(std::regex_search(sample, std::regex("[ |]--near[|)][^\n]* kind='other' count=2 ;;")));
    CHECK(std::regex_search(sample, std::regex("[ |]--fleet[|)][^\n]* kind='file' count=1 ;;")));
    CHECK(std::regex_search(sample, std::regex("[ |]--pairs[|)][^\n]* kind='other' count=1 ;;")));  // a number
    CHECK(sample.find("arguments=('folder')") != std::string::npos);
    const std::string check = between(bash, "    check)\n", "\n      ;;");
    CHECK(std::regex_search(check, std::regex("[ |]--pairs[|)][^\n]* kind='file' count=1 ;;")));
    const ProgramRun wrong = run_program(folder, "completion tcsh");
    CHECK(wrong.status == 2);
    CHECK(wrong.err.find("\"tcsh\" is not one of bash, zsh, fish") != std::string::npos);
}

TEST_CASE("completion and man print nothing but their text, and end with status 1 if it cannot be written")
{
    const TempFolder folder;
    for (const char* const command : {"completion bash", "completion zsh", "completion fish", "man"}) {
        const ProgramRun run = run_program(folder, command);
        CHECK(run.status == 0);
        CHECK(run.out.size() > 10000);
        CHECK(run.err.empty());
        CHECK(run_program(folder, std::string(command) + " >/dev/full").status == 1);
    }
}
