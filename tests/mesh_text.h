#pragma once

#include "worlds/hand_scene.h"

#include <string>
#include <vector>

/// Small mesh files as text, for readers to read.
namespace mesh_text {

/// What a node of a mesh file holds. Numbers are the file's own, in its own axes and unit.
struct Node {
    std::string name = "node", material = "material";
    hand::Mesh mesh = {};
    std::vector<double> matrix = {};  ///< 16 numbers, row after row; empty: none
    std::vector<Node> children = {};  ///< not in OBJ and STL
};

std::string obj(const std::vector<Node>& nodes);  ///< `o` and `usemtl` for each; matrices and children left aside
std::string obj(const hand::Mesh& mesh);
std::string stl(const hand::Mesh& mesh);

struct DaeOptions {
    std::string up = "Z_UP";  ///< "": the file says nothing
    double unit = 1;          ///< metres per unit
};
std::string dae(const std::vector<Node>& nodes, const DaeOptions& options = {});

std::string gltf(const std::vector<Node>& nodes);

/// The box from one corner to the other.
hand::Mesh box(const spawnfield::Vec3& low, const spawnfield::Vec3& high);

}  // namespace mesh_text
