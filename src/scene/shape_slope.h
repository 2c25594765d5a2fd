#pragma once

#include "mesh/mesh_file.h"

#include <spawnfield/shape.h>

#include <optional>

namespace spawnfield {

/// Returns the label of a whole shape by the slope of what it has on top, for --auto-label; nothing for a tilted box,
/// the faces of which need a label each (box_mesh).
///
/// Upright boxes are terrain: their top is level. A cylinder is terrain if its end is less steep than `max_slope`
/// (rad). Spheres, capsules and other cylinders are obstacles: they are round.
std::optional<Label> label_by_slope(const Shape& shape, double max_slope);

/// Returns the box as a closed mesh of twelve triangles in the box's own frame.
FileMesh box_mesh(const Vec3& size);

}  // namespace spawnfield
