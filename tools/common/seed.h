#pragma once

#include <string>

namespace tools {

/// For CLI11's check(): empty if the text is a seed, else what is wrong with it. CLI11 itself wraps -1 round, or speaks
/// of a range of 309 digits.
std::string seed_complaint(const std::string& text);

}  // namespace tools
