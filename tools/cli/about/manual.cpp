#include "manual.h"

#include <spawnfield/types.h>

#include <sstream>

namespace spawnfield::cli {
namespace {

/// Returns the text so that roff shows it as it is. ' and - must stay what a shell can read.
std::string escaped(const std::string& text)
{
    std::string out;
    for (const char c : CLI::detail::find_and_replace(text, "…", "...")) {
        if (c == '.' && (out.empty() || out.back() == '\n')) out += "\\&";  // not a request
        out += c == '\\'   ? "\\e"
               : c == '-'  ? "\\-"
               : c == '\'' ? "\\(aq"
               : c == '`'  ? "\\(ga"
               : c == '^'  ? "\\(ha"
               : c == '~'  ? "\\(ti"
               : c == '"'  ? "\\(dq"
                           : std::string(1, c);
    }
    return out;
}

std::string bold(const std::string& text) { return "\\fB" + escaped(text) + "\\fR"; }
std::string italic(const std::string& text) { return "\\fI" + escaped(text) + "\\fR"; }

std::string section(const std::string& title) { return ".SH \"" + escaped(title) + "\"\n"; }

/// Returns "a", "a, b".
std::string bold_list(const std::vector<std::string>& names)
{
    std::string out;
    for (const std::string& name : names) out += (out.empty() ? "" : ", ") + bold(name);
    return out;
}

/// Returns the escaped text in lines of the source. As is usual, a sentence begins a new line, and no line is long.
std::string filled(const std::string& text)
{
    constexpr std::size_t most = 79;
    std::istringstream words(text);
    std::string out, line;
    for (std::string word; words >> word;) {
        const bool begins_sentence = line.ends_with('.') || line.ends_with('?');
        word = escaped(word);
        if (!line.empty() && (begins_sentence || line.size() + 1 + word.size() > most)) {
            out += line + "\n";
            line.clear();
        }
        line += (line.empty() ? "" : " ") + word;
    }
    return out + line + "\n";
}

std::string sentence(const std::string& text) { return filled(text.ends_with('.') ? text : text + "."); }

std::string entry(const OptionSyntax& option, bool is_positional)
{
    std::string out = ".TP\n" + (is_positional ? italic(option.names.front()) : bold_list(option.names));
    if (!is_positional && option.kind != ValueKind::none) out += " " + italic(option.type);
    if (is_positional && option.kind == ValueKind::choice) out += " (" + escaped(option.type) + ")";
    out += "\n" + sentence(option.description);
    if (option.kind == ValueKind::choice && option.type == long_choice)
        out += filled("One of " + CLI::detail::join(option.choices, ", ") + ".");
    if (option.is_required && !is_positional) out += "Required.\n";
    if (!option.needs.empty()) out += "Needs " + bold_list(option.needs) + ".\n";
    if (!option.excludes.empty()) out += "Cannot be combined with " + bold_list(option.excludes) + ".\n";
    return out;
}

/// Returns the entries of all options; each group of --help has a heading.
std::string entries(const CommandSyntax& command)
{
    std::string out, group = "Options";
    for (const OptionSyntax& argument : command.positionals) out += entry(argument, true);
    for (const OptionSyntax& option : command.options) {
        if (option.group != group) out += ".SS \"" + escaped(option.group) + "\"\n";
        group = option.group;
        out += entry(option, false);
    }
    return out;
}

/// Returns text that keeps its lines: the examples at the end of --help, and lists. Their headings are paragraphs.
std::string preformatted(const std::string& text)
{
    std::istringstream lines(text);
    std::string out;
    bool is_open = false;
    for (std::string line; std::getline(lines, line);) {
        const bool is_heading = !line.starts_with(' ');
        if (is_open && is_heading) out += ".EE\n.RE\n";
        if (!is_open && !is_heading) out += ".RS 4\n.EX\n";
        is_open = !is_heading;
        if (line.empty()) continue;
        out += (is_heading ? ".PP\n" + escaped(line) : escaped(line.substr(line.find_first_not_of(' ')))) + "\n";
    }
    return out + (is_open ? ".EE\n.RE\n" : "");
}

std::string usage(const CommandSyntax& command)
{
    std::string out = bold("spawnfield " + command.name);
    for (const OptionSyntax& argument : command.positionals) out += " " + italic(argument.names.front());
    for (const OptionSyntax& option : command.options)
        if (option.is_required) out += " " + bold(option.names.front()) + " " + italic(option.type);
    return out + " [" + italic("options") + "]\n";
}

std::string command_section(const CommandSyntax& command)
{
    return section("spawnfield " + command.name) + sentence(command.description) + ".PP\n" + usage(command) +
           entries(command) + (command.footer.empty() ? "" : preformatted(command.footer));
}

constexpr const char* end_of_manual = R"END(.SH "EXIT STATUS"
.TP
.B 0
Done.
.TP
.B 1
Failure, for example a full disk.
.TP
.B 2
Wrong usage: an option, a value, or options that do not go together.
.TP
.B 3
Fewer spawns or robots than wanted (those found are written), a pose that is not
valid (\fBcheck \-\-require\-valid\fR), or a rule that is broken
(\fBaudit \-\-rules\fR).
.TP
.B 4
Input refused: a map, scene, robot or file of poses.
.TP
.B 130
Interrupted.
.SH "ENVIRONMENT"
.TP
.BR GZ_SIM_RESOURCE_PATH ", " IGN_GAZEBO_RESOURCE_PATH ", " GAZEBO_MODEL_PATH
Folders with models, with colons between them.
They are searched after those of \fB\-\-model\-path\fR.
.SH "FILES"
.TP
.I PREFIX/share/spawnfield/maps
Worlds and robots to try.
.TP
.I PREFIX/share/doc/spawnfield/spawnfield.cdx.json
The libraries of this installation: a software bill of materials (CycloneDX).
)END";

}  // namespace

std::string manual(const CommandSyntax& program)
{
    std::string out = ".\\\" `spawnfield man` printed this file.\n.TH SPAWNFIELD 1 " SPAWNFIELD_DATE " \"spawnfield " +
                      version() +
                      "\" \"User Commands\"\n"
                      ".SH \"NAME\"\nspawnfield \\- where a robot can stand in a 3D world\n"
                      ".SH \"SYNOPSIS\"\n" +
                      bold("spawnfield") + " " + italic("command") + " [" + italic("options") +
                      "]\n"
                      ".SH \"DESCRIPTION\"\n"
                      "spawnfield reads a scene and a robot, and gives start poses at which the robot\n"
                      "stands on the ground, a verdict with its reason for any pose, the verdicts of a\n"
                      "complete raster, and pictures of these.\n"
                      "\\fBspawnfield bake\\fR makes a map from a scene.\n"
                      "Most other commands answer questions about a map and a robot.\n" +
                      entries(program) + preformatted(program.footer) + section("COMMANDS");
    for (const CommandSyntax& command : program.commands)
        out += ".TP\n" + bold(command.name) + "\n" + sentence(command.description);
    for (const CommandSyntax& command : program.commands) out += command_section(command);
    return out + end_of_manual;
}

}  // namespace spawnfield::cli
