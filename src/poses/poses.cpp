#include "base/csv.h"
#include "base/number.h"
#include "base/rotation.h"
#include "poses/line_texts.h"
#include "poses/pose_columns.h"
#include "poses/pose_json.h"

#include <spawnfield/error.h>
#include <spawnfield/poses.h>
#include <spawnfield/spawn_file.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <limits>
#include <span>

namespace spawnfield {
namespace {

/// Appends the fields of a line as they are written, with their quotes, each followed by a comma. Fields with a 1 in
/// `left_out` are left out.
void append_fields(std::string& text, const std::string& line, const std::vector<std::uint8_t>& left_out)
{
    if (std::find(left_out.begin(), left_out.end(), 1) == left_out.end()) {
        text += line + ',';
        return;
    }
    const std::vector<std::string_view> fields = raw_csv_fields(line);
    for (std::size_t i = 0; i < fields.size(); ++i)
        if (left_out[i] == 0) text.append(fields[i]) += ',';
}

Json bounds_json(const Bounds& bounds, int axes)
{
    Json out = Json::array();
    for (const Vec3& corner : {bounds.min, bounds.max})
        for (int axis = 0; axis < axes; ++axis) out.push_back(corner[axis]);
    return out;
}

Json layers_json(const LayerChoice& layers)
{
    switch (layers.kind) {
    case LayerChoice::Kind::Top: return "top";
    case LayerChoice::Kind::Bottom: return "bottom";
    case LayerChoice::Kind::Index: return layers.index;
    case LayerChoice::Kind::All: break;
    }
    return "all";
}

/// Returns the two limits. An infinite limit becomes null.
Json z_json(const ZRange& z)
{
    const auto limit = [](double value) { return std::isfinite(value) ? Json(value) : Json(); };
    return {limit(z.low), limit(z.high)};
}

/// Returns the settings that `sample` and `search` share. Limits that are infinite are left out.
template <class Options>
Json settings_json(const Options& options, const Judge& judge, int axes)
{
    Json out = {{"count", options.count}, {"min_distance", options.min_distance}, {"seed", options.seed}};
    const bool is_chosen = options.heading || options.random_yaw;
    out["yaw"] = is_chosen ? Json(yaw_text(options.heading, options.random_yaw, options.yaw)) : Json(options.yaw);
    out["bounds"] = bounds_json(options.bounds.is_empty() ? judge.map().bounds : options.bounds, axes);
    const JudgeOptions& limits = judge.options();
    if (std::isfinite(limits.max_water_depth)) out["max_water_depth"] = limits.max_water_depth;
    if (std::isfinite(limits.max_slope)) out["max_slope"] = limits.max_slope;
    for (const Region& region : options.area.within) out["region"].push_back(region.name);
    for (const Region& region : options.area.keep_out) out["keep_out"].push_back(region.name);
    for (const AvoidedPoints& group : options.avoid)
        out["avoid"].push_back({{"poses", group.name}, {"count", group.points.size()}, {"distance", group.distance}});
    return out;
}

/// Throws ArgumentError unless a list of settled spawns has a rest for each of them.
void check_rests(const char* function, const SpawnList& list)
{
    if (list.stance == Stance::Settled && list.rests.size() != list.spawns.size())
        throw ArgumentError(function, "size of list.rests", double(list.rests.size()),
                            "as many as its spawns, because they are settled");
}

/// Returns the measured columns that the files of spawns do not have anyway.
std::vector<PlaceColumn> own_columns(const SpawnList& list)
{
    const std::string length_name = list.stance == Stance::Settled ? free_length_column(list.heading) : "";
    std::vector<PlaceColumn> out;
    for (const PlaceColumn& column : list.columns) {
        const std::string name = to_string(column.quantity);
        if (column.values.size() != list.spawns.size())
            throw ArgumentError("size of the column " + name + " is " + std::to_string(column.values.size()) +
                                ", needs as many values as there are spawns");
        if (name != "tilt" && name != "margin" && name != length_name) out.push_back(column);
    }
    return out;
}

/// Adds the poses to `out`, with the rests of settled spawns, and returns its text. `list` is nullptr for poses that
/// are not spawns.
std::string finished(Json out, const SpawnList* list, std::span<const RobotStart> robots)
{
    const bool has_rests = list != nullptr && list->stance == Stance::Settled;
    const std::string length_name = has_rests ? free_length_column(list->heading) : "";
    out["poses"] = Json::array();
    const std::vector<PlaceColumn> columns = list == nullptr ? std::vector<PlaceColumn>() : own_columns(*list);
    for (std::size_t i = 0; i < robots.size(); ++i) {
        Json pose = pose_json(robots[i]);
        if (has_rests) {
            pose["tilt"] = list->rests[i].tilt;
            pose["margin"] = list->rests[i].margin;
        }
        if (!length_name.empty()) pose[length_name] = list->rests[i].free_length;
        for (const PlaceColumn& column : columns)  // JSON has no NaN: null
            pose[to_string(column.quantity)] = std::isnan(column.values[i]) ? Json() : Json(column.values[i]);
        out["poses"].push_back(std::move(pose));
    }
    return json_text(out, 2) + "\n";
}

/// Adds the counts and the spawns to `out`, and returns its text.
std::string with_spawns(Json out, const SpawnList& list, std::span<const RobotStart> robots)
{
    check_rests("spawns_json", list);
    for (const Verdict verdict : all_verdicts) out["counts"][to_string(verdict)] = list.counts[verdict];
    return finished(std::move(out), &list, robots);
}

void name_all(std::vector<RobotStart>& robots, const std::vector<std::string>& names,
              const std::vector<std::string>& name_spaces)
{
    for (std::size_t i = 0; i < names.size(); ++i) robots.at(i).name = names[i];
    for (std::size_t i = 0; i < name_spaces.size(); ++i) robots.at(i).name_space = name_spaces[i];
}

}  // namespace

void append_numbers(std::string& text, std::initializer_list<double> values)
{
    std::array<char, 512> row;
    char* end = row.data();
    for (const double value : values) {
        if (end != row.data()) *end++ = ',';
        end = write_number(end, value);
    }
    text.append(row.data(), end);
}

void append_if_known(std::string& text, double value)
{
    text += ',';
    if (!std::isnan(value)) append_number(text, value);
}

std::string free_length_column(const std::optional<HeadingRule>& rule)
{
    if (rule && rule->kind == HeadingRule::Kind::Clearest) return "clearance";
    if (rule && rule->kind == HeadingRule::Kind::Along) return "way";
    return "";
}

void write_with_columns(const PoseTable& table, const std::vector<std::string>& names, bool header, int threads,
                        const std::function<void(std::string_view)>& sink,
                        const std::function<void(std::string&, std::size_t)>& append)
{
    std::vector<std::uint8_t> replaced;
    for (const std::string& name : csv_fields(table.header))
        replaced.push_back(std::find(names.begin(), names.end(), name) != names.end());
    if (header) {
        std::string text;
        append_fields(text, table.header, replaced);
        for (std::size_t k = 0; k < names.size(); ++k) text += (k > 0 ? "," : "") + names[k];
        sink(text + '\n');
    }
    std::vector<std::string> texts;
    write_lines(table.poses.size(), threads, sink, texts, [&](std::string& text, std::size_t first, std::size_t end) {
        for (std::size_t i = first; i < end; ++i) {
            append_fields(text, table.rows[i], replaced);
            append(text, i);
            text += '\n';
        }
    });
}

std::string with_columns(const PoseTable& table, const std::vector<std::string>& names,
                         const std::function<void(std::string&, std::size_t)>& append)
{
    std::string out;
    write_with_columns(
        table, names, true, 1, [&](std::string_view text) { out += text; }, append);
    return out;
}

std::vector<Spawn> spawns_of(const PoseTable& table)
{
    std::vector<Spawn> out;
    for (const Pose& pose : table.poses) out.push_back({pose.position, yaw_of(pose.rotation)});
    return out;
}

std::vector<std::string> column_of(const PoseTable& table, const std::string& name)
{
    const std::vector<std::string> names = csv_fields(table.header);
    const auto column = std::find(names.begin(), names.end(), name);
    if (column == names.end()) return {};
    std::vector<std::string> out;
    for (const std::string& row : table.rows) out.push_back(csv_fields(row)[std::size_t(column - names.begin())]);
    return out;
}

std::vector<Verdict> verdicts_of(const PoseTable& table, const std::filesystem::path& file)
{
    std::vector<Verdict> out;
    for (const std::string& text : column_of(table, "verdict")) {
        std::size_t verdict = 0;
        while (verdict < verdict_count && text != to_string(Verdict(verdict))) ++verdict;
        if (verdict == verdict_count)
            throw FileError(file.string(), "pose " + std::to_string(out.size() + 1) + ": column verdict is \"" + text +
                                               "\", needs the name of a verdict, for example valid or collision");
        out.push_back(Verdict(verdict));
    }
    return out;
}

std::vector<std::string> replaced_columns(const PoseTable& table, bool settled, bool repairs)
{
    std::vector<std::string> names = csv_fields(table.header);
    std::erase_if(names, [&](const std::string& name) { return !is_verdict_column(name, settled, repairs); });
    return names;
}

std::vector<RobotStart> robot_starts(const SpawnList& list, const std::vector<std::string>& names,
                                     const std::vector<std::string>& name_spaces)
{
    std::vector<RobotStart> out;
    for (const Spawn& spawn : list.spawns)
        out.push_back({{}, {}, spawn.position, {spawn.roll, spawn.pitch, spawn.yaw}});
    name_all(out, names, name_spaces);
    return out;
}

std::vector<RobotStart> robot_starts(const PoseTable& table, const std::vector<std::string>& names,
                                     const std::vector<std::string>& name_spaces)
{
    std::vector<RobotStart> out;
    for (const Pose& pose : table.poses) out.push_back({{}, {}, pose.position, rpy_from(pose.rotation)});
    name_all(out, names, name_spaces);
    return out;
}

std::string robots_csv(std::span<const RobotStart> robots)
{
    const bool named = !robots.empty() && !robots[0].name.empty();
    std::string text = named ? "name,x,y,z,roll,pitch,yaw\n" : "x,y,z,roll,pitch,yaw\n";
    for (const RobotStart& robot : robots) {
        if (named) text += csv_quoted(robot.name) + ',';
        append_numbers(text, {robot.position.x(), robot.position.y(), robot.position.z(), robot.rpy.roll,
                              robot.rpy.pitch, robot.rpy.yaw});
        text += '\n';
    }
    return text;
}

std::string spawns_csv(const SpawnList& list, std::span<const std::string> names)
{
    std::string text;
    write_spawns_csv(list, names, [&](std::string_view piece) { text += piece; });
    return text;
}

void write_spawns_csv(const SpawnList& list, std::span<const std::string> names,
                      const std::function<void(std::string_view)>& sink)
{
    constexpr std::size_t piece = 1 << 16;  // characters; it stays in the cache
    check_rests("spawns_csv", list);
    const bool is_settled = list.stance == Stance::Settled;
    const std::string length_name = free_length_column(list.heading);
    std::string text = names.empty() ? "x,y,z,roll,pitch,yaw" : "name,x,y,z,roll,pitch,yaw";
    if (is_settled) text += ",tilt,margin";
    if (!length_name.empty()) text += "," + length_name;
    const std::vector<PlaceColumn> columns = own_columns(list);
    for (const PlaceColumn& column : columns) (text += ',') += to_string(column.quantity);
    text += '\n';
    for (std::size_t i = 0; i < list.spawns.size(); ++i) {
        const Spawn& spawn = list.spawns[i];
        const Vec3& position = spawn.position;
        if (!names.empty()) text += csv_quoted(names[i]) + ',';
        append_numbers(text, {position.x(), position.y(), position.z(), spawn.roll, spawn.pitch, spawn.yaw});
        if (is_settled) {
            text += ',';
            append_numbers(text, {list.rests[i].tilt, list.rests[i].margin});
        }
        if (!length_name.empty()) append_if_known(text, list.rests[i].free_length);
        for (const PlaceColumn& column : columns) append_if_known(text, column.values[i]);
        text += '\n';
        if (text.size() < piece) continue;
        sink(text);
        text.clear();
    }
    sink(text);
}

Json sample_settings_json(const SampleOptions& options, const Judge& judge)
{
    Json settings = settings_json(options, judge, 2);
    if (options.stance == Stance::Settled)
        add_stand_limits(settings, judge.options().stand);
    else
        settings["offset"] = options.offset.value_or(auto_offset(judge.robot()));
    if (!options.z.is_unlimited()) settings["z"] = z_json(options.z);
    settings["layers"] = layers_json(options.layers);
    if (const std::string rules = to_string(options.place); !rules.empty()) settings["place"] = rules;
    for (const auto& [quantity, weight] : options.measures.prefer) settings["prefer"][to_string(quantity)] = weight;
    if (options.measures.sensor_height) settings["sensor_height"] = *options.measures.sensor_height;
    if (asks_for(options.measures, PlaceQuantity::View)) settings["view_range"] = options.measures.view_range;
    if (asks_for(options.measures, PlaceQuantity::Room)) settings["room_range"] = options.measures.room_range;
    if (!options.place.facing.empty()) settings["yaw"] = "facing " + options.place.facing;
    if (!options.reachable_name.empty()) settings["islands"] = options.reachable_name;
    return settings;
}

std::string spawns_json(std::span<const RobotStart> robots, const SpawnList& list, const Judge& judge,
                        const SampleOptions& options)
{
    Json out = json_head("sample", judge.map(), judge.robot(), sample_settings_json(options, judge));
    if (list.is_stopped) out["interrupted"] = true;
    out["full"] = list.is_full;
    out["undecided_area"] = list.undecided_area;
    return with_spawns(std::move(out), list, robots);
}

std::string spawns_json(std::span<const RobotStart> robots, const SpawnList& list, const Judge& judge,
                        const SearchOptions& options)
{
    Json settings = settings_json(options, judge, 3);
    if (options.stance == Stance::Settled) add_stand_limits(settings, judge.options().stand);
    settings["max_height"] = judge.options().max_height;
    settings["max_failures"] = options.max_failures;
    Json out = json_head("search", judge.map(), judge.robot(), std::move(settings));
    if (list.is_stopped) out["interrupted"] = true;
    return with_spawns(std::move(out), list, robots);
}

std::string poses_json(std::span<const RobotStart> robots, const Map& map, const Robot& robot)
{
    return finished(json_head("export", map, robot, {}), nullptr, robots);
}

}  // namespace spawnfield
