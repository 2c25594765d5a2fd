#include "scene/octomap_part.h"

#include "scene/octomap_file.h"

#include <spawnfield/error.h>

namespace spawnfield {

void append_octomap(Scene& scene, std::uint32_t part, const std::filesystem::path& file, const Pose& pose)
{
    const auto tree = read_octomap(file);
    for (auto leaf = tree->begin_leafs(), end = tree->end_leafs(); leaf != end; ++leaf) {
        if (!tree->isNodeOccupied(*leaf)) continue;
        Primitive primitive;
        primitive.shape.kind = ShapeKind::Box;
        primitive.shape.size = Vec3::Constant(tree->getNodeSize(leaf.getDepth()));
        const octomap::OcTreeKey key = leaf.getKey();
        Vec3 centre;
        for (int axis = 0; axis < 3; ++axis) centre[axis] = tree->keyToCoord(key[axis], leaf.getDepth());
        primitive.shape.pose = pose * Pose{centre, Mat3::Identity()};
        primitive.part = part;
        primitive.label = scene.parts[part].label;
        scene.primitives.push_back(primitive);
        ++scene.parts[part].solid_pieces;
    }
    if (scene.parts[part].solid_pieces == 0) throw FileError(file.string(), "has no occupied leaf, needs at least one");
}

}  // namespace spawnfield
