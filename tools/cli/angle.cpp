#include "angle.h"

#include "messages.h"
#include "numbers.h"

#include <charconv>
#include <cmath>
#include <numbers>

namespace spawnfield::cli {
namespace {

double parse(const CommonArgs& args, const std::string& text, const std::string& others)
{
    constexpr double radians_per_degree = std::numbers::pi / 180, turn = 2 * std::numbers::pi + 1e-9;
    double value = 0;
    const char* const end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    const std::string unit(stop, end);
    if (error != std::errc{} || !(unit.empty() || unit == "deg"))
        throw ArgumentError("--yaw is \"" + text + "\", needs radians such as 1.57 or degrees such as 90deg" + others);
    parse_finite("--yaw", value, unit.empty() ? "rad" : "degrees");
    if (!unit.empty()) return value * radians_per_degree;
    if (std::abs(value) > turn)
        notice(args, "--yaw " + text + " is more than a turn of 2 pi rad; did you mean degrees? --yaw " + text + "deg");
    return value;
}

}  // namespace

double parse_yaw(const CommonArgs& args, const std::string& text) { return parse(args, text, ""); }

std::optional<double> parse_yaw_or_random(const CommonArgs& args, const std::string& text)
{
    if (text == "random") return std::nullopt;
    return parse(args, text, ", or random");
}

}  // namespace spawnfield::cli
