#pragma once

namespace spawnfield::cli {

/// From now on Ctrl-C, SIGTERM and a lost terminal (SIGHUP) are noticed by progress_bar's callback; a second one ends
/// the program at once.
void catch_interrupts();
bool was_interrupted();

}  // namespace spawnfield::cli
