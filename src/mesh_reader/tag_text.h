#pragma once

#include <string>
#include <string_view>

// The text of XML tags, for files whose structure does not matter.
namespace spawnfield {

inline bool is_xml_space(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

/// Returns the name of the element, without a namespace prefix. `tag` is the text between < and >. The result lies in
/// it; it is empty for an end tag, a comment or an instruction.
inline std::string_view name_of_tag(std::string_view tag)
{
    std::string_view name = tag.substr(0, tag.find_first_of(" \t\r\n/>!?"));
    const std::size_t colon = name.find(':');
    return colon == std::string_view::npos ? name : name.substr(colon + 1);
}

/// Returns the value of an attribute. `element` is the text of an element after its name. Returns "" if the attribute
/// is missing.
std::string attribute(std::string_view element, std::string_view name);

}  // namespace spawnfield
