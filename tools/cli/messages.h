#pragma once

#include "common_args.h"

#include <spawnfield/types.h>

#include <string>
#include <vector>

namespace spawnfield::cli {

/// Prints a notice on standard error, unless --quiet was given.
void notice(const CommonArgs& args, const std::string& text);

/// Prints several notices; those of one kind are printed once, with a count (notices.h).
void notices(const CommonArgs& args, const std::vector<std::string>& texts);

/// Prints "spawnfield: MESSAGE" on standard error, also with --quiet: why the exit status is not 0.
void complain(const std::string& message);

/// Returns a callback that draws a bar if standard error is a terminal. After Ctrl-C, the callback throws Interrupted,
/// unless the work looks for that itself.
Progress progress_bar(const CommonArgs& args, const std::string& label, bool throws = true);
void clear_progress_bar();

}  // namespace spawnfield::cli
