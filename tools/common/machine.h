#pragma once

#include <string>

namespace tools {

/// Returns text such as "spawnfield 0.2.0 on <CPU>, 2 cores".
std::string machine();

/// Returns the text after `key` and the colon in a file under /proc; empty if the key is not there.
std::string proc_value(const char* file, const std::string& key);

/// Returns what printf would print, up to 1023 characters.
std::string formatted(const char* format, ...) __attribute__((format(printf, 1, 2)));

}  // namespace tools
