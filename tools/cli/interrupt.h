#pragma once

namespace spawnfield::cli {

/// The user pressed Ctrl-C; nothing was written.
struct Interrupted {};

/// From now on Ctrl-C, SIGTERM and a lost terminal (SIGHUP) are noticed by stop_if_interrupted(). A second signal ends
/// the program at once.
void catch_interrupts();

/// Throws Interrupted if one of these signals has arrived.
void stop_if_interrupted();

}  // namespace spawnfield::cli
