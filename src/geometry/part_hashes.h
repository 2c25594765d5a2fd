#pragma once

#include <spawnfield/scene.h>

#include <cstdint>
#include <vector>

namespace spawnfield {

/// Returns a hash (XXH64) of each part of a scene: of its name, kind, label and all its geometry. Parts with equal
/// hashes have the same geometry, in the same order, with the same labels. The place of the part in the scene does not
/// count. O(elements).
std::vector<std::uint64_t> hashes_of_parts(const Scene& scene, int threads);

}  // namespace spawnfield
