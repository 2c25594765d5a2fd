#include "scene/octomap_part.h"

#include "scene/octomap_file.h"
#include "scene/octomap_ground.h"
#include "scene/octomap_space.h"

#include <spawnfield/error.h>

#include <cmath>
#include <cstdio>

namespace spawnfield {
namespace {

void append_box(Scene& scene, std::uint32_t part, const Vec3& centre, const Vec3& size, const Pose& pose, Label label)
{
    Primitive primitive;
    primitive.shape.kind = ShapeKind::Box;
    primitive.shape.size = size;
    primitive.shape.pose = pose * Pose{centre, Mat3::Identity()};
    primitive.part = part;
    primitive.label = label;
    scene.primitives.push_back(primitive);
    ++scene.parts[part].solid_pieces;
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
    for (const VoxelBox& box : unknown_boxes(tree, extent)) {
        const Bounds bounds = bounds_of(tree, box);
        append_box(scene, part, (bounds.min + bounds.max) / 2, bounds.max - bounds.min, pose, Label::Obstacle);
    }
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
    for (auto leaf = tree->begin_leafs(), end = tree->end_leafs(); leaf != end; ++leaf) {
        if (!tree->isNodeOccupied(*leaf)) continue;
        const octomap::OcTreeKey key = leaf.getKey();
        Vec3 centre;
        for (int axis = 0; axis < 3; ++axis) centre[axis] = tree->keyToCoord(key[axis], leaf.getDepth());
        const Label label = !auto_slope           ? scene.parts[part].label
                            : is_ground[occupied] ? Label::Terrain
                                                  : Label::Obstacle;
        append_box(scene, part, centre, Vec3::Constant(tree->getNodeSize(leaf.getDepth())), pose, label);
        ++occupied;
    }
    if (scene.parts[part].solid_pieces == 0) throw FileError(file.string(), "has no occupied leaf, needs at least one");
    const VoxelBox extent = known_extent(*tree);
    if (unknown == Unknown::Blocked) append_unknown(scene, scene.parts[part].name, *tree, extent, pose);
    scene.notices.push_back(file.string() + ": " + unknown_notice(*tree, extent, unknown));
}

}  // namespace spawnfield
