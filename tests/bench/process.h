#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace bench {

/// A run of a program from its start to its end.
struct ProcessRun {
    double seconds = 0;
    double cpu_seconds = 0;         ///< user and system time of all its threads
    std::uint64_t peak_memory = 0;  ///< bytes; never less than this process had when it started the program
    int status = 0;                 ///< exit status; -1 if a signal ended it
    std::string output;             ///< its standard output
};

/// Runs a program and waits for it. Its standard error is discarded.
ProcessRun run_process(const std::filesystem::path& program, const std::vector<std::string>& args);

std::filesystem::path this_program();

/// Returns the path of the spawnfield program beside this one; empty if it does not exist.
std::filesystem::path spawnfield_program();

}  // namespace bench
