#pragma once

#include <string>

namespace tools {

/// "spawnfield 0.2.0 on <CPU>, 2 cores".
std::string machine();

/// What follows `key` on its line of a file under /proc, without the colon; empty if there is none.
std::string proc_value(const char* file, const std::string& key);

/// printf into a string of up to 1023 characters.
std::string formatted(const char* format, ...) __attribute__((format(printf, 1, 2)));

}  // namespace tools
