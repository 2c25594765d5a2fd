#include "ground_args.h"

#include "command.h"
#include "numbers.h"

#include <cmath>
#include <cstdio>

namespace spawnfield::cli {
namespace {

Floor floor_of(const GroundArgs& args, const Map& map)
{
    const std::vector<Floor> floors = floors_of(map);
    if (std::size_t(args.floor) < floors.size()) return floors[std::size_t(args.floor)];
    std::string list;
    for (std::size_t k = 0; k < floors.size(); ++k)
        list += (k == 0 ? ": " : ", ") + std::to_string(k) + " at " + number(floors[k].height) + " m";
    throw ArgumentError("--floor is " + std::to_string(args.floor) + "; the map has " +
                        counted(floors.size(), "floor") + list);
}

/// Throws ArgumentError if a robot that rests on level ground and is raised by --lift is above --max-height.
void check_lift(const QueryArgs& args, const Robot& robot)
{
    const double height = args.lift - robot.bounds().min.z();
    if (height <= args.max_height + touch_tolerance) return;
    throw ArgumentError("--lift is " + number(args.lift) +
                        " m, which raises the origin of a robot on level ground to " + rounded(height) +
                        " m, needs at most --max-height, " + number(args.max_height) +
                        " m: `check` calls higher poses aerial; give a smaller --lift, or --max-height " +
                        rounded(height) + " or more");
}

}  // namespace

void add_ground(CLI::App& command, GroundArgs& args, const std::string& layers_help)
{
    start_group(command, help_group::ground);
    command.add_option("--offset", args.offset,
                       "Height of a level robot's origin above its layer, m. auto: the robot's lowest point is 0.1 m "
                       "above the layer (default auto)");
    command.add_option("--layers,--layer", args.layers, layers_help);
    command
        .add_option("--floor", args.floor,
                    "Only layers of this floor, 0 the lowest; `spawnfield info MAP` lists floors")
        ->check(CLI::Range(0, 1000000));
    command.add_option("--z", args.z, "LOW:HIGH in m: layers at other heights are not ground (5: or :8 for one limit)");
}

std::string z_text(const ZRange& z)
{
    const auto limit = [](double value) { return std::isfinite(value) ? number(value) : std::string(); };
    return limit(z.low) + ":" + limit(z.high);
}

ZRange parse_z(const std::string& option, const std::string& text)
{
    const auto [low, high] = parse_limits(option, text, "LOW:HIGH in m, for example 5:8 or 5:", "lower height");
    return {low, high};
}

std::optional<double> parse_offset(const std::string& text)
{
    if (text == "auto") return std::nullopt;
    const std::vector<double> values = parse_numbers("--offset", text);
    if (values.size() != 1) throw ArgumentError("--offset is \"" + text + "\", needs metres or auto");
    return parse_finite("--offset", values[0], "m");
}

std::optional<double> given_offset(const QueryArgs& args, const GroundArgs& ground, const CLI::App& command)
{
    if (!args.is_settled()) return parse_offset(ground.offset);
    if (command.count("--offset") > 0)
        throw ArgumentError("--offset is " + ground.offset +
                            ", but it is the height of a level robot, and settled robots stand on the ground; " +
                            args.how_to_level() + ", or leave --offset out" +
                            (args.has_default_stance() ? " (before version 0.2.0, level was the default)" : ""));
    return std::nullopt;
}

ZRange heights_of(const GroundArgs& args, const Bounds& bounds, const std::string& bounds_option)
{
    const ZRange of_bounds = bounds.is_empty() ? ZRange{} : bounds.z();
    if (args.z.empty()) return of_bounds;
    if (!of_bounds.is_unlimited())
        throw ArgumentError("--z and the six numbers of " + bounds_option + " both limit heights; give one of them");
    return parse_z("--z", args.z);
}

ZRange with_floor(const ZRange& heights, const GroundArgs& args, const Map& map)
{
    if (args.floor < 0) return heights;
    if (!heights.is_unlimited())
        throw ArgumentError("--floor and --z (or six numbers for a box) both limit heights; give one of them");
    return floor_of(args, map).z;
}

Bounds with_heights(const Bounds& bounds, const ZRange& heights, const Map& map)
{
    if (bounds.is_empty() && heights.is_unlimited()) return bounds;
    Bounds out = bounds.is_empty() ? map.bounds : bounds;
    const auto first_finite = [](double a, double b, double c) {
        return std::isfinite(a) ? a : std::isfinite(b) ? b : c;
    };
    out.min.z() = first_finite(heights.low, bounds.is_empty() ? heights.low : bounds.min.z(), map.bounds.min.z());
    out.max.z() = first_finite(heights.high, bounds.is_empty() ? heights.high : bounds.max.z(), map.bounds.max.z());
    if (!(out.min.z() <= out.max.z()))
        throw ArgumentError("--z is outside the map, whose heights are " + number(map.bounds.min.z()) + " to " +
                            number(map.bounds.max.z()) + " m");
    return out;
}

std::string height_words(const GroundArgs& args, const ZRange& heights, const Map& map)
{
    if (args.floor < 0 && heights.is_unlimited()) return "";
    if (args.floor < 0) return "heights " + z_text(heights) + " m";
    return "floor " + std::to_string(args.floor) + " at " + number(floor_of(args, map).height) + " m";
}

std::optional<double> choose_offset(const QueryArgs& args, const std::optional<double>& wanted, const Robot& robot,
                                    Summary& summary)
{
    if (args.is_settled()) {
        check_lift(args, robot);
        summary.extra.push_back("settled");
        return std::nullopt;
    }
    const double chosen = wanted.value_or(auto_offset(robot));
    const std::string value = rounded(chosen), how = wanted ? "" : " (auto)";
    if (chosen > args.max_height + touch_tolerance)
        throw ArgumentError("--offset is " + value + " m" + how + ", needs at most --max-height, " +
                            number(args.max_height) + " m: `check` calls higher poses aerial; give --max-height " +
                            value + " or more");
    summary.offset = chosen;
    summary.extra.push_back("offset " + (wanted ? number(chosen) : value) + " m" + how);
    return chosen;
}

std::string flat_ground_complaint(const Robot& robot, double offset)
{
    if (!is_in_flat_ground(robot, offset)) return "";
    char text[200];
    std::snprintf(
        text, sizeof text,
        "at --offset %.6g m the robot collides with all flat ground: its lowest point is %.6g m below its origin; "
        "give --offset auto, which is %.6g m",
        offset, 0 - robot.bounds().min.z(), auto_offset(robot));
    return text;
}

void require_above_ground(const Robot& robot, const std::optional<double>& offset)
{
    if (!offset) return;
    if (const std::string why = flat_ground_complaint(robot, *offset); !why.empty()) throw NothingFits{why};
}

}  // namespace spawnfield::cli
