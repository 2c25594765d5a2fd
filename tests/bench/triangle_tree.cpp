#include "triangle_tree.h"

#include "base/parallel.h"

#include <new>
#include <stdexcept>

using namespace spawnfield;

namespace bench {
namespace {

constexpr unsigned width = 4;  // children of a node
constexpr unsigned leaf_size = 4;
typedef float Four __attribute__((vector_size(16)));

/// Bounds of four children, side by side. Unused children have empty bounds.
struct Node {
    Four low[3], high[3];
    const void* children[width];  ///< the lowest bit of the address of a leaf is set
};

struct Leaf {
    std::uint32_t count;
    std::uint32_t triangles[leaf_size];
};

bool is_leaf(const void* child) { return (reinterpret_cast<std::uintptr_t>(child) & 1) != 0; }
const Leaf& leaf_at(const void* child)
{
    return *reinterpret_cast<const Leaf*>(reinterpret_cast<std::uintptr_t>(child) - 1);
}

void* create_node(RTCThreadLocalAllocator allocator, unsigned, void*)
{
    constexpr float infinite = std::numeric_limits<float>::infinity();
    Node* node = new (rtcThreadLocalAlloc(allocator, sizeof(Node), alignof(Node))) Node{};
    for (int axis = 0; axis < 3; ++axis) {
        node->low[axis] = Four{infinite, infinite, infinite, infinite};
        node->high[axis] = -node->low[axis];
    }
    return node;
}

void set_children(void* node, void** children, unsigned count, void*)
{
    for (unsigned i = 0; i < count; ++i) static_cast<Node*>(node)->children[i] = children[i];
}

void set_bounds(void* node, const RTCBounds** bounds, unsigned count, void*)
{
    auto& [low, high, children] = *static_cast<Node*>(node);
    for (unsigned i = 0; i < count; ++i) {
        low[0][i] = bounds[i]->lower_x, low[1][i] = bounds[i]->lower_y, low[2][i] = bounds[i]->lower_z;
        high[0][i] = bounds[i]->upper_x, high[1][i] = bounds[i]->upper_y, high[2][i] = bounds[i]->upper_z;
    }
}

void* create_leaf(RTCThreadLocalAllocator allocator, const RTCBuildPrimitive* primitives, std::size_t count, void*)
{
    Leaf* leaf = new (rtcThreadLocalAlloc(allocator, sizeof(Leaf), 16)) Leaf{};
    leaf->count = std::uint32_t(count);
    for (std::size_t i = 0; i < count; ++i) leaf->triangles[i] = primitives[i].primID;
    return reinterpret_cast<char*>(leaf) + 1;
}

struct Corners {
    Vec3f a, b, c;
};

Corners corners_of(const SharedTriangles& triangles, std::size_t number)
{
    const std::uint32_t* index = triangles.indices + 3 * number;
    const auto corner = [&](int i) -> Vec3f { return Eigen::Map<const Vec3f>(triangles.vertices + 3 * index[i]); };
    return {corner(0), corner(1), corner(2)};
}

std::vector<RTCBuildPrimitive> primitives_of(const SharedTriangles& triangles)
{
    constexpr std::size_t block = 4096;
    std::vector<RTCBuildPrimitive> out(triangles.count);
    parallel_for((out.size() + block - 1) / block, 0, {}, [&](std::size_t part) {
        for (std::size_t i = part * block; i < std::min(out.size(), (part + 1) * block); ++i) {
            const auto [a, b, c] = corners_of(triangles, i);
            const Vec3f low = a.cwiseMin(b).cwiseMin(c), high = a.cwiseMax(b).cwiseMax(c);
            out[i] = {low.x(), low.y(), low.z(), 0, high.x(), high.y(), high.z(), unsigned(i)};
        }
    });
    return out;
}

}  // namespace

TriangleTree::TriangleTree(RTCDevice device, const SharedTriangles& triangles)
    : triangles_(triangles), bvh_(rtcNewBVH(device))
{
    if (triangles.count == 0) return;
    std::vector<RTCBuildPrimitive> primitives = primitives_of(triangles);
    RTCBuildArguments args = rtcDefaultBuildArguments();
    args.bvh = bvh_;
    args.buildQuality = RTC_BUILD_QUALITY_MEDIUM;
    args.maxBranchingFactor = width;
    args.maxDepth = 64;
    args.sahBlockSize = leaf_size;
    args.maxLeafSize = leaf_size;
    args.primitives = primitives.data();
    args.primitiveCount = args.primitiveArrayCapacity = primitives.size();
    args.createNode = create_node;
    args.setNodeChildren = set_children;
    args.setNodeBounds = set_bounds;
    args.createLeaf = create_leaf;
    root_ = rtcBuildBVH(&args);
    if (root_ == nullptr) throw std::runtime_error("Embree cannot build a tree of the triangles");
}

bool TriangleTree::leaf_meets(const void* child, const TurnedBox& box) const
{
    const Leaf& leaf = leaf_at(child);
    for (std::uint32_t i = 0; i < leaf.count; ++i) {
        const auto [a, b, c] = corners_of(triangles_, leaf.triangles[i]);
        if (overlap(box, a, b, c)) return true;
    }
    return false;
}

bool TriangleTree::meets(const TurnedBox& box) const
{
    if (root_ == nullptr) return false;
    const Vec3f low = box.centre - box.reach(), high = box.centre + box.reach();
    const void* stack[3 * 64 + 1];
    std::size_t size = 0;
    stack[size++] = root_;
    while (size > 0) {
        const void* child = stack[--size];
        if (is_leaf(child)) {
            if (leaf_meets(child, box)) return true;
            continue;
        }
        const Node& node = *static_cast<const Node*>(child);
        const auto near = (node.low[0] <= high.x()) & (node.high[0] >= low.x()) & (node.low[1] <= high.y()) &
                          (node.high[1] >= low.y()) & (node.low[2] <= high.z()) & (node.high[2] >= low.z());
        for (unsigned i = 0; i < width; ++i)
            if (near[i]) stack[size++] = node.children[i];
    }
    return false;
}

}  // namespace bench
