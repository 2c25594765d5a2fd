#pragma once

#include <spawnfield/shape.h>

#include <string>

namespace spawnfield {

/// Returns why has_extent(shape) is false, for an error message after the name of the shape: "is a box of -1 x 1 x 1 m,
/// needs finite sizes > 0 m". The shape must not be a hull. Defined in shape.cpp.
std::string shape_fault(const Shape& shape);

}  // namespace spawnfield
