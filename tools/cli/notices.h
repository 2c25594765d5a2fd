#pragma once

#include <string>
#include <vector>

namespace spawnfield::cli {

/// Returns the notices with those of one kind as one text: the first of them, and in a second line how many more
/// there are and what they are about. Two notices are of one kind if they differ only in words that are names, paths
/// or numbers. In the order of the first of each.
std::vector<std::string> grouped(const std::vector<std::string>& notices);

}  // namespace spawnfield::cli
