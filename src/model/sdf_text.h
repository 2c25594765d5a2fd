#pragma once

#include "model/sdf_includes.h"

#include <set>
#include <string>

namespace spawnfield {

/// The document's text without these elements. What is left stays on its lines, so that complaints about the text name
/// those of the file.
std::string text_without(const tinyxml2::XMLDocument& document, const std::set<const Xml*>& gone);

}  // namespace spawnfield
