#include "simulators/text.h"

#include "base/number.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstring>

namespace spawnfield {

std::string plain_number(double value)
{
    char buffer[1200];  // more than any double needs
    const auto end = std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::fixed).ptr;
    return {buffer, end};
}

std::string shell_quoted(std::string_view word)
{
    const auto is_plain = [](unsigned char c) {
        return std::isalnum(c) != 0 || std::strchr("-_./:,=@+%", c) != nullptr;
    };
    if (!word.empty() && std::all_of(word.begin(), word.end(), is_plain)) return std::string(word);
    std::string out = "'";
    for (const char c : word) out += c == '\'' ? "'\\''" : std::string(1, c);
    return out + "'";
}

std::string python_quoted(std::string_view text)
{
    std::string out = "'";
    for (const char c : text) {
        if (c == '\'' || c == '\\') out += '\\';
        if (c == '\n')
            out += "\\n";
        else if (c == '\r')
            out += "\\r";
        else
            out += c;
    }
    return out + "'";
}

std::string spaced(const RobotStart& robot)
{
    std::string text;
    for (const double value :
         {robot.position.x(), robot.position.y(), robot.position.z(), robot.rpy.roll, robot.rpy.pitch, robot.rpy.yaw}) {
        if (!text.empty()) text += ' ';
        append_number(text, value);
    }
    return text;
}

std::string made_by(std::size_t robots)
{
    return std::to_string(robots) + (robots == 1 ? " robot" : " robots") + " by spawnfield " + version();
}

}  // namespace spawnfield
