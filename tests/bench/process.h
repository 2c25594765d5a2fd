#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace bench {

/// A program's run from its start to its end.
struct ProcessRun {
    double seconds = 0;
    std::uint64_t peak_memory = 0;  ///< bytes; never less than this process had when it started the program
    int status = 0;                 ///< what it exited with; -1 if it ended by a signal
    std::string output;             ///< its standard output
};

/// Runs a program and waits for it. What it says on standard error is dropped.
ProcessRun run_process(const std::filesystem::path& program, const std::vector<std::string>& args);

std::filesystem::path this_program();

/// The spawnfield program beside this one; empty if it is not there.
std::filesystem::path spawnfield_program();

}  // namespace bench
