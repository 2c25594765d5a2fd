#pragma once

#include <string>
#include <vector>

namespace spawnfield {

/// Returns the words of a name in lower case: "retail", "shop", "floor", "01" for "RetailShopFloor_01".
///
/// A word is a sequence of ASCII letters, or of digits. Within letters a new word begins at a capital after a small
/// letter, and at the last of several capitals if a small letter follows: "HTMLFloor" is "html", "floor".
std::vector<std::string> words_of_name(const std::string& name);

}  // namespace spawnfield
