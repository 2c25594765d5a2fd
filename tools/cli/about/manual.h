#pragma once

#include "syntax.h"

#include <string>

namespace spawnfield::cli {

/// Returns the man page of the program, for groff and mandoc.
std::string manual(const CommandSyntax& program);

}  // namespace spawnfield::cli
