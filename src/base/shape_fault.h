#pragma once

#include <spawnfield/shape.h>

#include <string>

namespace spawnfield {

/// Returns why has_extent(shape) is false, for an error message: "is a box of -1 x 1 x 1 m, needs finite sizes > 0 m".
std::string shape_fault(const Shape& shape);

}  // namespace spawnfield
