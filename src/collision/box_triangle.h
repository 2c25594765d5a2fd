#pragma once

#include "base/four.h"

#include <spawnfield/types.h>

#include <array>

namespace spawnfield {

/// What the separating axis test proves about a box and a triangle.
enum class AxisTest {
    Apart,    ///< more than FreeSpace::margin lies between them
    Overlap,  ///< they overlap by more than twice FreeSpace::margin in every direction
    Unclear   ///< neither is proven
};

/// Compares the box -half .. half with a triangle whose corners are in the box's frame, m. The source is the separating
/// axis theorem: Akenine-Möller, Fast 3D triangle-box overlap testing, Journal of Graphics Tools 6 (2001). The 13 axes
/// are the normals of the box, the normal of the triangle, and the cross products of their edges.
AxisTest axis_test(const Vec3& half, const std::array<Vec3, 3>& corners);

/// A box as FourTriangles needs it: all numbers four times.
class FourBoxes {
public:
    /// A box with these half lengths along its own axes, m, > 0. Its pose is that of its centre, relative to the origin
    /// of the triangles.
    FourBoxes(const Vec3& half, const Pose& pose);

private:
    friend class FourTriangles;
    using Three = std::array<Four, 3>;

    Three half_;                 ///< m
    std::array<Three, 3> axes_;  ///< of the box, one after the other
    Three centre_;               ///< along these axes, m
    bool is_upright_;            ///< its third axis is z
    Four size_;                  ///< no coordinate of the box is larger, m
};

/// Four triangles that are compared with boxes by axis_test(), all at once and in single floats. So the cases that it
/// proves are a little farther from contact.
class FourTriangles {
public:
    static constexpr std::uint32_t width = 4;

    /// The corners of each triangle, m, are seen from `origin`, which should be near them.
    FourTriangles(const std::array<std::array<const Vec3*, 3>, width>& corners, const Vec3& origin);

    /// A bit for each triangle, as in AxisTest. Those without a bit are unclear.
    struct Marks {
        std::uint32_t apart, overlap;
    };
    Marks compare(const FourBoxes& box) const;

private:
    using Three = FourBoxes::Three;

    std::array<Three, 3> seen_from(const FourBoxes& box) const;

    std::array<Three, 3> corners_;
    Four size_;  ///< no distance of a corner from the origin is larger, m
};

}  // namespace spawnfield
