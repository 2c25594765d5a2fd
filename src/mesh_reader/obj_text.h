#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace spawnfield {

/// The text of a Wavefront OBJ file, rewritten so that assimp 5.2 reads it correctly.
struct ObjText {
    std::string text;
    std::vector<std::string> names;  ///< names of objects and groups, in the order of the file
};

/// Rewrites the text for assimp 5.2. Each line `o NAME` or `g NAME` gets a unique name unless it repeats the name
/// before it, because assimp adds the faces after an earlier name to the object before them, and ends an object's name
/// at its first blank. Coordinates that begin with a point get a 0 in front, because assimp does not read `.5` as a
/// number. Lines lose their indentation, because assimp ignores indented lines. Source: Wavefront, Advanced Visualizer
/// manual, appendix B1.
ObjText readable_obj(std::string text);

/// Returns the name in the file's `o` or `g` line for the node that assimp names `node`; `node` itself if it has none.
std::string obj_name(const ObjText& obj, const std::string& node);

}  // namespace spawnfield
