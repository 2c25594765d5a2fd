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

const std::string quantity_help = "clearance, head_room, tilt, margin, roughness, view, room";

PlaceQuantity parse_quantity(const std::string& option, const std::string& name)
{
    for (const PlaceQuantity quantity : all_place_quantities)
        if (name == to_string(quantity)) return quantity;
    throw ArgumentError(option + " has \"" + name + "\", needs one of " + quantity_help);
}

/// Returns the texts between commas; none for an empty text.
std::vector<std::string> words_between_commas(const std::string& text)
{
    return text.empty() ? std::vector<std::string>() : CLI::detail::split(text, ',');
}

}  // namespace

void add_place_rules(CLI::App& command, PlaceArgs& args)
{
    start_group(command, help_group::place);
    const auto add = [&](const char* name, auto& values, const char* help) {
        return command.add_option(name, values, help)->allow_extra_args(false);
    };
    command.add_option("--clearance", args.clearance,
                       "m: at least this much free room around the robot: the shortest horizontal shift with which it "
                       "touches an obstacle (at most 10; default 0)");
    add("--near", args.near,
        "GLOB LOW:HIGH: the distance in 3D between the robot and the nearest part, node or material with such a name "
        "is LOW .. HIGH m, for example 'shelf*' 0.5:1 (repeatable)")
        ->type_name("GLOB LOW:HIGH");
    command.add_option("--facing", args.facing, "GLOB: the robot looks at the nearest of those");
    add("--on", args.on, "GLOB: the robot stands only on such parts, nodes or materials (repeatable)");
    add("--not-on", args.not_on, "GLOB: the robot stands on none of those (repeatable)");
    add("--distance-to", args.distance_to,
        "x,y LOW:HIGH in m: horizontal distance of the robot's origin from a point (repeatable)")
        ->type_name("x,y LOW:HIGH");
    add("--in-view-of", args.in_view_of,
        "x,y,z in m: no terrain or obstacle is between this point and the robot's sensor (repeatable)");
    add("--hidden-from", args.hidden_from, "x,y,z in m: the opposite (repeatable)");
}

void add_quantity_settings(CLI::App& command, PlaceArgs& args)
{
    start_group(command, help_group::place);
    command.add_option("--sensor-height", args.sensor_height,
                       "m above the robot's origin, of the sensor (default: that of the robot's highest point)");
    command.add_option("--view-range", args.view_range, "m: how far a line of sight is free for view (default 10)");
    command.add_option("--room-range", args.room_range,
                       "m: how far the robot drives for room, the area to which it gets (default 3)");
}

void add_measures(CLI::App& command, PlaceArgs& args)
{
    start_group(command, help_group::place);
    command.add_option("--columns", args.columns,
                       "Write columns with these quantities of each spawn, with commas between them: " + quantity_help);
    command.add_option("--prefer", args.prefer,
                       "QUANTITY=WEIGHT,...: more spawns where these quantities are large; the density is proportional "
                       "to the product of clearance, head_room, margin, view or room to the power of their weights, "
                       "for example clearance=1,margin=0.5");
}

namespace {

/// Reads the options of add_quantity_settings(). asking(name) returns the options that ask for a quantity.
template <class Asking>
void read_settings(const PlaceArgs& args, const CLI::App& command, const Asking& asking, PlaceMeasures& out)
{
    const auto length_of = [&](const char* option, PlaceQuantity quantity, double value, double& length) {
        if (command.count(option) == 0) return;
        if (!asks_for(out, quantity))
            throw ArgumentError(std::string(option) + " is only for " + asking(std::string(to_string(quantity))));
        length = parse_positive(option, value);
    };
    length_of("--view-range", PlaceQuantity::View, args.view_range, out.view_range);
    length_of("--room-range", PlaceQuantity::Room, args.room_range, out.room_range);
    if (out.room_range > PlaceMeasures::most_room_range)
        throw bad_value("--room-range", out.room_range, "at most " + number(PlaceMeasures::most_room_range) + " m");
    if (command.count("--sensor-height") == 0) return;
    if (!asks_for(out, PlaceQuantity::View) && args.in_view_of.empty() && args.hidden_from.empty())
        throw ArgumentError("--sensor-height is only for --in-view-of, --hidden-from and view; give one of them");
    out.sensor_height = parse_finite("--sensor-height", args.sensor_height, "m");
}

std::vector<PlaceQuantity> place_quantities(const std::string& option, const std::string& names)
{
    std::vector<PlaceQuantity> out;
    for (const std::string& name : words_between_commas(names)) out.push_back(parse_quantity(option, name));
    return out;
}

}  // namespace

PlaceMeasures place_measures(const PlaceArgs& args, const CLI::App& command)
{
    PlaceMeasures out{.columns = place_quantities("--columns", args.columns)};
    for (const std::string& text : words_between_commas(args.prefer)) {
        const std::size_t equals = text.find('=');
        if (equals == std::string::npos)
            throw ArgumentError("--prefer has \"" + text + "\", needs QUANTITY=WEIGHT, for example clearance=1");
        const std::vector<double> weights = parse_numbers("--prefer", text.substr(equals + 1));
        out.prefer.push_back({parse_quantity("--prefer", text.substr(0, equals)), weights[0]});
        if (!(weights[0] > 0)) throw bad_value("the weight of --prefer " + text, weights[0], "> 0");
    }
    const auto asking = [](const std::string& name) {
        return "--columns " + name + " and --prefer " + name + "=WEIGHT";
    };
    read_settings(args, command, asking, out);
    return out;
}

PlaceMeasures place_measures(const PlaceArgs& args, const CLI::App& command, const std::string& option,
                             const std::string& quantities)
{
    PlaceMeasures out{.columns = place_quantities(option, quantities)};
    read_settings(
        args, command, [&](const std::string& name) { return option + " " + name; }, out);
    return out;
}

std::string words_of(const PlaceMeasures& measures)
{
    std::string out;
    for (const auto& [quantity, weight] : measures.prefer)
        out += (out.empty() ? "" : ", ") + std::string(to_string(quantity)) + "=" + number(weight);
    return out;
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
    if (!out.facing.empty() && command.count("--yaw") > 0)
        throw ArgumentError("--facing and --yaw both choose the yaw; leave one of them out");
    return out;
}

void notice_if_no_obstacles(const CommonArgs& common, const std::string& option, const Map& map)
{
    const LabelCount& obstacles = map.geometry.labels()[std::size_t(Label::Obstacle)];
    if (obstacles.triangles + obstacles.primitives == 0)
        notice(common, option +
                           " has no effect, because the map has no obstacles; `bake --auto-label slope=30` makes "
                           "steep faces obstacles");
}

void check_places(const CommonArgs& common, const PlaceRules& rules, const Map& map)
{
    const auto check = [&](const char* option, const std::string& glob) { selection_of(map.geometry, {glob}, option); };
    for (const std::string& glob : rules.on) check("--on", glob);
    for (const std::string& glob : rules.not_on) check("--not-on", glob);
    for (const PlaceRules::Near& near : rules.near) check("--near", near.parts);
    if (!rules.facing.empty()) check("--facing", rules.facing);
    if (rules.clearance > 0) notice_if_no_obstacles(common, "--clearance", map);
}

}  // namespace spawnfield::cli
