#include "area_args.h"

#include "messages.h"
#include "numbers.h"
#include "session.h"
#include "streams.h"

#include <spawnfield/input_file.h>
#include <spawnfield/region_file.h>

#include <filesystem>

namespace spawnfield::cli {
namespace {

Region read_one(const CommonArgs& common, const std::string& option, const std::string& text, MapCells cells)
{
    if (is_box(text) && !does_exist(text)) {
        const Bounds box = parse_bounds(option, text, true);
        Region out = box_region(box.min.x(), box.min.y(), box.max.x(), box.max.y(), box.z());
        out.name = text;
        return out;
    }
    Region out = is_standard(text)       ? parse_region(read_standard_input(common), input_name(text))
                 : text.starts_with('{') ? parse_region(text, option + " in GeoJSON")
                                         : read_region(text, cells);
    for (const std::string& words : out.notices) notice(common, words);
    return out;
}

void notice_about(const CommonArgs& common, const Map& map, const std::string& option, const Region& region)
{
    const Bounds bounds = region.bounds();
    notice_if_off_map(common, map, option + " " + region.name, bounds);
    if (!bounds.meets(map.bounds, 2) && map.origin)
        notice(common, "regions are in the map's frame, not in survey coordinates; 0, 0 of the map is x " +
                           number(map.origin->x) + ", y " + number(map.origin->y) + " of the survey");
    const auto longest = [](const Bounds& b) { return (b.max - b.min).head<2>().maxCoeff(); };
    if (longest(bounds) < 1e-3 * longest(map.bounds) && bounds.max.head<2>().cwiseAbs().maxCoeff() <= 180)
        notice(common,
               option + " " + region.name + " is " + to_string(bounds, 2) +
                   ", tiny compared with the map; if these are degrees, convert them to metres in the map's frame");
}

}  // namespace

bool is_box(const std::string& text)
{
    return text.find(',') != std::string::npos && text.find_first_not_of("0123456789+-.eE, ") == std::string::npos;
}

void add_area(CLI::App& command, AreaArgs& args)
{
    start_group(command, help_group::region);
    command
        .add_option(
            "--region", args.regions,
            "Poses are only wanted here: x0,y0,x1,y1 or x0,y0,z0,x1,y1,z1 in m, or a file in the map's metres: "
            "GeoJSON, CSV (x,y), map.yaml of nav2 (its free cells). Or the text of GeoJSON itself; - is GeoJSON or "
            "CSV on standard input. "
            "Repeatable: poses are wanted in any of them")
        ->allow_extra_args(false);
    command
        .add_option("--keep-out", args.keep_outs,
                    "Poses are not wanted here; the same values as for --region. Of a map.yaml: its occupied cells "
                    "(repeatable)")
        ->allow_extra_args(false);
}

std::optional<Bounds> lone_box(const AreaArgs& args)
{
    if (args.regions.size() != 1 || !is_box(args.regions[0]) || does_exist(args.regions[0])) return std::nullopt;
    return parse_bounds("--region", args.regions[0], true);
}

Area read_area(const CommonArgs& common, const AreaArgs& args)
{
    Area out;
    for (const std::string& text : args.regions)
        out.within.push_back(read_one(common, "--region", text, MapCells::Free));
    for (const std::string& text : args.keep_outs)
        out.keep_out.push_back(read_one(common, "--keep-out", text, MapCells::Occupied));
    return out;
}

void notice_about_area(const CommonArgs& common, const Map& map, const Area& area)
{
    for (const Region& region : area.within) notice_about(common, map, "--region", region);
    for (const Region& region : area.keep_out) notice_about(common, map, "--keep-out", region);
}

}  // namespace spawnfield::cli
