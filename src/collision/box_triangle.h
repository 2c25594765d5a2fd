#pragma once

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

}  // namespace spawnfield
