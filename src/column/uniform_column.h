#pragma once

#include "base/rect.h"

#include <spawnfield/column.h>

#include <optional>

namespace spawnfield {

/// Returns the column that all points of a closed rectangle have; nothing if that is not certain. It is certain if
/// every element within 2 * touch_tolerance of the rectangle is a level triangle of a sheet and covers the whole
/// rectangle, or if there is no such element. Vertical sheets count as elements, although they have no spans:
/// SolidBounds and the OctoMap rely on it. Large parts of many worlds are level planes.
std::optional<Column> uniform_column(const Geometry& geometry, const Rect& rect);

}  // namespace spawnfield
