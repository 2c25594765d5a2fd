#pragma once

#include "model/sdf_includes.h"

#include <set>
#include <string>

namespace spawnfield {

/// Returns the text of the document without these elements. All other elements stay on their lines, so that line
/// numbers in messages about the text are those of the file.
std::string text_without(const tinyxml2::XMLDocument& document, const std::set<const Xml*>& removed);

}  // namespace spawnfield
