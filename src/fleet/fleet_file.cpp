#include "base/number.h"
#include "base/yaml_map.h"

#include <spawnfield/error.h>
#include <spawnfield/fleet_file.h>
#include <spawnfield/input_file.h>

#include <algorithm>
#include <limits>
#include <numbers>
#include <set>

namespace spawnfield {
namespace {

namespace fs = std::filesystem;

double at_least_zero(const YamlMap& map, const std::string& key)
{
    const double value = map.finite(key);
    if (value < 0) map.fail(key, "is " + number(value) + ", needs >= 0");
    return value;
}

std::optional<std::string> given_text(const YamlMap& map, const std::string& key)
{
    return map.has(key) ? std::optional(map.text(key)) : std::nullopt;
}

/// Reads [x, y] or [x, y, z].
StartPlace place_in(const YamlMap& map, const std::string& key)
{
    const std::size_t size = map.list(key).size();
    if (size != 2 && size != 3)
        map.fail(key, "has " + std::to_string(size) + " numbers, needs [x, y] or [x, y, z] in m");
    if (size == 2) return {map.pair(key)[0], map.pair(key)[1], {}};
    const Vec3 point = map.vector(key);
    return {point.x(), point.y(), point.z()};
}

/// Reads a list of [x, y] or [x, y, z].
std::vector<Vec3> path_in(const YamlMap& map, const std::string& key)
{
    std::vector<Vec3> out;
    for (const YAML::Node& node : map.list(key)) {
        YAML::Node corner;
        corner["corner"] = node;
        const StartPlace place = place_in(
            {corner, map.file(), map.place() + ": " + key + ", corner " + std::to_string(out.size() + 1)}, "corner");
        out.emplace_back(place.x, place.y, place.z.value_or(std::numeric_limits<double>::quiet_NaN()));
    }
    if (out.size() < 2) map.fail(key, "has fewer than two corners");
    return out;
}

/// Reads the direction of a line, a grid or a circle.
void read_heading(const YamlMap& map, Formation& out)
{
    if (!map.is_list("heading")) {
        out.heading = map.finite("heading") * (std::numbers::pi / 180);
        return;
    }
    if (!out.at) map.fail("heading", "is a point, which needs `at`, too");
    const auto point = map.pair("heading");
    out.heading = std::atan2(point[1] - out.at->y, point[0] - out.at->x);
}

void read_convoy(const YamlMap& map, FormationPlan& out)
{
    map.only({"shape", "spacing", "path", "from", "to"});
    if (map.has("path") == map.has("from"))
        map.fail("a convoy needs either `path`, a list of corners, or `from` and `to`");
    if (map.has("path") && map.has("to")) map.fail("to", "needs `from` in place of `path`");
    if (map.has("path"))
        out.formation.path = path_in(map, "path");
    else
        out.from_to = {place_in(map, "from"), place_in(map, "to")};
}

FormationPlan formation_in(const YamlMap& map)
{
    using Form = Formation::Form;
    FormationPlan out;
    Formation& formation = out.formation;
    const std::string shape = map.text("shape");
    map.one_of("shape", {"line", "grid", "circle", "convoy"}, "");
    formation.form = shape == "line"     ? Form::Line
                     : shape == "grid"   ? Form::Grid
                     : shape == "circle" ? Form::Circle
                                         : Form::Convoy;
    formation.spacing = map.positive("spacing");
    if (formation.form == Form::Convoy) {
        read_convoy(map, out);
        return out;
    }
    std::vector<std::string> known{"shape", "spacing", "at", "heading"};
    if (formation.form == Form::Grid) known.push_back("columns");
    map.only(known);
    if (map.has("columns")) formation.columns = int(map.whole("columns", 1, 1e6));
    if (map.has("at")) formation.at = place_in(map, "at");
    if (map.has("heading")) read_heading(map, formation);
    return out;
}

/// Returns the path in the folder, if it is a relative path of something that exists there.
std::string in_folder(const fs::path& folder, const std::string& text)
{
    return fs::path(text).is_relative() && does_exist(folder / text) ? (folder / text).string() : text;
}

/// Reads a region or several: a text, a box as a list of numbers, or a list of texts.
std::vector<std::string> regions_in(const YamlMap& map, const std::string& key, const fs::path& folder)
{
    if (!map.has(key)) return {};
    if (!map.is_list(key)) return {in_folder(folder, map.text(key))};
    std::vector<std::string> texts;
    bool are_numbers = true;
    for (const YAML::Node& node : map.list(key)) {
        if (!node.IsScalar()) map.fail(key, "has a list in a list, needs texts, or 4 or 6 numbers for a box");
        double ignored = 0;
        are_numbers = are_numbers && parse_number(node.Scalar(), ignored);
        texts.push_back(node.Scalar());
    }
    if (texts.empty()) map.fail(key, "is empty, needs a region");
    if (are_numbers) {
        std::string box;
        for (const std::string& text : texts) box += (box.empty() ? "" : ",") + text;
        return {box};
    }
    for (std::string& text : texts) text = in_folder(folder, text);
    return texts;
}

void check_name(const YamlMap& map, const std::string& name)
{
    const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
    const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
    const bool is_word = is_letter(name[0]) && name.back() != '_' && name.find("__") == std::string::npos &&
                         std::ranges::all_of(name, [&](char c) { return is_letter(c) || is_digit(c) || c == '_'; });
    const std::size_t end = name.find_last_not_of("0123456789");
    const bool is_numbered = end != name.npos && end + 1 < name.size() && name[end] == '_';
    if (!is_word)
        map.fail("name", "is \"" + name +
                             "\", needs letters, digits and single _, and a letter first, so that every "
                             "simulator accepts it");
    if (is_numbered)
        map.fail("name", "is \"" + name + "\", but _ and a number are for the robots of a kind; choose another name");
}

FleetFileKind kind_in(const YamlMap& map, const fs::path& folder)
{
    map.only({"name", "robot", "model", "count", "min_distance", "yaw", "region", "keep_out", "floor", "z", "layers",
              "island", "drive", "max_step", "max_slope", "reach_step", "fill_step", "formation"});
    FleetFileKind out{.name = map.text("name"), .robot = map.text("robot")};
    check_name(map, out.name);
    if (!out.robot.starts_with("box:")) out.robot = (folder / out.robot).string();
    if (map.has("model")) out.model = in_folder(folder, map.text("model"));
    if (map.text("count") != "fill") out.count = std::size_t(map.whole("count", 1, double(max_spawns)));
    if (map.has("min_distance")) out.min_distance = at_least_zero(map, "min_distance");
    if (map.has("max_step")) out.max_step = at_least_zero(map, "max_step");
    if (map.has("max_slope")) out.max_slope = map.positive("max_slope");
    if (map.has("reach_step")) out.reach_step = map.positive("reach_step");
    if (map.has("fill_step")) out.fill_step = map.positive("fill_step");
    if (map.has("floor")) out.floor = int(map.whole("floor", 0, 1e6));
    out.yaw = given_text(map, "yaw");
    out.z = given_text(map, "z");
    out.layers = given_text(map, "layers");
    out.island = given_text(map, "island");
    if (map.has("drive")) out.drive = map.one_of("drive", drive_names, "");
    out.region = regions_in(map, "region", folder);
    out.keep_out = regions_in(map, "keep_out", folder);
    if (!map.has("formation")) return out;
    out.formation = formation_in(map.map("formation"));
    if (!out.count) map.fail("count", "is fill, but a formation needs a number of robots");
    if (out.yaw) map.fail("yaw", "is given, but the formation sets the yaw; leave it out");
    return out;
}

std::size_t kind_called(const YamlMap& map, const YAML::Node& name, const std::vector<FleetFileKind>& kinds)
{
    const std::string text = name.IsScalar() ? name.Scalar() : "";
    std::string names;
    for (std::size_t k = 0; k < kinds.size(); ++k) {
        if (kinds[k].name == text) return k;
        names += (k == 0 ? "" : ", ") + kinds[k].name;
    }
    map.fail("kinds", "has \"" + text + "\", needs names of robots: " + names);
}

std::vector<KindDistance> distances_in(const YamlMap& root, const std::vector<FleetFileKind>& kinds)
{
    std::vector<KindDistance> out;
    if (!root.has("between")) return out;
    for (const YAML::Node& node : root.list("between")) {
        const YamlMap map(node, root.file(), "between " + std::to_string(out.size() + 1));
        map.only({"kinds", "distance"});
        const YAML::Node pair = map.list("kinds");
        if (pair.size() != 2) map.fail("kinds", "has " + std::to_string(pair.size()) + " names, needs 2");
        out.push_back(
            {kind_called(map, pair[0], kinds), kind_called(map, pair[1], kinds), at_least_zero(map, "distance")});
    }
    return out;
}

bool truth_in(const YamlMap& map, const std::string& key)
{
    return map.has(key) && map.one_of(key, {"true", "false"}, "") == "true";
}

/// Throws FileError if a formation of the whole fleet meets keys of kinds that it does not go together with.
void check_formation_of_all(const YamlMap& root, const std::vector<FleetFileKind>& kinds)
{
    for (const FleetFileKind& kind : kinds) {
        const auto fail = [&](const std::string& key) {
            root.fail("formation", "is for the whole fleet, but the robots \"" + kind.name + "\" have " + key);
        };
        if (kind.formation) fail("a formation, too");
        if (!kind.count) fail("no number of robots (count is fill)");
        if (kind.yaw) fail("a yaw, which the formation sets");
    }
}

}  // namespace

FleetFile read_fleet(const std::filesystem::path& file)
{
    const YamlMap root = read_yaml(file, "spawnfield-fleet/1");
    root.only({"format", "robots", "min_distance", "between", "one_island", "formation"});
    FleetFile out;
    std::set<std::string> names;
    for (const YAML::Node& node : root.list("robots")) {
        const std::string line = " (line " + std::to_string(node.Mark().line + 1) + ")";
        const YamlMap first(node, file.string(), "robots " + std::to_string(out.kinds.size() + 1));
        const std::string place = "robots \"" + first.text("name") + "\"";
        FleetFileKind& kind = out.kinds.emplace_back(kind_in({node, file.string(), place}, file.parent_path()));
        kind.place = place + line;
        if (!names.insert(kind.name).second) first.fail("name", "is \"" + kind.name + "\", which is given twice");
    }
    if (out.kinds.empty()) root.fail("robots", "is empty, needs at least one kind of robots");
    if (root.has("min_distance")) out.min_distance = at_least_zero(root, "min_distance");
    out.between = distances_in(root, out.kinds);
    out.one_island = truth_in(root, "one_island");
    if (out.one_island)
        for (std::size_t k = 1; k < out.kinds.size(); ++k)
            if (out.kinds[k].island)
                root.fail("one_island", "is true, but the robots \"" + out.kinds[k].name +
                                            "\" have an island; only the first kind may have one");
    if (!root.has("formation")) return out;
    out.formation = formation_in(root.map("formation"));
    check_formation_of_all(root, out.kinds);
    return out;
}

}  // namespace spawnfield
