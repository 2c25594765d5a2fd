#include "angle.h"

#include "messages.h"
#include "numbers.h"

#include <charconv>
#include <cmath>
#include <map>
#include <numbers>

namespace spawnfield::cli {
namespace {

constexpr int along_headings = 16;  // of --yaw along

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

/// Returns a rule from its words before and after the colon; nothing if the first one is not the name of a rule. Throws
/// ArgumentError.
std::optional<HeadingRule> parse_rule(const std::string& text)
{
    using Kind = HeadingRule::Kind;
    static const std::map<std::string, Kind> kinds{
        {"facing", Kind::Facing}, {"downhill", Kind::Downhill}, {"uphill", Kind::Uphill}, {"all", Kind::All},
        {"any", Kind::Any},       {"best", Kind::Best},         {"along", Kind::Along}};
    const std::size_t colon = text.find(':');
    const auto found = kinds.find(text.substr(0, colon));
    if (found == kinds.end()) return std::nullopt;
    std::string value = colon == std::string::npos ? "" : text.substr(colon + 1);
    const auto refuse = [&](const std::string& needs) {
        throw ArgumentError("--yaw is \"" + text + "\", needs " + needs);
    };
    HeadingRule out{.kind = found->second};
    const std::string clearance = ":clearance";
    std::string example_end = out.kind == Kind::Best ? " or best:8" + clearance : "";
    if (out.kind == Kind::Best && value.ends_with(clearance)) {
        out.kind = Kind::Clearest;
        value.resize(value.size() - clearance.size());
        example_end = clearance;
    }
    const char *from = value.data(), *const end = from + value.size();
    if (out.kind == Kind::Along && colon == std::string::npos) {
        out.count = along_headings;
    } else if (out.has_several()) {
        const auto [stop, error] = std::from_chars(from, end, out.count);
        if (error != std::errc{} || stop != end || out.count < 1 || out.count > HeadingRule::most)
            refuse("a number of headings, 1 .. " + std::to_string(HeadingRule::most) + ", for example " + found->first +
                   ":8" + example_end);
    } else if (out.kind == Kind::Facing) {
        const auto [comma, error] = std::from_chars(from, end, out.x);
        if (error != std::errc{} || comma == end || *comma != ',')
            refuse("a point x,y in m, for example facing:3,-1.5");
        const auto [stop, other] = std::from_chars(comma + 1, end, out.y);
        if (other != std::errc{} || stop != end || !std::isfinite(out.x) || !std::isfinite(out.y))
            refuse("a point x,y in m, for example facing:3,-1.5");
    } else if (colon != std::string::npos) {
        refuse(found->first + " without anything after it");
    }
    return out;
}

}  // namespace

double parse_yaw(const CommonArgs& args, const std::string& text)
{
    if (parse_rule(text))
        throw ArgumentError("--yaw is \"" + text +
                            "\", but this file has one heading, such as 90deg; `raster --settle` and `heatmap` take "
                            "rules");
    return parse(args, text, "");
}

YawChoice parse_yaw_choice(const CommonArgs& args, const std::string& text, bool is_settled, bool allow_random)
{
    if (allow_random && text == "random") return {.is_random = true};
    const std::optional<HeadingRule> rule = parse_rule(text);
    if (rule && !is_settled)
        throw ArgumentError("--yaw " + text +
                            " is only for robots at rest: sample and heatmap without --stance level; raster, search "
                            "and experiment with --settle");
    if (rule) return {.rule = rule};
    return {.yaw = parse(
                args, text,
                std::string(allow_random ? ", or random" : "") +
                    (is_settled ? ", or facing:X,Y, downhill, uphill, all:K, any:K, best:K, best:K:clearance or along"
                                : ""))};
}

}  // namespace spawnfield::cli
