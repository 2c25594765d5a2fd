#include "place_args.h"

#include "messages.h"
#include "numbers.h"

#include <algorithm>
#include <limits>

namespace spawnfield::cli {
namespace {

/// A range of distances, m.
struct Range {
    double low, high;
};

/// Reads "LOW:HIGH", "LOW:" or ":HIGH". Throws ArgumentError.
Range parse_range(const std::string& option, const std::string& text)
{
    const std::size_t colon = text.find(':');
    const auto side = [&](const std::string& number_text, double missing) {
        const std::vector<double> values = number_text.empty() ? std::vector{missing}
                                                               : parse_numbers(option, number_text);
        return values.size() == 1 ? values[0] : -1;
    };
    const Range out = colon == std::string::npos || text.size() == 1
                          ? Range{-1, -1}
                          : Range{side(text.substr(0, colon), 0),
                                  side(text.substr(colon + 1), std::numeric_limits<double>::infinity())};
    if (!(out.low >= 0 && out.high >= out.low))
        throw ArgumentError(option + " has the range \"" + text +
                            "\", needs LOW:HIGH in m with 0 <= LOW <= HIGH, for example 0.5:1, or 2: or :5");
    return out;
}

Vec3 parse_point(const std::string& option, const std::string& text)
{
    const std::vector<double> values = parse_numbers(option, text);
    if (values.size() != 3)
        throw ArgumentError(option + " is \"" + text + "\", needs x,y,z in m, for example 1.5,-2,1.2");
    return {values[0], values[1], values[2]};
}

PlaceRules::Distance parse_distance(const std::pair<std::string, std::string>& texts)
{
    const std::vector<double> values = parse_numbers("--distance-to", texts.first);
    if (values.size() != 2)
        throw ArgumentError("--distance-to is \"" + texts.first +
                            "\", needs x,y and LOW:HIGH in m, for example 3,-1 2:5");
    const Range range = parse_range("--distance-to", texts.second);
    return {values[0], values[1], range.low, range.high};
}

}  // namespace

void add_places(CLI::App& command, PlaceArgs& args)
{
    start_group(command, help_group::place);
    const auto add = [&](const char* name, auto& values, const char* help) {
        return command.add_option(name, values, help)->allow_extra_args(false);
    };
    command.add_option("--clearance", args.clearance,
                       "m: at least this much free room around the robot: the shortest horizontal shift with which it "
                       "touches an obstacle (at most 10; default 0)");
    add("--near", args.near,
        "GLOB LOW:HIGH: the distance in 3D between the robot and the nearest part with such a name is LOW .. HIGH m, "
        "for example 'shelf*' 0.5:1 (repeatable)")
        ->type_name("GLOB LOW:HIGH");
    command.add_option("--facing", args.facing, "GLOB: the robot looks at the nearest part with such a name");
    add("--on", args.on, "GLOB: the robot stands on parts with such names only (repeatable)");
    add("--not-on", args.not_on, "GLOB: the robot does not stand on a part with such a name (repeatable)");
    add("--distance-to", args.distance_to,
        "x,y LOW:HIGH in m: horizontal distance of the robot's origin from a point (repeatable)")
        ->type_name("x,y LOW:HIGH");
    add("--in-view-of", args.in_view_of,
        "x,y,z in m: no terrain or obstacle is between this point and the robot's sensor (repeatable)");
    add("--hidden-from", args.hidden_from, "x,y,z in m: the opposite (repeatable)");
    command.add_option("--sensor-height", args.sensor_height,
                       "m above the robot's origin, of the sensor (default: that of the robot's highest point)");
}

PlaceRules place_rules(const PlaceArgs& args, const CLI::App& command)
{
    PlaceRules out{.clearance = args.clearance, .on = args.on, .not_on = args.not_on, .facing = args.facing};
    if (!(args.clearance >= 0 && args.clearance <= 10)) throw bad_value("--clearance", args.clearance, "0 .. 10 m");
    for (const auto& [glob, text] : args.near) {
        const Range range = parse_range("--near " + glob, text);
        out.near.push_back({glob, range.low, range.high});
    }
    for (const auto& texts : args.distance_to) out.distance_to.push_back(parse_distance(texts));
    for (const std::string& text : args.in_view_of) out.in_view_of.push_back(parse_point("--in-view-of", text));
    for (const std::string& text : args.hidden_from) out.hidden_from.push_back(parse_point("--hidden-from", text));
    if (!args.sensor_height.empty()) {
        const std::vector<double> values = parse_numbers("--sensor-height", args.sensor_height);
        if (values.size() != 1)
            throw ArgumentError("--sensor-height is \"" + args.sensor_height + "\", needs one number, m");
        out.sensor_height = values[0];
        if (out.in_view_of.empty() && out.hidden_from.empty())
            throw ArgumentError("--sensor-height is only for --in-view-of and --hidden-from; give one of them");
    }
    if (!out.facing.empty() && command.count("--yaw") > 0)
        throw ArgumentError("--facing and --yaw both choose the yaw; leave one of them out");
    return out;
}

void check_places(const CommonArgs& common, const PlaceRules& rules, const Map& map)
{
    const auto check = [&](const char* option, const std::string& glob) {
        matching_parts(map.geometry, {glob}, option);
    };
    for (const std::string& glob : rules.on) check("--on", glob);
    for (const std::string& glob : rules.not_on) check("--not-on", glob);
    for (const PlaceRules::Near& near : rules.near) check("--near", near.parts);
    if (!rules.facing.empty()) check("--facing", rules.facing);
    const LabelCount& obstacles = map.geometry.labels()[std::size_t(Label::Obstacle)];
    if (rules.clearance > 0 && obstacles.triangles + obstacles.primitives == 0)
        notice(common,
               "--clearance has no effect, because the map has no obstacles; `bake --auto-label slope=30` makes "
               "steep faces obstacles");
}

}  // namespace spawnfield::cli
