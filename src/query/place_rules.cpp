#include <spawnfield/place_rules.h>

#include "base/number.h"
#include "geometry/part_globs.h"

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

Selection selection_of(const Geometry& geometry, const std::vector<std::string>& globs, const std::string& rule)
{
    Selection out{std::vector<std::uint8_t>(geometry.parts().size()),
                  std::vector<std::uint8_t>(geometry.face_groups().size())};
    for (const std::string& glob : globs) {
        const std::vector<std::size_t> parts = parts_that_match(geometry, glob),
                                       groups = face_groups_that_match(geometry, glob);
        if (parts.empty() && groups.empty()) throw ArgumentError(rule + " " + no_name_matches(geometry, glob));
        for (const std::size_t part : parts) out.parts[part] = 1;
        for (const std::size_t group : groups) out.groups[group] = 1;
    }
    return out;
}

}  // namespace spawnfield
