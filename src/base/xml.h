#pragma once

#include <spawnfield/export.h>

#include <tinyxml2.h>

#include <filesystem>
#include <memory>
#include <string>

namespace spawnfield {

using Xml = tinyxml2::XMLElement;

/// Reads an XML file that has a root element. Elements may be nested 500 deep (tinyxml2's own limit). Throws FileError,
/// with the line. `expected` names what an empty file lacks, for example "an <sdf> element".
std::unique_ptr<tinyxml2::XMLDocument> read_xml(const std::filesystem::path& file, const std::string& expected);

/// Returns the trimmed text of the first child with this name; "" if there is none.
std::string text_of(const Xml& parent, const char* name);
std::string line_of(const Xml& element);                                               ///< "line 3: "
SPAWNFIELD_MODULE_API std::string attribute_of(const Xml& element, const char* name);  ///< "" if it is missing
SPAWNFIELD_MODULE_API bool is_named(const Xml& element, const char* name);

/// Calls visit(child) for each child element with this name, or for each child element if `name` is null.
template <class Visit>
void for_each_child(const Xml& parent, const char* name, const Visit& visit)
{
    for (const Xml* child = parent.FirstChildElement(name); child != nullptr; child = child->NextSiblingElement(name))
        visit(*child);
}

/// Calls visit(e) for the element itself and for each element within it, at any depth.
template <class Visit>
void for_each_element(const Xml& element, const Visit& visit)
{
    visit(element);
    for_each_child(element, nullptr, [&](const Xml& child) { for_each_element(child, visit); });
}

}  // namespace spawnfield
