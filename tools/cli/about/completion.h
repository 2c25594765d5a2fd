#pragma once

#include "syntax.h"

#include <string>

namespace spawnfield::cli {

/// Each returns a script that makes the shell complete the commands, options and values of the program.
std::string bash_completion(const CommandSyntax& program);
std::string zsh_completion(const CommandSyntax& program);
std::string fish_completion(const CommandSyntax& program);

}  // namespace spawnfield::cli
