#pragma once

#include <string>

namespace tools {

/// Returns what is wrong with a seed, or an empty text; for CLI11's check(). CLI11's own check would wrap -1 to 2^64 -
/// 1, or print a range of 309 digits.
std::string seed_complaint(const std::string& text);

}  // namespace tools
