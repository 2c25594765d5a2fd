#pragma once

namespace spawnfield::cli {

/// The user pressed Ctrl-C; nothing was written.
struct Interrupted {};

/// From now on Ctrl-C, SIGTERM and a lost terminal (SIGHUP) are noticed by stop_if_interrupted(). A second signal ends
/// the program at once.
void catch_interrupts();

/// Returns whether one of these signals has arrived.
bool is_interrupted();

/// The work that was interrupted has ended, so that its result can be written: from now on, is_interrupted() is false.
void forget_interrupt();

/// Throws Interrupted if one of these signals has arrived.
void stop_if_interrupted();

}  // namespace spawnfield::cli
