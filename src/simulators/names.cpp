#include <spawnfield/error.h>
#include <spawnfield/simulators.h>

#include <algorithm>
#include <cctype>
#include <cstring>
#include <set>

namespace spawnfield {
namespace {

struct Pattern {
    std::string before, after;
    std::size_t digits = 0;  ///< smallest number of digits
    bool has_number = false;
};

[[noreturn]] void fail(const std::string& option, const std::string& text, const std::string& what)
{
    throw ArgumentError("names", option + " \"" + text + "\" " + what);
}

/// Reads the text between braces: `i`, or `i:0D` for at least D digits. Returns false for any other text.
bool read_place(const std::string& inside, std::size_t& digits)
{
    if (inside == "i") return true;
    if (!inside.starts_with("i:0") || inside.size() != 4 || inside[3] < '1' || inside[3] > '9') return false;
    digits = std::size_t(inside[3] - '0');
    return true;
}

Pattern read_pattern(const std::string& option, const std::string& text)
{
    Pattern pattern;
    const std::size_t open = text.find('{'), close = text.find('}');
    if (open == std::string::npos && close == std::string::npos) {
        pattern.before = text;
        return pattern;
    }
    const bool is_pair = open != std::string::npos && close != std::string::npos && open < close;
    if (!is_pair || !read_place(text.substr(open + 1, close - open - 1), pattern.digits))
        fail(option, text,
             "has braces that are neither {i} nor {i:03}; {i} is the robot's number, {i:03} has at least 3 digits (1 "
             "to 9 are allowed)");
    pattern.before = text.substr(0, open);
    pattern.after = text.substr(close + 1);
    pattern.has_number = true;
    if (pattern.after.find_first_of("{}") != std::string::npos)
        fail(option, text, "has braces twice, needs one {i} or {i:03}");
    return pattern;
}

bool is_letter(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Returns what is wrong with a name in ROS; an empty text if it is allowed.
std::string ros_fault(const std::string& name, int ros)
{
    if (name.empty() || name == "/") return "is empty";
    for (const char c : name)
        if (!is_letter(c) && !is_digit(c) && c != '_' && c != '/') return std::string("has \"") + c + "\"";
    const char first = name[0] == '/' ? name[1] : name[0];
    if (ros == 1 && !is_letter(first)) return "does not begin with a letter";
    if (name.back() == '/' || name.find("//") != std::string::npos) return "has an empty segment";
    if (ros == 1) return "";
    if (name.find("__") != std::string::npos) return "has two _ in a row";
    for (std::size_t i = 0; i < name.size(); ++i)
        if (is_digit(name[i]) && (i == 0 || name[i - 1] == '/')) return "has a segment that begins with a digit";
    return "";
}

}  // namespace

std::vector<std::string> numbered_names(const std::string& option, const std::string& pattern, std::size_t count)
{
    const Pattern parts = read_pattern(option, pattern);
    if (!parts.has_number && count > 1)
        fail(option, pattern, "gives all " + std::to_string(count) + " robots one name, needs {i} or {i:03}");
    std::vector<std::string> names;
    for (std::size_t i = 1; i <= count; ++i) {
        std::string number = parts.has_number ? std::to_string(i) : "";
        if (number.size() < parts.digits) number.insert(0, parts.digits - number.size(), '0');
        names.push_back(parts.before + number + parts.after);
    }
    check_names(option,
                std::span(names).first(std::min<std::size_t>(names.size(), 1)));  // the others differ by their numbers
    return names;
}

void check_names(const std::string& option, std::span<const std::string> names)
{
    std::set<std::string_view> seen;
    for (const std::string& name : names) {
        if (name.empty()) fail(option, name, "is empty, needs a name");
        for (const char c : name)
            if (std::iscntrl(static_cast<unsigned char>(c)) != 0) fail(option, name, "has a control character");
        if (!seen.insert(name).second)
            fail(option, name, "is the name of two robots; give each robot a name of its own");
    }
}

void check_ros_names(const std::string& option, std::span<const std::string> names, int ros)
{
    for (const std::string& name : names)
        if (const std::string fault = ros_fault(name, ros); !fault.empty())
            fail(option, name,
                 fault + ", which is not allowed in ROS " + std::to_string(ros) +
                     "; use letters, digits, _ and /, a letter first");
}

void check_model_names(const std::string& option, std::span<const std::string> names)
{
    for (const std::string& name : names) {
        for (const char c : name)
            if (!is_letter(c) && !is_digit(c) && std::strchr("_-./+", c) == nullptr)
                fail(option, name,
                     std::string("has \"") + c +
                         "\", which is not allowed in a model's name; use letters, digits and _ - . / +");
        if (name.starts_with("__") && name.ends_with("__"))
            fail(option, name, "has __ at both ends, which SDF reserves");
    }
}

}  // namespace spawnfield
