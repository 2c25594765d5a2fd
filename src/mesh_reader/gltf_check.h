#pragma once

#include <string>
#include <string_view>

namespace spawnfield {

/// Returns the JSON of a .glb, which is at the same place in both versions, or all bytes of any other file. Throws
/// FileError if the JSON is cut short.
std::string_view gltf_json(std::string_view bytes, const std::string& file);

/// Checks a glTF file (text or binary, 1.0 or 2.0) before assimp reads it, because assimp does not check files and
/// would crash or use ever more memory. Throws FileError with the place for: text that is not JSON, or is nested more
/// than 200 deep; nodes that have two parents, are below themselves, are nested more than 500 deep, or are named but do
/// not exist; scenes that list a node twice, or a node that has a parent; primitives whose accessors have more than 300
/// million vertices and corners in total. Source: Khronos, glTF 2.0 specification, nodes and hierarchy: the nodes of a
/// file are strict trees.
void check_gltf(std::string_view bytes, const std::string& file);

}  // namespace spawnfield
