#pragma once

#include <CLI/CLI.hpp>

namespace spawnfield::cli {

/// Throws ArgumentError if an output of the command would destroy one of its inputs, or another output: if both are the
/// same file, or if the output lies in a map that is read. Links are followed. Other files that an input names, such as
/// meshes, are not looked at.
void check_overwriting(const CLI::App& command);

}  // namespace spawnfield::cli
