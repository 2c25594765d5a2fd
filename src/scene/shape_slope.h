#pragma once

#include "mesh/mesh_file.h"

#include <spawnfield/shape.h>

#include <optional>

namespace spawnfield {

/// Returns the label of a whole shape for --auto-label, from the slope of its top; empty for a tilted box, whose faces
/// need labels of their own (box_mesh).
///
/// Upright boxes are terrain, because their top is level. A cylinder is terrain if its end is less steep than
/// `max_slope` (rad). Spheres, capsules and other cylinders are obstacles, because they are round.
std::optional<Label> label_by_slope(const Shape& shape, double max_slope);

/// Returns the box as a closed mesh of twelve triangles in the box's own frame.
FileMesh box_mesh(const Vec3& size);

}  // namespace spawnfield
