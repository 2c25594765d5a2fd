#pragma once

#include <assimp/Importer.hpp>
#include <assimp/scene.h>

#include <filesystem>
#include <string>

namespace spawnfield {

/// What stands between a mesh file that is damaged or made to harm and assimp, which reads such files without looking.

/// Before assimp reads: what it would not survive is refused, with the place in the file. A PLY file is read here and
/// handed to the importer, which then has its vertices and faces whatever it would have made of the file. Returns the
/// text that assimp is to read in place of the file's, empty if that is the file's own. Throws FileError.
std::string check_mesh_file(const std::filesystem::path& file, Assimp::Importer& importer);

/// What assimp read, before its other steps, which trust it: faces have corners, and these are vertices; nodes are at
/// most 1000 deep and repeat meshes to at most 100 million triangles (or what the file itself has, if that is more).
/// Throws FileError.
void check_mesh_scene(const aiScene& scene, const std::string& file);

}  // namespace spawnfield
