#pragma once

#include "common_args.h"

#include <CLI/CLI.hpp>

#include <array>
#include <string>

namespace spawnfield::cli {

/// All options whose value is the path of a file or a folder that is read. Some values can also be something else.
inline constexpr std::array input_options{"map",        "scene",   "what",    "--robot", "--robot-file", "--world",
                                          "--poses",    "--pairs", "--paths", "--avoid", "--spawns",     "--region",
                                          "--keep-out", "--rules", "--fleet", "--with"};

/// All options whose value is the path of a file or a folder to write. If it is `-`, the file goes to standard output.
inline constexpr std::array output_options{"--out", "--repaired", "--path", "--summary", "--heatmap", "--picture"};

/// Returns whether an option's value means standard input or output.
inline bool is_standard(const std::string& file) { return file == "-"; }

/// Returns the name of an input file for messages.
inline std::string input_name(const std::string& file) { return is_standard(file) ? "standard input" : file; }

/// Returns the name under which an output file can be opened, for example a picture.
inline std::string output_name(const std::string& file) { return is_standard(file) ? "/dev/stdout" : file; }

/// Copies the next bytes of standard input to a buffer of this size, and returns their number; 0: it has ended. Throws
/// FileError, and Interrupted after Ctrl-C, also while it waits.
std::size_t read_standard_input(const CommonArgs& args, char* to, std::size_t size);

/// Returns all bytes of standard input. Throws the same.
std::string read_standard_input(const CommonArgs& args);

/// Throws ArgumentError if `-` was given for an option that cannot use it, or for two inputs or two outputs.
void check_streams(const CLI::App& command);

}  // namespace spawnfield::cli
