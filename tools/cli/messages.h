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

/// Returns a callback that shows progress, unless --quiet was given. After Ctrl-C, the callback throws Interrupted,
/// unless the work looks for that itself.
Progress progress_bar(const CommonArgs& args, const std::string& label, bool throws = true);
void clear_progress_bar(const CommonArgs& args);

/// Throws Interrupted after Ctrl-C.
void stop_if_interrupted(const CommonArgs& args);

/// Returns a question for work that ends early after Ctrl-C.
StopRequest stop_request(const CommonArgs& args);

/// Ends work that stops early when it is interrupted, and returns whether it was. Throws Interrupted if it was, and has
/// found nothing. From now on, signals are noticed again: another one ends the writing, which leaves no part of a file.
bool end_interruptible_work(const CommonArgs& args, bool has_found);

}  // namespace spawnfield::cli
