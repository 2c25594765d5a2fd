#pragma once

#include "base/xml.h"

#include <string>

namespace spawnfield {

/// Checks the numbers of all elements within the root: <unit>; <float_array>, <Name_array> and <IDREF_array> against
/// their counts and accessors; <p>, <vcount> and <h> of faces; the transforms of nodes. Colours are not checked. Throws
/// FileError with line, element, value and limit for a word that is not a number, and for too few or too many numbers.
void check_collada_numbers(const Xml& root, const std::string& file);

}  // namespace spawnfield
