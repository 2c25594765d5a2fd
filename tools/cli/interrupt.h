#pragma once

namespace spawnfield::cli {

/// The user pressed Ctrl-C; nothing was written.
struct Interrupted {};

/// From now on Ctrl-C, SIGTERM and a lost terminal (SIGHUP) are noticed by stop_if_interrupted(). A second signal of
/// the same kind ends the program at once.
void catch_interrupts();

/// Returns whether one of these signals has arrived.
bool is_interrupted();

/// Ends work that stops early when it is interrupted, and returns whether it was. Throws Interrupted if it was, and has
/// found nothing. From now on, signals are noticed again: another one ends the writing, which leaves no part of a file.
bool end_interruptible_work(bool has_found);

/// Throws Interrupted if one of these signals has arrived.
void stop_if_interrupted();

}  // namespace spawnfield::cli
