#pragma once

#include "mesh/mesh_file.h"

#include <assimp/Importer.hpp>
#include <assimp/scene.h>

#include <cstdint>
#include <filesystem>
#include <string>

namespace spawnfield {

/// Largest number of triangles, counted once for each instance of a mesh.
inline constexpr std::uint64_t most_triangles = 100000000;

/// Prepares the import of a file before assimp reads it. assimp does not check its input. So this function refuses
/// damaged and malicious files; the error names the place in the file. It also parses PLY files: it replaces all
/// loaders of `importer` by one that passes the parsed vertices and faces to assimp. Returns the text that assimp
/// should read instead of the file, or "" if it can read the file itself. Throws FileError.
std::string prepare_import(const std::filesystem::path& file, MeshFormats formats, Assimp::Importer& importer);

/// Checks what assimp has read, before assimp's further steps, which do not check it: each face has corners, and these
/// are vertices of its mesh; nodes are at most 1000 deep; all instances of meshes together have at most 100 million
/// triangles, or the number in the file if that is larger. Throws FileError.
void check_imported_scene(const aiScene& scene, const std::string& file);

}  // namespace spawnfield
