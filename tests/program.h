#pragma once

#include "temp_folder.h"

#include <csignal>
#include <functional>

/// The result of a run of the program.
struct ProgramRun {
    int status;  ///< status as in a shell: 128 + N for signal N
    std::string out, err;
};

/// Runs `spawnfield ARGUMENTS` in the folder, in a shell and without a terminal.
ProgramRun run_program(const TempFolder& folder, const std::string& arguments);

/// Does the same, but kills the program (status 137) after two minutes, many times what it needs: for inputs that could
/// make it wait for ever.
ProgramRun limited_program(const TempFolder& folder, const std::string& arguments);

/// Does the same with a terminal for standard error. Sends the signal when a progress bar with this text appears there,
/// so in the middle of the work on any machine. Kills the program if it shows no bar, or does not end, within a minute.
ProgramRun interrupt_program(const TempFolder& folder, const std::string& arguments, int signal = SIGINT,
                             const std::string& bar = " %");

/// Does the same, and sends SIGINT again as soon as is_time() is true.
ProgramRun interrupt_program_twice(const TempFolder& folder, const std::string& arguments,
                                   const std::function<bool()>& is_time);
