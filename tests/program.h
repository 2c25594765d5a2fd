#pragma once

#include "temp_folder.h"

/// The result of a run of the program.
struct ProgramRun {
    int status;  ///< status as in a shell: 128 + N for signal N
    std::string out, err;
};

/// Runs `spawnfield ARGUMENTS` in the folder, in a shell and without a terminal.
ProgramRun run_program(const TempFolder& folder, const std::string& arguments);

/// Does the same, but sends the signal (Ctrl-C by default) after `seconds`, and kills the program half a minute later.
ProgramRun interrupt_program(const TempFolder& folder, const std::string& arguments, double seconds,
                             const std::string& signal = "INT");
