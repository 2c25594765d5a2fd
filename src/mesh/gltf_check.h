#pragma once

#include <string>
#include <string_view>

namespace spawnfield {

/// The JSON of a .glb, which both versions have at the same place, or the file itself. Throws FileError if it is cut
/// short.
std::string_view gltf_json(std::string_view bytes, const std::string& file);

/// Refuses glTF (text or binary, 1.0 or 2.0) that assimp reads without looking and would crash or grow without end.
/// Throws FileError with the place for text that is no JSON, or nested more than 200 deep; nodes that have two parents,
/// are below themselves, stand more than 500 deep, or are named and not there; scenes that begin with a node twice, or
/// with one that has a parent; primitives whose accessors come to more than 300 million vertices and corners. Source:
/// Khronos, glTF 2.0 specification, nodes and hierarchy: the nodes of a file are strict trees.
void check_gltf(std::string_view bytes, const std::string& file);

}  // namespace spawnfield
