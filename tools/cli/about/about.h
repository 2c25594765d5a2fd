#pragma once

#include "command.h"

namespace spawnfield::cli {

/// Adds what the program says about itself: --version with the libraries, and the commands `completion` and `man`. All
/// other commands must be there. Only the program has these commands, not the Python package.
void add_about(CLI::App& app, ChosenCommand& chosen);

}  // namespace spawnfield::cli
