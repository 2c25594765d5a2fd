#pragma once

#include "base/xml.h"

#include <string>

namespace spawnfield {

/// The numbers of all elements in the root: <unit>; float_array and its like against their counts and accessors; the
/// <p>, <vcount> and <h> of faces; the transforms of nodes. Colours do not matter. Throws FileError with line,
/// element, value and what it needs for numbers that are none, or too few or too many.
void check_collada_numbers(const Xml& root, const std::string& file);

}  // namespace spawnfield
