#pragma once

#include "temp_folder.h"

/// The real program, run by tests.
struct ProgramRun {
    int status;  ///< as a shell tells it: 128 + N for signal N
    std::string out, err;
};

/// `spawnfield ARGUMENTS` in the folder, by a shell, without a terminal.
ProgramRun run_program(const TempFolder& folder, const std::string& arguments);

/// The same; the signal (Ctrl-C) comes after `seconds`, and a hard end half a minute later.
ProgramRun interrupt_program(const TempFolder& folder, const std::string& arguments, double seconds,
                             const std::string& signal = "INT");
