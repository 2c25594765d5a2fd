#pragma once

#include <string>
#include <vector>

namespace spawnfield::cli {

/// Returns the text that a shell reads as these words.
std::string shell_line(const std::vector<std::string>& words);

}  // namespace spawnfield::cli
