#include "completion.h"

#include <algorithm>

namespace spawnfield::cli {
namespace {

using CLI::detail::join;

std::string header(const std::string& shell)
{
    return "# Completion of spawnfield for " + shell + ". `spawnfield completion " + shell + "` printed this file.\n";
}

std::vector<std::string> all_names(const std::vector<OptionSyntax>& options)
{
    std::vector<std::string> out;
    for (const OptionSyntax& option : options) out.insert(out.end(), option.names.begin(), option.names.end());
    return out;
}

// ---- bash ----

std::string bash_kind(const OptionSyntax& option)
{
    switch (option.kind) {
    case ValueKind::none: return "none";
    case ValueKind::choice: return "words:" + join(option.choices, " ");
    case ValueKind::file: return "file";
    case ValueKind::folder: return "folder";
    case ValueKind::other: break;
    }
    return "other";
}

/// Returns the lines of a `case` for the options that have values, those with equal results in one line.
std::string bash_options(const std::vector<OptionSyntax>& options)
{
    std::vector<std::pair<std::string, std::vector<std::string>>> results;
    for (const OptionSyntax& option : options) {
        if (option.kind == ValueKind::none) continue;
        const std::string result = "kind='" + bash_kind(option) + "' count=" + std::to_string(option.values);
        auto found = std::find_if(results.begin(), results.end(), [&](const auto& row) { return row.first == result; });
        if (found == results.end()) found = results.insert(results.end(), {result, {}});
        found->second.insert(found->second.end(), option.names.begin(), option.names.end());
    }
    std::string out;
    for (const auto& [result, names] : results) out += "        " + join(names, "|") + ") " + result + " ;;\n";
    return out;
}

/// Returns the branch of a `case` for one command.
std::string bash_command(const CommandSyntax& command, const std::string& name)
{
    std::string kinds;
    for (const OptionSyntax& argument : command.positionals)
        kinds += (kinds.empty() ? "'" : " '") + bash_kind(argument) + "'";
    return "    " + name + ")\n      options='" + join(all_names(command.options), " ") + "'\n      arguments=(" +
           kinds + ")\n      case $2 in\n" + bash_options(command.options) + "      esac\n      ;;\n";
}

constexpr const char* bash_function = R"END(
# Asks readline for files or folders. It also completes ~ and names with spaces.
_spawnfield_paths() {
  case $1 in
    file) compopt -o default ;;
    folder) compopt -o dirnames ;;
  esac
}

_spawnfield() {
  COMPREPLY=()
  # bash splits words at = and :, so the words of --format=csv and box:1,2,3 are joined again.
  local i glue= line=()
  for ((i = 1; i <= COMP_CWORD; i++)); do
    if [[ ${COMP_WORDS[i]} =~ ^[=:]+$ && ${#line[@]} -gt 0 ]]; then
      line[-1]+=${COMP_WORDS[i]} glue=1
    elif [[ $glue ]]; then
      line[-1]+=${COMP_WORDS[i]} glue=
    else
      line+=("${COMP_WORDS[i]}")
    fi
  done
  local current=${line[-1]} last=${COMP_WORDS[COMP_CWORD]}
  [[ $last =~ ^[=:]+$ ]] && last=

  local word command= position=0 left=0 wanted= kind count options arguments
  for word in "${line[@]:0:${#line[@]}-1}"; do
    if ((left > 0)); then
      left=$((left - 1)) wanted=other
    elif [[ $word == -* ]]; then
      _spawnfield_syntax "$command" "${word%%=*}"
      left=$count wanted=$kind
      [[ $word == *=* && $left -gt 0 ]] && left=$((left - 1)) wanted=other
    elif [[ -z $command ]]; then
      command=$word
    else
      position=$((position + 1))
    fi
  done

  local value=$current
  _spawnfield_syntax "$command" "${current%%=*}"
  if ((left > 0)); then
    kind=$wanted
  elif [[ $current == --*=* ]]; then
    value=${current#*=}
  elif [[ $current == -* ]]; then
    kind=words:$options
  else
    kind=${arguments[position]-none}
  fi
  _spawnfield_paths "$kind"
  if [[ $kind == words:* ]]; then
    local matches
    mapfile -t matches < <(compgen -W "${kind#words:}" -- "$value")
    COMPREPLY=("${matches[@]#"${value%"$last"}"}")
  fi
}

complete -F _spawnfield spawnfield
)END";

// ---- zsh ----

/// Returns how zsh's _arguments completes the values of an option.
std::string zsh_value(const OptionSyntax& option)
{
    const std::string message = ":" + with_backslashes(option.type, ":\\") + ":";
    switch (option.kind) {
    case ValueKind::none: return "";
    case ValueKind::choice: return ":value:(" + join(option.choices, " ") + ")";
    case ValueKind::file: return message + "_files";
    case ValueKind::folder: return message + "_files -/";
    case ValueKind::other: break;
    }
    std::string out;
    for (int i = 0; i < option.values; ++i) out += message + " ";
    return out;
}

/// Returns the words for zsh's _arguments that describe an option, one for each of its names.
std::string zsh_option(const OptionSyntax& option)
{
    const std::string excluded = option.is_repeatable ? "*" : "(" + join(option.names, " ") + ")";
    std::string out;
    for (const std::string& name : option.names) {
        const std::string joined = option.kind == ValueKind::none ? "" : name.starts_with("--") ? "=" : "+";
        out += " \\\n    " +
               quoted_for_sh(excluded + name + joined + "[" + with_backslashes(brief(option.description), "\\[]:") +
                             "]" + zsh_value(option));
    }
    return out;
}

/// Returns the function that completes one command.
std::string zsh_command(const CommandSyntax& command)
{
    std::string out = "\n_spawnfield_" + command.name + "() {\n  _arguments -s -S";
    for (const OptionSyntax& option : command.options) out += zsh_option(option);
    for (const OptionSyntax& argument : command.positionals) out += " \\\n    " + quoted_for_sh(zsh_value(argument));
    return out + "\n}\n";
}

// ---- fish ----

std::string quoted_for_fish(const std::string& text) { return "'" + with_backslashes(text, "\\'") + "'"; }

std::string fish_value(const OptionSyntax& option)
{
    switch (option.kind) {
    case ValueKind::none: return "";
    case ValueKind::choice: return " -x -a " + quoted_for_fish(join(option.choices, " "));
    case ValueKind::file: return " -r -F";
    case ValueKind::folder: return " -x -a '(__fish_complete_directories)'";
    case ValueKind::other: break;
    }
    return " -x";
}

/// Returns the lines for the options and arguments of a command, or of the program if `condition` says so.
std::string fish_command(const CommandSyntax& command, const std::string& condition)
{
    const std::string start = "complete -c spawnfield -n " + quoted_for_fish(condition);
    std::string out;
    for (const OptionSyntax& option : command.options) {
        out += start;
        for (const std::string& name : option.names)
            out += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
        out += fish_value(option) + " -d " + quoted_for_fish(brief(option.description)) + "\n";
    }
    for (const OptionSyntax& argument : command.positionals)
        if (argument.kind != ValueKind::other)
            out += start + CLI::detail::find_and_replace(fish_value(argument), " -x", "") + "\n";
    return out;
}

}  // namespace

std::string bash_completion(const CommandSyntax& program)
{
    std::vector<std::string> names;
    for (const CommandSyntax& command : program.commands) names.push_back(command.name);
    std::string out = header("bash") +
                      "\n# Sets `options` to the options of a command, `arguments` to the kinds of its arguments,\n"
                      "# and for one of its options `kind` to the kind and `count` to the number of its values.\n"
                      "_spawnfield_syntax() {\n  kind=none count=0 options= arguments=()\n  case $1 in\n";
    CommandSyntax start = program;
    start.positionals = {{.names = {"command"}, .kind = ValueKind::choice, .choices = names, .values = 1}};
    out += bash_command(start, "''");
    for (const CommandSyntax& command : program.commands) out += bash_command(command, command.name);
    return out + "  esac\n}\n" + bash_function;
}

std::string zsh_completion(const CommandSyntax& program)
{
    std::string out = "#compdef spawnfield\n" + header("zsh");
    for (const CommandSyntax& command : program.commands) out += zsh_command(command);
    out += "\n_spawnfield() {\n  local context state state_descr line\n  typeset -A opt_args\n  local -a commands=(\n";
    for (const CommandSyntax& command : program.commands)
        out += "    " + quoted_for_sh(command.name + ":" + with_backslashes(brief(command.description), "\\:")) + "\n";
    out += "  )\n  _arguments -s -S -C";
    for (const OptionSyntax& option : program.options) out += zsh_option(option);
    return out +
           " \\\n    ':command:->command' \\\n    '*::argument:->arguments'\n"
           "  case $state in\n"
           "    command) _describe -t commands command commands ;;\n"
           "    arguments) (( $+functions[_spawnfield_$words[1]] )) && _spawnfield_$words[1] ;;\n"
           "  esac\n}\n\n"
           "# As a file in fpath, this is the body of the function. `source` only defines the functions.\n"
           "if [[ ${funcstack[1]-} == _spawnfield ]]; then\n  _spawnfield \"$@\"\nelse\n"
           "  compdef _spawnfield spawnfield\nfi\n";
}

std::string fish_completion(const CommandSyntax& program)
{
    std::string out = header("fish") +
                      "\nfunction __spawnfield_command_is -d 'Whether the first argument is this command'\n"
                      "    set -l words (commandline -opc)\n"
                      "    test (count $words) -ge 2; and test $words[2] = $argv[1]\n"
                      "end\n\n"
                      "complete -c spawnfield -f\n";
    for (const CommandSyntax& command : program.commands)
        out += "complete -c spawnfield -n __fish_is_first_arg -a " + command.name + " -d " +
               quoted_for_fish(brief(command.description)) + "\n";
    out += fish_command(program, "__fish_is_first_arg");
    for (const CommandSyntax& command : program.commands)
        out += fish_command(command, "__spawnfield_command_is " + command.name);
    return out;
}

}  // namespace spawnfield::cli
