#pragma once

#include "scene/model_paths.h"

#include <tinyxml2.h>

#include <map>
#include <memory>

namespace spawnfield {

/// SDF files as XML: for what libsdformat does not look at, or would not come back from.
using Xml = tinyxml2::XMLElement;

/// A file that is XML and says that it is SDF. Throws FileError with the line.
std::unique_ptr<tinyxml2::XMLDocument> read_sdf_xml(const std::filesystem::path& file);

std::string text_of(const Xml& parent, const char* name);  ///< of its first child of that name, trimmed; "" if there is none
std::string line_of(const Xml& element);                   ///< "line 3: "

/// `name` is null: every child.
template <class Visit>
void for_each_child(const Xml& parent, const char* name, const Visit& visit)
{
    for (const Xml* child = parent.FirstChildElement(name); child != nullptr; child = child->NextSiblingElement(name)) visit(*child);
}

/// The element and all that is in it.
template <class Visit>
void for_each_element(const Xml& element, const Visit& visit)
{
    visit(element);
    for_each_child(element, nullptr, [&](const Xml& child) { for_each_element(child, visit); });
}

/// The file that an <include> of this <uri> in a file of `folder` means; nothing if it is nowhere. Throws FileError for a folder
/// that is no model's.
std::filesystem::path included_file(const std::string& uri, const std::filesystem::path& folder, ModelPaths& paths);

/// Includes that lead nowhere, by URI: where the first stands ("FILE: line 3"), and how many there are.
using MissingIncludes = std::map<std::string, std::pair<std::string, std::size_t>>;

/// Looks at `document`, which is what the file holds, and at each file that it includes at any depth, once. Throws FileError for
/// numbers that are none, and with the circle for a file that includes itself: libsdformat would go on until memory ends.
MissingIncludes check_includes(const std::filesystem::path& file, const tinyxml2::XMLDocument& document, ModelPaths& paths);

}  // namespace spawnfield
