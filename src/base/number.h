#pragma once

#include <charconv>
#include <string>
#include <string_view>

namespace spawnfield {

/// Shortest text that reads back to the same double.
inline void append_number(std::string& text, double value)
{
    char buffer[32];
    const auto end = std::to_chars(buffer, buffer + sizeof buffer, value).ptr;
    text.append(buffer, end);
}

inline std::string number(double value)
{
    std::string text;
    append_number(text, value);
    return text;
}

/// The whole of text as a number; false if any of it is something else.
inline bool parse_number(std::string_view text, double& value)
{
    if (text.size() > 1 && text.front() == '+' && text[1] != '-') text.remove_prefix(1);
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc{} && end == text.data() + text.size();
}

}  // namespace spawnfield
