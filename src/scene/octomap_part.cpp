#include "scene/octomap_part.h"

#include "scene/octomap_file.h"
#include "scene/octomap_ground.h"
#include "scene/octomap_space.h"

#include <spawnfield/error.h>

#include <cmath>
#include <cstdio>
#include <utility>
#include <vector>

namespace spawnfield {
namespace {

void append_boxes(Scene& scene, std::uint32_t part, const octomap::OcTree& tree, const std::vector<VoxelBox>& boxes,
                  const Pose& pose, Label label)
{
    for (const VoxelBox& box : boxes) {
        const Bounds bounds = bounds_of(tree, box);
        Primitive primitive;
        primitive.shape = box_shape(bounds.max - bounds.min,
                                    pose * Pose{(bounds.min + bounds.max) / 2, Mat3::Identity()});
        primitive.part = part;
        primitive.label = label;
        scene.primitives.push_back(primitive);
        ++scene.parts[part].solid_pieces;
    }
}

/// Returns the voxels of a leaf.
VoxelBox voxels_of(const octomap::OcTree& tree, const octomap::OcTree::leaf_iterator& leaf)
{
    const octomap::OcTreeKey low = leaf.getIndexKey();
    const std::uint32_t side = 1u << (tree.getTreeDepth() - leaf.getDepth());
    VoxelBox out;
    for (unsigned axis = 0; axis < 3; ++axis) {
        out.lo[axis] = low[axis];
        out.hi[axis] = low[axis] + side;
    }
    return out;
}

void append_unknown(Scene& scene, const std::string& name, const octomap::OcTree& tree, const VoxelBox& extent,
                    const Pose& pose)
{
    Part unknown;
    unknown.name = name + ":unknown";
    unknown.kind = "octomap";
    unknown.label = Label::Obstacle;
    scene.parts.push_back(std::move(unknown));
    const auto part = std::uint32_t(scene.parts.size() - 1);
    append_boxes(scene, part, tree, unknown_boxes(tree, extent), pose, Label::Obstacle);
}

std::string unknown_notice(const octomap::OcTree& tree, const VoxelBox& extent, Unknown unknown)
{
    const double voxel = tree.getResolution() * tree.getResolution() * tree.getResolution();
    const double all = extent.volume(), share = 1 - known_volume(tree) / all;
    char text[160];
    std::snprintf(text, sizeof text, "%.6g m3 of its %.6g m3 are unknown (%.1f %%) and ", share * all * voxel,
                  all * voxel, 100 * share);
    return text + std::string(unknown == Unknown::Blocked ? "are treated as solid"
                                                          : "are treated as free (--unknown blocked makes them solid)");
}

}  // namespace

void append_octomap(Scene& scene, std::uint32_t part, const std::filesystem::path& file, const Pose& pose,
                    Unknown unknown, std::optional<double> auto_slope)
{
    const auto tree = read_octomap(file);
    constexpr double upright = 1e-6;  // rad
    if (auto_slope && std::hypot(pose.rotation(0, 2), pose.rotation(1, 2)) > upright)
        throw FileError(file.string(),
                        "is tilted by the rpy of its part, so it cannot be labelled by slope; set roll and pitch to 0, "
                        "or give it a label");
    const std::vector<bool> is_ground = auto_slope ? ground_leaves(*tree, *auto_slope, file.string())
                                                   : std::vector<bool>();
    std::size_t occupied = 0;
    std::vector<VoxelBox> terrain, others;
    for (auto leaf = tree->begin_leafs(), end = tree->end_leafs(); leaf != end; ++leaf) {
        if (!tree->isNodeOccupied(*leaf)) continue;
        (auto_slope && is_ground[occupied] ? terrain : others).push_back(voxels_of(*tree, leaf));
        ++occupied;
    }
    if (occupied == 0) throw FileError(file.string(), "has no occupied leaf, needs at least one");
    append_boxes(scene, part, *tree, joined(std::move(terrain)), pose, Label::Terrain);
    append_boxes(scene, part, *tree, joined(std::move(others)), pose,
                 auto_slope ? Label::Obstacle : scene.parts[part].label);
    const VoxelBox extent = known_extent(*tree);
    if (unknown == Unknown::Blocked) append_unknown(scene, scene.parts[part].name, *tree, extent, pose);
    scene.notices.push_back(file.string() + ": " + unknown_notice(*tree, extent, unknown));
}

}  // namespace spawnfield
