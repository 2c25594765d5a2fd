#pragma once

#include "embree_rays.h"
#include "triangle_box.h"

namespace bench {

/// A tree of triangles for questions about boxes. Embree's builder makes it; the search is our own.
class TriangleTree {
public:
    /// The triangles must live as long as the tree.
    TriangleTree(RTCDevice device, const SharedTriangles& triangles);
    TriangleTree(const TriangleTree&) = delete;
    ~TriangleTree() { rtcReleaseBVH(bvh_); }

    bool meets(const TurnedBox& box) const;  ///< whether the box touches a triangle

private:
    bool leaf_meets(const void* leaf, const TurnedBox& box) const;

    SharedTriangles triangles_;
    RTCBVH bvh_;
    const void* root_ = nullptr;  ///< null without triangles
};

}  // namespace bench
