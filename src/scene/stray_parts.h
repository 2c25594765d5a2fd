#pragma once

#include <spawnfield/scene.h>

#include <string>
#include <vector>

namespace spawnfield {

/// A part that is so far from all others that its position is most likely wrong.
struct StrayPart {
    std::string name;
    double distance = 0;  ///< m between its box and that of the rest
    double rest = 0;      ///< m: the diagonal of the box of the rest
};

/// Returns the parts that are more than 20 km from the rest, or more than 100 times the rest's diagonal (of at least
/// 1 m). The rest is what lies around the middle of all parts; infinite planes do not count. Order: the farthest first.
std::vector<StrayPart> stray_parts(const Scene& scene);

/// Returns what is wrong with these parts, in words.
std::string words_for(const std::vector<StrayPart>& parts);

}  // namespace spawnfield
