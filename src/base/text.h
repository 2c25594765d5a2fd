#pragma once

#include <algorithm>
#include <string>
#include <string_view>

namespace spawnfield {

/// Returns the text with ASCII capitals in lower case, in every locale. Other bytes do not change.
inline std::string lower_case(std::string_view text)
{
    std::string out(text);
    for (char& c : out)
        if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
    return out;
}

/// Returns the text without the white space at both ends.
inline std::string_view trimmed_view(std::string_view text)
{
    constexpr std::string_view space = " \t\r\n";
    const std::size_t first = text.find_first_not_of(space);
    return first == std::string_view::npos ? "" : text.substr(first, text.find_last_not_of(space) + 1 - first);
}

inline std::string trimmed(std::string_view text) { return std::string(trimmed_view(text)); }

/// Returns the text with each byte below 0x20 (line breaks, tabs) replaced by a space, so that it fits on one line.
inline std::string one_line(std::string text)
{
    std::replace_if(
        text.begin(), text.end(), [](unsigned char c) { return c < ' '; }, ' ');
    return text;
}

/// Returns a text with XML's special characters escaped, for elements and for attributes in double quotes. The text
/// must not contain control characters, which XML 1.0 does not allow (see one_line).
inline std::string xml_escaped(std::string_view text)
{
    std::string out;
    for (const char c : text) {
        if (c == '&')
            out += "&amp;";
        else if (c == '<')
            out += "&lt;";
        else if (c == '>')
            out += "&gt;";
        else if (c == '"')
            out += "&quot;";
        else
            out += c;
    }
    return out;
}

}  // namespace spawnfield
