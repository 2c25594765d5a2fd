#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace spawnfield {

/// What a glTF 2.0 file says of its geometry that assimp 5.2 reads past.
struct GltfFacts {
    std::size_t triangles = 0;         ///< of all meshes that its scene, skins and animations lead to
    std::vector<std::string> notices;  ///< begin with the file
};

/// Reads the JSON of a .gltf or .glb, not its buffers; nothing of other versions and of what is no JSON: assimp judges
/// these.
///
/// Throws FileError for geometry that assimp 5.2 would read wrongly: a required extension that it does not know, unless
/// that is one about looks only (materials, textures, lights, metadata); instances of EXT_mesh_gpu_instancing, required
/// or not; positions that are no floats; skins without matrices, at which it ends the program. Source: Khronos,
/// glTF 2.0 specification, 3.12 (extensions), 3.7.3.1 (skins), 3.7.2.2 (morph targets).
GltfFacts examine_gltf(const std::filesystem::path& file);

}  // namespace spawnfield
