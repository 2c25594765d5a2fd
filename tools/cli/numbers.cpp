#include "numbers.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <utility>

namespace spawnfield::cli {

std::string number(double value)
{
    char text[32];
    return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

std::string rounded(double value)
{
    char text[32];
    std::snprintf(text, sizeof text, "%.6g", value + 0.0);  // never -0
    return text;
}

std::string counted(std::uint64_t count, const std::string& noun)
{
    return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

ArgumentError bad_value(const std::string& option, double value, const std::string& limit)
{
    return ArgumentError(option + " is " + number(value) + ", needs " + limit);
}

std::vector<double> parse_numbers(const std::string& option, const std::string& text, char separator,
                                  const std::string& advice)
{
    std::vector<double> out;
    for (std::size_t start = 0; start <= text.size();) {
        const std::size_t between = std::min(text.find(separator, start), text.size());
        double value = 0;
        const char* const end = text.data() + between;
        const auto [stop, error] = std::from_chars(text.data() + start, end, value);
        if (error != std::errc{} || stop != end || !std::isfinite(value))
            throw ArgumentError(option + ": \"" + text.substr(start, between - start) + "\" is not a finite number" +
                                advice);
        out.push_back(value);
        start = between + 1;
    }
    return out;
}

double parse_size(const std::string& option, const std::string& text)
{
    const std::size_t end = std::min(text.find_first_not_of("0123456789.+-eE"), text.size());
    std::string unit = text.substr(std::min(text.find_first_not_of(' ', end), text.size()));
    std::transform(unit.begin(), unit.end(), unit.begin(), [](unsigned char c) { return char(std::toupper(c)); });
    constexpr std::array<std::pair<const char*, double>, 12> units{{{"", 1},
                                                                    {"B", 1},
                                                                    {"KB", 1e3},
                                                                    {"MB", 1e6},
                                                                    {"GB", 1e9},
                                                                    {"TB", 1e12},
                                                                    {"KIB", 1024.0},
                                                                    {"MIB", 1024.0 * 1024},
                                                                    {"GIB", 1024.0 * 1024 * 1024},
                                                                    {"M", 1e6},
                                                                    {"G", 1e9},
                                                                    {"T", 1e12}}};
    const auto found = std::find_if(units.begin(), units.end(), [&](const auto& known) { return known.first == unit; });
    double value = 0;
    const auto [last, error] = std::from_chars(text.data(), text.data() + end, value);
    if (found == units.end() || error != std::errc{} || last != text.data() + end || !(value > 0))
        throw ArgumentError(option + " is \"" + text + "\", needs a size > 0, for example 8GB or 500MB");
    return value * found->second;
}

Limits parse_limits(const std::string& option, const std::string& text, const std::string& form,
                    const std::string& lower)
{
    const std::size_t colon = text.find(':');
    if (colon == std::string::npos || text.size() == 1)
        throw ArgumentError(option + " is \"" + text + "\", needs " + form);
    Limits out;
    if (colon > 0) out.low = parse_numbers(option, text.substr(0, colon))[0];
    if (colon + 1 < text.size()) out.high = parse_numbers(option, text.substr(colon + 1))[0];
    if (!(out.low <= out.high)) throw ArgumentError(option + " is \"" + text + "\"; give the " + lower + " first");
    return out;
}

Bounds parse_bounds(const std::string& option, const std::string& text, bool flat_allowed)
{
    const auto v = parse_numbers(option, text);
    Bounds bounds;
    if (v.size() == 6) {
        bounds = {Vec3(v[0], v[1], v[2]), Vec3(v[3], v[4], v[5])};
    } else if (v.size() == 4 && flat_allowed) {
        const ZRange all;
        bounds = {Vec3(v[0], v[1], all.low), Vec3(v[2], v[3], all.high)};
    } else {
        throw ArgumentError(option + " has " + std::to_string(v.size()) + " numbers, needs 6: x0,y0,z0,x1,y1,z1" +
                            (flat_allowed ? " (or 4: x0,y0,x1,y1)" : ""));
    }
    for (const double value : v)
        if (!(std::abs(value) <= 1e7)) throw bad_value(option, value, "numbers between -1e7 and 1e7, m");
    for (int axis = 0; axis < 3; ++axis)
        if (bounds.min[axis] > bounds.max[axis])
            throw bad_value(option + ": " + "xyz"[axis] + "1", bounds.max[axis],
                            std::string("at least ") + "xyz"[axis] + "0; give the lower corner first");
    return bounds;
}

std::string bounds_text(const Bounds& bounds, int axes)
{
    std::string text;
    for (const Vec3& corner : {bounds.min, bounds.max})
        for (int axis = 0; axis < axes; ++axis) text += (text.empty() ? "" : ",") + number(corner[axis]);
    return text;
}

LayerChoice parse_layers(const std::string& text)
{
    if (text == "all") return {LayerChoice::Kind::All, 0};
    if (text == "top") return {LayerChoice::Kind::Top, 0};
    if (text == "bottom") return {LayerChoice::Kind::Bottom, 0};
    int index = 0;
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), index);
    if (error != std::errc{} || stop != text.data() + text.size() || index < 0)
        throw ArgumentError("--layers is \"" + text +
                            "\", needs all, top, bottom or a number (0 is the highest layer)");
    return {LayerChoice::Kind::Index, index};
}

double parse_positive(const std::string& option, double value)
{
    if (!(value > 0) || !std::isfinite(value)) throw bad_value(option, value, "> 0");
    return value;
}

double parse_finite(const std::string& option, double value, const std::string& unit)
{
    if (!std::isfinite(value)) throw bad_value(option, value, "a finite number, " + unit);
    if (std::abs(value) > 1e7) throw bad_value(option, value, "at most 1e7 " + unit);  // no scene reaches farther
    return value;
}

}  // namespace spawnfield::cli
