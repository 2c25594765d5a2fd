#pragma once

#include "worlds/hand_scene.h"

#include <string>
#include <vector>

/// Functions that return small mesh files as text, for tests of the readers.
namespace mesh_text {

/// A node of a mesh file. Numbers are in the axes and the unit of the file.
struct Node {
    std::string name = "node", material = "material";
    hand::Mesh mesh = {};
    std::vector<double> matrix = {};  ///< 16 numbers, row after row; empty: no matrix
    std::vector<Node> children = {};  ///< ignored in OBJ and STL
};

std::string obj(const std::vector<Node>& nodes);  ///< `o` and `usemtl` for each node; ignores matrices and children
std::string obj(const hand::Mesh& mesh);
std::string stl(const hand::Mesh& mesh);

struct DaeOptions {
    std::string up = "Z_UP";  ///< "": the file has no up_axis
    double unit = 1;          ///< metres per unit
};
std::string dae(const std::vector<Node>& nodes, const DaeOptions& options = {});

std::string gltf(const std::vector<Node>& nodes);

/// The object of a 3MF package: a corner of a box of 4 x 2 x 1, with the number 1.
extern const std::string wedge_3mf;

/// Returns a 3MF package with these attributes of its <model> and these objects, and with another file.
std::string package_3mf(const std::string& attributes, const std::string& objects = wedge_3mf,
                        const std::string& extra = "");

/// Returns the box from one corner to the other.
hand::Mesh box(const spawnfield::Vec3& low, const spawnfield::Vec3& high);

}  // namespace mesh_text
