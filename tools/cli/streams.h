#pragma once

#include <CLI/CLI.hpp>

#include <string>

namespace spawnfield::cli {

/// Whether an option's value means standard input or output.
inline bool is_standard(const std::string& file) { return file == "-"; }

/// How messages name an input file.
inline std::string input_name(const std::string& file) { return is_standard(file) ? "standard input" : file; }

/// The name of a file that is written by name, for example a picture.
inline std::string output_name(const std::string& file) { return is_standard(file) ? "/dev/stdout" : file; }

/// All of standard input.
std::string read_standard_input();

/// Refuses `-` for an option that cannot take it, and two inputs or two outputs that are both `-`. Throws
/// ArgumentError.
void check_streams(const CLI::App& command);

}  // namespace spawnfield::cli
