#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace spawnfield {

/// A Wavefront OBJ file in a spelling that assimp 5.2 reads as it is meant.
struct ObjText {
    std::string text;
    std::vector<std::string> names;  ///< of its objects and groups, in the order of the file
};

/// Lines `o NAME` and `g NAME` get a name of their own each: assimp gives faces that come under an earlier name to the
/// object before them, and ends the name of an object at its first blank. Coordinates that begin with a point get a 0
/// before it: assimp takes `.5` for no number. Lines lose their indent: assimp drops those that have one. Source:
/// Wavefront, Advanced Visualizer manual, appendix B1.
ObjText readable_obj(std::string text);

/// The name that `o` or `g` gave to the node that assimp calls `node`.
std::string obj_name(const ObjText& obj, const std::string& node);

}  // namespace spawnfield
