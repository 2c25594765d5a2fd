#pragma once

#include "base/rect.h"

#include <spawnfield/column.h>

#include <optional>

namespace spawnfield {

/// Returns the column of all points of a closed rectangle if they certainly have the same one: each element that
/// reaches within 2 * touch_tolerance of the rectangle is a level triangle of a sheet that covers all of it, or there
/// is none. Large parts of many worlds are level planes.
std::optional<Column> uniform_column(const Geometry& geometry, const Rect& rect);

}  // namespace spawnfield
