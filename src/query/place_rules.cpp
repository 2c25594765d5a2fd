#include <spawnfield/place_rules.h>

#include "base/number.h"
#include "scene/glob.h"

#include <spawnfield/error.h>

#include <algorithm>
#include <cmath>

namespace spawnfield {
namespace {

/// Returns "0.5:1 m"; an infinite limit is left out.
std::string range_text(double low, double high)
{
    return number(low) + ":" + (std::isinf(high) ? "" : number(high)) + " m";
}

/// Returns whether a glob matches a name of a part, or one of its words between "::".
bool matches_part(const std::string& glob, const std::string& name)
{
    if (matches(glob, name)) return true;
    for (std::size_t from = 0; name.find("::") != std::string::npos;) {
        const std::size_t end = name.find("::", from);
        if (matches(glob, name.substr(from, end == std::string::npos ? end : end - from))) return true;
        if (end == std::string::npos) break;
        from = end + 2;
    }
    return false;
}

std::string some_names(const std::vector<Part>& parts)
{
    constexpr std::size_t most = 8;
    std::string out;
    for (std::size_t i = 0; i < std::min(most, parts.size()); ++i) out += (i > 0 ? ", " : "") + parts[i].name;
    return out + (parts.size() > most ? ", …" : "");
}

std::string point_text(const Vec3& point)
{
    return number(point.x()) + "," + number(point.y()) + "," + number(point.z());
}

}  // namespace

std::string to_string(const PlaceRules& rules)
{
    std::string out;
    const auto add = [&](const std::string& text) { out += (out.empty() ? "" : ", ") + text; };
    if (rules.clearance > 0) add("clearance " + number(rules.clearance) + " m");
    for (const std::string& glob : rules.on) add("on " + glob);
    for (const std::string& glob : rules.not_on) add("not on " + glob);
    for (const PlaceRules::Near& near : rules.near) add("near " + near.parts + " " + range_text(near.low, near.high));
    for (const PlaceRules::Distance& to : rules.distance_to)
        add("distance to " + number(to.x) + "," + number(to.y) + " " + range_text(to.low, to.high));
    for (const Vec3& point : rules.in_view_of) add("in view of " + point_text(point));
    for (const Vec3& point : rules.hidden_from) add("hidden from " + point_text(point));
    if (!rules.facing.empty()) add("facing " + rules.facing);
    return out;
}

PartFlags matching_parts(const Geometry& geometry, const std::vector<std::string>& globs, const std::string& rule)
{
    const std::vector<Part>& parts = geometry.parts();
    PartFlags out(parts.size());
    for (const std::string& glob : globs) {
        bool is_used = false;
        for (std::size_t i = 0; i < parts.size(); ++i) {
            if (!matches_part(glob, parts[i].name)) continue;
            out[i] = 1;
            is_used = true;
        }
        if (!is_used)
            throw ArgumentError(rule + " \"" + glob + "\" matches no part of the map; there are " + some_names(parts) +
                                " (`spawnfield info MAP` lists them; * stands for any text)");
    }
    return out;
}

}  // namespace spawnfield
