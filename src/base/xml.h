#pragma once

#include <tinyxml2.h>

#include <filesystem>
#include <memory>
#include <string>

namespace spawnfield {

using Xml = tinyxml2::XMLElement;

/// A file that is XML and has a root element; elements may be nested 500 deep (tinyxml2's own limit). Throws FileError
/// with the line; `expected` says what an empty file lacks: "an <sdf> element".
std::unique_ptr<tinyxml2::XMLDocument> read_xml(const std::filesystem::path& file, const std::string& expected);

std::string text_of(const Xml& parent,
                    const char* name);    ///< of its first child of that name, trimmed; "" if there is none
std::string line_of(const Xml& element);  ///< "line 3: "
std::string attribute_of(const Xml& element, const char* name);  ///< "" if it has none
bool is_named(const Xml& element, const char* name);

/// `name` is null: every child.
template <class Visit>
void for_each_child(const Xml& parent, const char* name, const Visit& visit)
{
    for (const Xml* child = parent.FirstChildElement(name); child != nullptr; child = child->NextSiblingElement(name))
        visit(*child);
}

/// The element and all that is in it.
template <class Visit>
void for_each_element(const Xml& element, const Visit& visit)
{
    visit(element);
    for_each_child(element, nullptr, [&](const Xml& child) { for_each_element(child, visit); });
}

}  // namespace spawnfield
