#include "base/csv.h"
#include "base/input_file.h"
#include "base/number.h"
#include "base/text.h"
#include "query/pose_json.h"

#include <spawnfield/error.h>
#include <spawnfield/poses.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cctype>
#include <cmath>

namespace spawnfield {
namespace {

bool is_pose_column(const std::string& name)
{
    constexpr std::array names{"x", "y", "z", "roll", "pitch", "yaw", "qx", "qy", "qz", "qw"};
    return std::find(names.begin(), names.end(), name) != names.end();
}

bool is_verdict_column(const std::string& name)
{
    constexpr std::array names{"verdict", "ground", "height_above", "hit"};
    return std::find(names.begin(), names.end(), name) != names.end();
}

/// The line's fields as they are written, quotes and all, each with a comma behind it, but those that are flagged.
void append_fields(std::string& text, const std::string& line, const std::vector<std::uint8_t>& left_out)
{
    if (std::find(left_out.begin(), left_out.end(), 1) == left_out.end()) {
        text += line + ',';
        return;
    }
    std::size_t field = 0, start = 0;
    bool quoted = false;
    for (std::size_t i = 0; i <= line.size(); ++i) {
        if (i < line.size() && line[i] == '"') quoted = !quoted;
        if (i < line.size() && (line[i] != ',' || quoted)) continue;
        if (left_out[field++] == 0) text.append(line, start, i - start) += ',';
        start = i + 1;
    }
}

/// Which field holds what; -1: not in the file.
struct PoseColumns {
    int x, y, z, roll, pitch, yaw, qx, qy, qz, qw;
    std::size_t count;
    bool has_quaternion() const { return qx >= 0; }
};

class PoseReader {
public:
    explicit PoseReader(const std::filesystem::path& file) : file_(file.string()) {}

    PoseTable read(const std::string& text)
    {
        PoseTable table;
        PoseColumns columns{};
        bool has_header = false;
        for (std::size_t start = 0; start < text.size();) {
            const std::size_t end = std::min(text.find('\n', start), text.size());
            std::string line = text.substr(start, end - start);
            start = end + 1;
            ++line_;
            if (line_ == 1 && line.starts_with(byte_order_mark)) line.erase(0, 3);  // byte order mark
            if (!line.empty() && line.back() == '\r') line.pop_back();
            if (line.find_first_not_of(" \t") == std::string::npos) continue;
            if (!has_header) {
                columns = read_header(line);
                tell_other_case(line, table);
                table.header = line;
                has_header = true;
                continue;
            }
            if (std::count(line.begin(), line.end(), '"') % 2 != 0) fail("has a quote that is not closed");
            table.poses.push_back(read_pose(csv_fields(line), columns));
            table.rows.push_back(std::move(line));
        }
        if (!has_header) throw FileError(file_, "is empty, needs a header x,y,z,roll,pitch,yaw");
        if (table.poses.empty()) table.notices.push_back(file_ + ": has a header, but no poses");
        return table;
    }

private:
    PoseColumns read_header(const std::string& line) const
    {
        const auto names = csv_fields(line);
        const auto find = [&](const std::string& name) {
            const auto at = std::find(names.begin(), names.end(), name);
            if (at != names.end() && std::find(at + 1, names.end(), name) != names.end()) fail("column " + name + " is given twice");
            return at == names.end() ? -1 : int(at - names.begin());
        };
        PoseColumns c{find("x"),  find("y"),  find("z"),  find("roll"), find("pitch"),
                      find("yaw"), find("qx"), find("qy"), find("qz"), find("qw"), names.size()};
        for (const auto& [column, name] : {std::pair{c.x, "x"}, std::pair{c.y, "y"}, std::pair{c.z, "z"}})
            if (column < 0) {
                const auto other = std::find_if(names.begin(), names.end(), [&](const std::string& n) { return lower_case(n) == name; });
                fail(std::string("column ") + name + " is missing, needs a header x,y,z,roll,pitch,yaw" +
                     (other == names.end() ? "" : "; there is " + *other + ", but names are lower case"));
            }
        const int quaternions = (c.qx >= 0) + (c.qy >= 0) + (c.qz >= 0) + (c.qw >= 0);
        if (quaternions != 0 && quaternions != 4) fail("has some of the columns qx,qy,qz,qw, needs all four or none");
        if (quaternions == 4 && (c.roll >= 0 || c.pitch >= 0 || c.yaw >= 0))
            fail("has columns qx,qy,qz,qw beside roll,pitch,yaw, needs one of the two");
        return c;
    }

    /// A name that is known but for its case is read as any other: not at all.
    void tell_other_case(const std::string& header, PoseTable& table) const
    {
        for (const std::string& name : csv_fields(header)) {
            const std::string lower = lower_case(name);
            if (name == lower || !is_pose_column(lower)) continue;
            table.notices.push_back(file_ + ": column " + name + " is carried along, not read: names are lower case (" + lower + ")");
        }
    }

    Pose read_pose(const std::vector<std::string>& fields, const PoseColumns& c) const
    {
        if (fields.size() != c.count)
            fail("has " + std::to_string(fields.size()) + " fields, the header has " + std::to_string(c.count));
        Pose pose;
        pose.position = {number_in(fields, c.x, "x"), number_in(fields, c.y, "y"), number_in(fields, c.z, "z")};
        if (!c.has_quaternion()) {
            pose.rotation = rotation_from_rpy(number_in(fields, c.roll, "roll"), number_in(fields, c.pitch, "pitch"),
                                              number_in(fields, c.yaw, "yaw"));
            return pose;
        }
        const Eigen::Quaterniond q(number_in(fields, c.qw, "qw"), number_in(fields, c.qx, "qx"), number_in(fields, c.qy, "qy"),
                                   number_in(fields, c.qz, "qz"));
        if (!(std::abs(q.norm() - 1) <= 1e-3)) fail("the quaternion's length is " + number(q.norm()) + ", needs 1 (to 0.001)");
        pose.rotation = q.normalized().toRotationMatrix();
        return pose;
    }

    double number_in(const std::vector<std::string>& fields, int column, const char* name) const
    {
        if (column < 0) return 0;
        double value = 0;
        const std::string& text = fields[std::size_t(column)];
        if (!parse_number(text, value)) fail(std::string("column ") + name + " is \"" + text + "\", needs a number");
        if (!std::isfinite(value)) fail(std::string("column ") + name + " is " + text + ", needs a finite number");
        return value;
    }

    [[noreturn]] void fail(const std::string& what) const { throw FileError(file_, "line " + std::to_string(line_) + ": " + what); }

    const std::string file_;
    int line_ = 0;
};

void append_numbers(std::string& text, std::initializer_list<double> values)
{
    bool first = true;
    for (const double value : values) {
        if (!first) text += ',';
        first = false;
        append_number(text, value);
    }
}

void append_row(std::string& text, const RasterPose& pose, double yaw)
{
    append_numbers(text, {pose.x, pose.y, pose.z, yaw});
    text += ',';
    if (pose.layer >= 0) text += std::to_string(pose.layer);
    text += ',';
    text += to_string(pose.verdict);
    text += '\n';
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

/// An infinite limit is null.
Json z_json(const ZRange& z)
{
    const auto limit = [](double value) { return std::isfinite(value) ? Json(value) : Json(); };
    return {limit(z.low), limit(z.high)};
}

/// What both commands have; a limit that there is not is left out.
Json settings_json(const SpawnOptions& options, const Map& map, int axes)
{
    Json out = {{"count", options.count}, {"min_distance", options.min_distance}, {"seed", options.seed}};
    out["yaw"] = options.random_yaw ? Json("random") : Json(options.yaw);
    out["bounds"] = bounds_json(options.bounds.is_empty() ? map.bounds : options.bounds, axes);
    if (std::isfinite(options.max_water_depth)) out["max_water_depth"] = options.max_water_depth;
    if (std::isfinite(options.max_slope)) out["max_slope"] = options.max_slope;
    for (const Region& region : options.area.within) out["region"].push_back(region.name);
    for (const Region& region : options.area.keep_out) out["keep_out"].push_back(region.name);
    return out;
}

std::string finished(Json out, const std::optional<VerdictCounts>& counts, std::span<const RobotStart> robots)
{
    for (std::size_t verdict = 0; counts && verdict < verdict_count; ++verdict) out["counts"][to_string(Verdict(verdict))] = (*counts)[verdict];
    out["poses"] = Json::array();
    for (const RobotStart& robot : robots) out["poses"].push_back(pose_json(robot));
    return json_text(out, 2) + "\n";
}

void name_all(std::vector<RobotStart>& robots, const std::vector<std::string>& names, const std::vector<std::string>& name_spaces)
{
    for (std::size_t i = 0; i < names.size(); ++i) robots.at(i).name = names[i];
    for (std::size_t i = 0; i < name_spaces.size(); ++i) robots.at(i).name_space = name_spaces[i];
}

}  // namespace

PoseTable read_poses(const std::filesystem::path& file)
{
    const std::string text = read_file(file);
    return PoseReader(file).read(text);
}

std::vector<Spawn> spawns_of(const PoseTable& table)
{
    std::vector<Spawn> out;
    for (const Pose& pose : table.poses)
        out.push_back({pose.position, std::atan2(pose.rotation(1, 0), pose.rotation(0, 0))});
    return out;
}

std::vector<std::string> column_of(const PoseTable& table, const std::string& name)
{
    const std::vector<std::string> names = csv_fields(table.header);
    const auto at = std::find(names.begin(), names.end(), name);
    if (at == names.end()) return {};
    std::vector<std::string> out;
    for (const std::string& row : table.rows) out.push_back(csv_fields(row)[std::size_t(at - names.begin())]);
    return out;
}

std::vector<Verdict> verdicts_of(const PoseTable& table, const std::filesystem::path& file)
{
    std::vector<Verdict> out;
    for (const std::string& text : column_of(table, "verdict")) {
        std::size_t verdict = 0;
        while (verdict < verdict_count && text != to_string(Verdict(verdict))) ++verdict;
        if (verdict == verdict_count)
            throw FileError(file.string(), "pose " + std::to_string(out.size() + 1) + ": column verdict is \"" + text + "\", needs a verdict's name, as valid or collision");
        out.push_back(Verdict(verdict));
    }
    return out;
}

std::vector<std::string> replaced_columns(const PoseTable& table)
{
    std::vector<std::string> names = csv_fields(table.header);
    std::erase_if(names, [](const std::string& name) { return !is_verdict_column(name); });
    return names;
}

std::string verdicts_csv(const PoseTable& table, const std::vector<Judgement>& judgements, const std::vector<Part>& parts)
{
    std::vector<std::uint8_t> replaced;
    for (const std::string& name : csv_fields(table.header)) replaced.push_back(is_verdict_column(name));
    std::string text;
    append_fields(text, table.header, replaced);
    text += "verdict,ground,height_above,hit\n";
    for (std::size_t i = 0; i < judgements.size(); ++i) {
        const Judgement& judged = judgements[i];
        append_fields(text, table.rows[i], replaced);
        text += to_string(judged.verdict);
        text += ',';
        if (judged.ground) append_numbers(text, {judged.ground->height, table.poses[i].position.z() - judged.ground->height});
        else text += ',';
        text += ',';
        if (judged.hit) text += judged.hit->part == CollisionHit::occupancy ? "occupancy" : csv_quoted(parts[judged.hit->part].name);
        text += '\n';
    }
    return text;
}

void write_raster_csv(const RasterResult& raster, bool aerial, const std::function<void(std::string_view)>& sink)
{
    constexpr std::size_t piece = 1 << 20;
    std::string text = "x,y,z,yaw,layer,verdict\n";
    for_each_pose(raster, aerial, [&](const RasterPose& pose) {
        append_row(text, pose, raster.yaw);
        if (text.size() < piece) return;
        sink(text);
        text.clear();
    });
    sink(text);
}

std::vector<RobotStart> robot_starts(const SpawnList& list, const std::vector<std::string>& names, const std::vector<std::string>& name_spaces)
{
    std::vector<RobotStart> out;
    for (const Spawn& spawn : list.spawns) out.push_back({{}, {}, spawn.position, {0, 0, spawn.yaw}});
    name_all(out, names, name_spaces);
    return out;
}

std::vector<RobotStart> robot_starts(const PoseTable& table, const std::vector<std::string>& names, const std::vector<std::string>& name_spaces)
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
        append_numbers(text, {robot.position.x(), robot.position.y(), robot.position.z(), robot.rpy.roll, robot.rpy.pitch, robot.rpy.yaw});
        text += '\n';
    }
    return text;
}

std::string spawns_csv(const SpawnList& list)
{
    std::string text = "x,y,z,roll,pitch,yaw\n";
    for (const Spawn& spawn : list.spawns) {
        append_numbers(text, {spawn.position.x(), spawn.position.y(), spawn.position.z(), 0, 0, spawn.yaw});
        text += '\n';
    }
    return text;
}

std::string spawns_json(std::span<const RobotStart> robots, const SpawnList& list, const Map& map, const Robot& robot, const SampleOptions& options)
{
    Json settings = settings_json(options, map, 2);
    settings["offset"] = options.offset.value_or(auto_offset(robot));
    if (!options.z.is_unlimited()) settings["z"] = z_json(options.z);
    settings["layers"] = layers_json(options.layers);
    Json out = json_head("sample", map, robot, std::move(settings));
    out["full"] = list.is_full;
    out["undecided_area"] = list.undecided_area;
    return finished(std::move(out), list.counts, robots);
}

std::string spawns_json(std::span<const RobotStart> robots, const SpawnList& list, const Map& map, const Robot& robot, const SearchOptions& options)
{
    Json settings = settings_json(options, map, 3);
    settings["max_height"] = options.max_height;
    settings["max_failures"] = options.max_failures;
    return finished(json_head("search", map, robot, std::move(settings)), list.counts, robots);
}

std::string poses_json(std::span<const RobotStart> robots, const Map& map, const Robot& robot)
{
    return finished(json_head("export", map, robot, {}), std::nullopt, robots);
}

}  // namespace spawnfield
