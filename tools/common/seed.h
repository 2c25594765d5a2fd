#pragma once

#include <string>

namespace tools {

/// Returns what is wrong with a seed, or an empty text if nothing is. For CLI11's check(): CLI11's own checks would
/// accept -1 as 18446744073709551615, or print a range of 309 digits.
std::string seed_complaint(const std::string& text);

}  // namespace tools
