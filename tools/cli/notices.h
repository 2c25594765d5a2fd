#pragma once

#include <string>
#include <vector>

namespace spawnfield::cli {

/// Returns the notices, but with one text for all notices of one kind: the first of them, and a second line with the
/// number of the others and the things that they are about. Two notices are of one kind if they differ only in words
/// that are names, paths or numbers. The order is that of the first notice of each kind.
std::vector<std::string> grouped(const std::vector<std::string>& notices);

}  // namespace spawnfield::cli
