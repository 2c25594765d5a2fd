#pragma once

#include <charconv>
#include <cstdio>
#include <string>
#include <string_view>

namespace spawnfield {

inline constexpr std::size_t number_room = 32;  // characters; a number has at most 24

/// Writes the shortest text that reads back to the same double. `to` has room for number_room characters. Returns the
/// end of the text.
inline char* write_number(char* to, double value) { return std::to_chars(to, to + number_room, value).ptr; }

/// Appends the same text.
inline void append_number(std::string& text, double value)
{
    char buffer[number_room];
    text.append(buffer, write_number(buffer, value));
}

/// Returns the shortest text that reads back to the same double.
inline std::string number(double value)
{
    std::string text;
    append_number(text, value);
    return text;
}

/// Returns a number with six digits, which are enough for readers.
inline std::string rounded(double value)
{
    char text[32];
    std::snprintf(text, sizeof text, "%.6g", value + 0.0);  // never -0
    return text;
}

/// Reads the whole text as a number. Returns false if any part of it is not a number; a single + in front is allowed.
inline bool parse_number(std::string_view text, double& value)
{
    if (text.size() > 1 && text.front() == '+' && text[1] != '-') text.remove_prefix(1);
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc{} && end == text.data() + text.size();
}

}  // namespace spawnfield
