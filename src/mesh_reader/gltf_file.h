#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace spawnfield {

/// Facts from a glTF 2.0 file that assimp 5.2 does not report.
struct GltfFacts {
    std::size_t triangles = 0;         ///< of all meshes in the nodes of its scene, skins and animations
    std::vector<std::string> notices;  ///< each begins with the file name
};

/// Reads the JSON of a .gltf or .glb, but not its buffers. Returns empty facts for other glTF versions and for text
/// that is not JSON: assimp checks these.
///
/// Throws FileError for geometry that assimp 5.2 would read wrongly: a required extension that it does not know, except
/// those about appearance only (materials, textures, lights, metadata); instances by EXT_mesh_gpu_instancing, required
/// or not; positions that are not floats; skins with fewer matrices than joints, for which assimp would end the
/// program. Source: Khronos, glTF 2.0 specification, 3.12 (extensions), 3.7.3.1 (skins), 3.7.2.2 (morph targets).
GltfFacts examine_gltf(const std::filesystem::path& file);

}  // namespace spawnfield
