#include "base/base64.h"
#include "export/tessellation.h"
#include "picture/palette.h"
#include "poses/judged_pose.h"
#include "review/layer.h"
#include "review/page_shell.h"
#include "review/page_spawns.h"
#include "review/world_mesh.h"

#include <spawnfield/error.h>
#include <spawnfield/review.h>

#include <cmath>
#include <cstdio>

namespace spawnfield {
namespace {

constexpr std::string_view data_line = "<!--spawnfield-data-->";

Json numbers(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

Json bounds_json(const Bounds& bounds) { return {{"min", numbers(bounds.min)}, {"max", numbers(bounds.max)}}; }

/// Returns a colour as in CSS.
std::string css_colour(std::uint32_t colour)
{
    char text[8];
    std::snprintf(text, sizeof text, "#%06x", colour & 0xffffff);
    return text;
}

const char* words_of(Verdict verdict)
{
    switch (verdict) {
    case Verdict::Outside: return "Outside the map";
    case Verdict::Aerial: return "No ground below, or too far below";
    case Verdict::OffTerrain: return "On an obstacle, not on terrain";
    case Verdict::Submerged: return "The ground is under water";
    case Verdict::Collision: return "It meets something solid, or has no room";
    case Verdict::Steep: return "Too steep";
    case Verdict::Unstable: return "It would tip over or slide";
    case Verdict::Obstructed: return "Something is above it";
    case Verdict::Unreachable: return "It cannot be reached";
    case Verdict::Valid: return "The robot can stand here";
    }
    return "";
}

Json verdicts_json()
{
    Json out = Json::array();
    for (std::size_t v = 0; v < verdict_count; ++v)
        out.push_back({{"name", to_string(Verdict(v))},
                       {"color", css_colour(verdict_palette[v])},
                       {"words", words_of(Verdict(v))}});
    return out;
}

Json parts_json(const Map& map)
{
    Json out = Json::array();
    for (const Part& part : map.geometry.parts())
        out.push_back({{"name", part.name}, {"label", to_string(part.label)}, {"kind", part.kind}});
    return out;
}

Json add_world(PackWriter& pack, const WorldMesh& world)
{
    Json meshes = Json::array();
    for (const LabelMesh& mesh : world.meshes)
        meshes.push_back({{"label", to_string(mesh.label)},
                          {"offset", numbers(mesh.offset)},
                          {"scale", mesh.scale},
                          {"positions", pack.corners(mesh.corners)},
                          {"indices", pack.triangles(mesh.indices, mesh.corners.size())},
                          {"parts", mesh.parts}});
    const double share = world.triangles > 0 ? double(world.shown) / double(world.triangles) : 1;
    return {{"triangles", world.triangles}, {"share", share}, {"meshes", meshes}};
}

Json add_robot(PackWriter& pack, const Robot& robot)
{
    constexpr int sides = 16;
    std::vector<float> positions;
    std::vector<std::uint32_t> indices;
    for (const RobotPart& part : robot.parts)
        tessellate(part, sides, [&](const Vec3& a, const Vec3& b, const Vec3& c) {
            for (const Vec3& corner : {a, b, c}) {
                indices.push_back(std::uint32_t(positions.size() / 3));
                positions.insert(positions.end(), {float(corner.x()), float(corner.y()), float(corner.z())});
            }
        });
    return {{"name", robot_name(robot)},
            {"bounds", bounds_json(robot.bounds())},
            {"positions", pack.plain(std::span<const float>(positions), 3)},
            {"indices", pack.plain(std::span<const std::uint32_t>(indices))}};
}

Json floors_json(const std::vector<Floor>& floors)
{
    Json out = Json::array();
    for (const Floor& floor : floors) {
        const auto limit = [](double z) { return std::isfinite(z) ? Json(z) : Json(); };
        out.push_back({{"name", "floor " + std::to_string(out.size())},
                       {"height", floor.height},
                       {"z", {limit(floor.z.low), limit(floor.z.high)}}});
    }
    return out;
}

Json islands_json(const ReviewContents& contents)
{
    Json out = Json::array();
    if (!contents.graph) return out;
    for (const Island& island : contents.graph->islands())
        out.push_back({{"number", out.size()},
                       {"area", island.area},
                       {"center", numbers(island.place)},
                       {"z", {island.low, island.high}}});
    return out;
}

void check(const ReviewContents& contents)
{
    if (!contents.pairs.empty() && !contents.graph)
        throw ArgumentError("write_review", "pairs need a graph, because paths lead between places of it");
    for (const RasterResult& raster : contents.rasters)
        if (raster.poses.size() > most_layer_poses)
            throw ArgumentError("write_review", "poses of a raster", double(raster.poses.size()),
                                "at most " + std::to_string(most_layer_poses) + "; take a larger step");
    const auto check_list = [](const std::string& file, std::size_t poses) {
        if (poses > most_list_poses)
            throw FileError(file, "has " + std::to_string(poses) + " rows, a page shows at most " +
                                      std::to_string(most_list_poses));
    };
    for (const ReviewSpawns& list : contents.spawns) check_list(list.file, list.table.poses.size());
    for (const ReviewPairs& list : contents.pairs) check_list(list.file, list.table.starts.poses.size());
    if (contents.most_triangles == 0) throw ArgumentError("write_review", "most_triangles", 0, "at least 1");
}

/// Adds what does not change while a page is open.
void add_scene(Json& head, PackWriter& pack, const Judge& judge, const ReviewContents& contents,
               const RunOptions& options)
{
    const Map& map = judge.map();
    const Bounds& bounds = map.geometry.bounds();
    const Vec3 origin = bounds.is_empty() ? Vec3::Zero() : Vec3(((bounds.min + bounds.max) / 2).array().round());
    head["map"] = {
        {"name", map.name}, {"hash", map.hash}, {"resolution", map.resolution}, {"bounds", bounds_json(map.bounds)}};
    head["origin"] = numbers(origin);
    head["verdicts"] = verdicts_json();
    head["parts"] = parts_json(map);
    head["world"] = add_world(pack, world_mesh(map.geometry, origin, contents.most_triangles, options.threads));
    head["floors"] = floors_json(contents.floors);
    head["islands"] = islands_json(contents);
    if (!contents.live.empty()) head["live"] = Json::parse(contents.live);
}

}  // namespace

std::string review_pack(const Judge& judge, const ReviewContents& contents, const RunOptions& options)
{
    check(contents);
    const bool is_settled = contents.stance == Stance::Settled;
    PackWriter pack(contents.is_update);
    Json head{{"format", "spawnfield-review/1"},
              {"program", "spawnfield " + version()},
              {"title", contents.title.empty() ? judge.map().name + ", " + robot_name(judge.robot()) : contents.title},
              {"command", contents.command},
              {"colors", contents.colors},
              {"settings", judge_settings_json(judge, is_settled)},
              {"robot", add_robot(pack, judge.robot())}};
    if (!contents.is_update) add_scene(head, pack, judge, contents, options);
    Json layers = Json::array(), spawns = Json::array(), pairs = Json::array();
    for (std::size_t i = 0; i < contents.rasters.size(); ++i) {
        RunOptions part = options;
        if (options.progress)
            part.progress = [&, i](double share) {
                options.progress((double(i) + share) / double(contents.rasters.size()));
            };
        layers.push_back(add_layer(pack, judge, contents.rasters[i], contents, part));
    }
    for (const ReviewSpawns& list : contents.spawns) spawns.push_back(spawns_for_page(judge, list, contents, options));
    for (const ReviewPairs& list : contents.pairs)
        pairs.push_back(pairs_for_page(judge, *contents.graph, list, options));
    head["layers"] = std::move(layers);
    head["spawns"] = std::move(spawns);
    head["pairs"] = std::move(pairs);
    return pack.finish(head);
}

bool has_review_page() { return !page_shell().empty(); }

void require_review_page()
{
    if (!has_review_page())
        throw std::runtime_error(
            "this program was built without the review page; run tools/build-web.sh, and build it again");
}

void write_review(const Judge& judge, const ReviewContents& contents, const std::function<void(std::string_view)>& sink,
                  const RunOptions& options)
{
    require_review_page();
    const std::string_view shell = page_shell();
    const std::size_t place = shell.find(data_line);
    if (place == shell.npos) throw std::logic_error("the review page has no place for its data");
    const std::string pack = review_pack(judge, contents, options);
    sink(shell.substr(0, place));
    sink("<script type=\"application/octet-stream\" id=\"spawnfield-data\">");
    sink(base64(pack));
    sink("</script>");
    sink(shell.substr(place + data_line.size()));
}

}  // namespace spawnfield
