#include "command.h"
#include "messages.h"
#include "numbers.h"
#include "output.h"
#include "picture_args.h"
#include "printable.h"
#include "reach_args.h"
#include "scene_args.h"

#include <spawnfield/error.h>
#include <spawnfield/frames.h>
#include <spawnfield/input_file.h>
#include <spawnfield/map.h>
#include <spawnfield/robot_picture.h>

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <span>
#include <sstream>

namespace spawnfield::cli {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

struct InfoArgs : QueryArgs, SceneArgs {
    std::string what;
    bool json = false, verify = false, islands = false;
    std::string picture;
    ReachArgs reach;
};

constexpr std::size_t most_lines = 60;  // of a list; --json has all

Json json_of(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

Json json_of(const Bounds& bounds) { return {{"min", json_of(bounds.min)}, {"max", json_of(bounds.max)}}; }

Json json_of(const GeoOrigin& origin)
{
    return {{"x", origin.x}, {"y", origin.y}, {"unit", origin.unit}, {"crs", origin.crs}};
}

/// Scenes may have many thousands of parts, so this does not use an initializer list, which copies.
Json json_of(const Part& part)
{
    Json::object_t out;
    out.reserve(7);
    out.emplace("name", part.name);
    out.emplace("kind", part.kind);
    out.emplace("label", to_string(part.label));
    out.emplace("triangles", part.triangles);
    out.emplace("solid_pieces", part.solid_pieces);
    out.emplace("sheet_pieces", part.sheet_pieces);
    out.emplace("open_edges", part.open_edges);
    return Json(std::move(out));
}

void add_contents(const LabelCounts& labels, std::span<const Part> parts, Json& out)
{
    for (const Label label : {Label::Terrain, Label::Obstacle, Label::Water})
        out["labels"][to_string(label)] = {{"triangles", labels[std::size_t(label)].triangles},
                                           {"primitives", labels[std::size_t(label)].primitives}};
    Json::array_t list;
    list.reserve(parts.size());
    for (const Part& part : parts) list.push_back(json_of(part));
    out["parts"] = std::move(list);
}

/// Returns the labels that occur in each part, in the order of Label.
Json labels_of_parts(const Scene& scene)
{
    std::vector<std::array<bool, 4>> found(scene.parts.size());
    for (std::size_t t = 0; t < scene.triangles.size(); ++t)
        found[scene.pieces[scene.triangle_pieces[t]].part][std::size_t(scene.triangle_labels[t])] = true;
    for (const Primitive& primitive : scene.primitives) found[primitive.part][std::size_t(primitive.label)] = true;
    Json out = Json::array();
    for (const std::array<bool, 4>& of_part : found) {
        Json labels = Json::array();
        for (const Label label : {Label::Terrain, Label::Obstacle, Label::Water})
            if (of_part[std::size_t(label)]) labels.push_back(to_string(label));
        out.push_back(std::move(labels));
    }
    return out;
}

/// Returns the names and labels of faces that label rules can match.
Json json_of(const FaceGroup& group)
{
    Json triangles = Json::object();
    for (const Label label : {Label::Terrain, Label::Obstacle, Label::Water, Label::Ignore})
        if (const std::uint64_t count = group.triangles[std::size_t(label)]; count > 0)
            triangles[to_string(label)] = count;
    return {
        {"node", group.node}, {"material", group.material}, {"triangles", triangles}, {"z", {group.low, group.high}}};
}

/// Adds a face group to the names of its part, which is entry `index` of the listed parts.
void add_group(const FaceGroup& group, const Part& part, std::size_t index, Json& out)
{
    if (part.kind != "mesh" || index >= out["parts"].size()) return;  // other kinds are meshes that spawnfield made
    out["parts"][index]["names"].push_back(json_of(group));
}

Json scene_json(const Scene& scene)
{
    Json out = {{"kind", "scene"},
                {"name", scene.name},
                {"bounds", json_of(scene.map_bounds.is_empty() ? scene.bounds() : scene.map_bounds)}};
    add_contents(scene.count_labels(), scene.parts, out);
    const Json labels = labels_of_parts(scene);
    for (std::size_t p = 0; p < scene.parts.size(); ++p) out["parts"][p]["labels"] = labels[p];
    for (const FaceGroup& group : scene.face_groups) add_group(group, scene.parts[group.part], group.part, out);
    for (const NameRule& rule : scene.rules)
        out["rules"].push_back({{"what", rule.what}, {"label", to_string(rule.label)}, {"collisions", rule.count}});
    if (scene.origin) out["origin"] = json_of(*scene.origin);
    out["notices"] = scene.notices;
    return out;
}

/// Returns the two limits. An infinite limit becomes null.
Json json_of(const ZRange& z)
{
    const auto limit = [](double value) { return std::isfinite(value) ? Json(value) : Json(); };
    return {limit(z.low), limit(z.high)};
}

Json floors_json(const Map& map)
{
    Json out = Json::array();
    for (const Floor& floor : floors_of(map))
        out.push_back({{"floor", out.size()},
                       {"height", floor.height},
                       {"z", json_of(floor.z)},
                       {"area", floor.area},
                       {"share", floor.share}});
    return out;
}

/// Returns the numbers of the floors on which an island has ground. It has ground at all heights between its lowest and
/// its highest one, except for steps that the robot overcomes.
Json floors_of_island(const Island& island, const std::vector<Floor>& floors)
{
    Json out = Json::array();
    for (std::size_t k = 0; k < floors.size(); ++k)
        if (island.low <= floors[k].z.high + touch_tolerance && island.high >= floors[k].z.low - touch_tolerance)
            out.push_back(k);
    return out;
}

/// Returns where the robot can drive.
Json islands_json(const InfoArgs& args, const Session& session, Summary& summary)
{
    notice_about_mass(args, session.robot);
    summary.lap("load");
    const ReachGraph graph = find_islands(args, args.reach, session, summary, "info");
    const std::vector<Floor> floors = floors_of(session.map);
    Json out = {{"robot", session.robot.name},
                {"drive", name_of(*graph.options().drive)},
                {"max_step", *graph.options().max_step},
                {"reach_step", *graph.options().step}};
    if (graph.options().turning_radius) out["turning_radius"] = *graph.options().turning_radius;
    out["islands"] = Json::array();
    for (const Island& island : graph.islands())
        out["islands"].push_back({{"island", out["islands"].size()},
                                  {"area", island.area},
                                  {"share", island.share},
                                  {"at", json_of(island.place)},
                                  {"z", {island.low, island.high}},
                                  {"floors", floors_of_island(island, floors)}});
    return out;
}

/// Returns the parts of a map, without removed ones.
std::vector<Part> parts_of(const Map& map)
{
    std::vector<Part> out;
    for (std::size_t part = 0; part < map.geometry.parts().size(); ++part)
        if (!map.geometry.is_removed(part)) out.push_back(map.geometry.parts()[part]);
    return out;
}

/// Returns the contents of a map, with at most `most_parts` of its parts. A changed map has no files.
Json map_json(const Map& map, std::span<const Part> parts, bool verified, std::size_t most_parts)
{
    Json out = {{"kind", "map"},
                {"name", map.name},
                {"format", map.format_version},
                {"bounds", json_of(map.bounds)},
                {"resolution", map.resolution},
                {"occupancy_resolution", map.occupancy_resolution},
                {"layers", map.layers},
                {"scene", {{"file", map.scene_file}, {"xxh64", map.scene_hash}}},
                {"hash", map.hash}};
    if (!map.z_limits.is_unlimited()) out["z_limits"] = json_of(map.z_limits);
    out["floors"] = floors_json(map);
    if (map.origin) out["origin"] = json_of(*map.origin);
    if (verified) out["verified"] = true;
    if (!map.changes.empty()) {
        out["changes"] = map.changes;
    } else {
        out["files"]["map.yaml"] = fs::file_size(map.folder / "map.yaml");
        for (const char* const name : map_files) out["files"][name] = fs::file_size(map.folder / name);
    }
    const Geometry& geometry = map.geometry;
    add_contents(geometry.labels(), parts.first(std::min(parts.size(), most_parts)), out);
    std::vector<std::size_t> places;  // of each part in `parts`, which has no removed ones
    for (std::size_t part = 0, listed = 0; part < geometry.parts().size(); ++part)
        places.push_back(geometry.is_removed(part) ? parts.size() : listed++);
    for (const FaceGroup& group : geometry.face_groups())
        add_group(group, geometry.parts()[group.part], places[group.part], out);
    return out;
}

const char* kind_of(const RobotPart& part)
{
    constexpr std::array names{"box", "sphere", "cylinder", "capsule", "convex hull"};
    return names[std::size_t(part.shape.kind)];
}

Json robot_json(const Robot& robot)
{
    Json out = {{"kind", "robot"}, {"name", robot.name}, {"bounds", json_of(robot.bounds())}};
    out["parts"] = Json::array();
    for (const RobotPart& part : robot.parts) {
        Json entry = {{"name", part.name}, {"shape", kind_of(part)}, {"bounds", json_of(part.bounds())}};
        if (part.shape.kind == ShapeKind::Hull) {
            entry["vertices"] = part.hull_vertices.size();
            for (const Vec3& vertex : part.hull_vertices) entry["points"].push_back(json_of(vertex));
        } else {
            const Eigen::Quaterniond turn = quaternion_from(rpy_from(part.shape.pose.rotation));
            entry["size"] = json_of(part.shape.size);
            entry["position"] = json_of(part.shape.pose.position);
            entry["quaternion"] = {turn.x(), turn.y(), turn.z(), turn.w()};
        }
        out["parts"].push_back(entry);
    }
    out["meshes"] = Json::array();
    for (const MeshFit& fit : robot.meshes) {
        Json entry = {{"name", fit.name},
                      {"file", fit.file},
                      {"parts", fit.parts},
                      {"volume", fit.volume},
                      {"mesh_volume", nullptr}};
        if (fit.mesh_volume) entry["mesh_volume"] = *fit.mesh_volume;
        out["meshes"].push_back(entry);
    }
    out["turning_radius"] = turning_radius(robot);
    out["mass_center"] = json_of(mass_center_of(robot));
    out["mass_center_given"] = robot.mass_center.has_value();
    out["contacts"] = Json::array();
    for (const Vec3& contact : robot.contacts) out["contacts"].push_back(json_of(contact));
    if (const RobotContacts contacts = robot_contacts(robot); !contacts.given)
        for (const Vec3& contact : contacts.points) out["contacts_taken"].push_back(json_of(contact));
    out["notices"] = robot.notices;
    return out;
}

std::string metres(const Json& vector)
{
    std::ostringstream out;
    out.precision(6);
    for (std::size_t i = 0; i < vector.size(); ++i) out << (i ? ", " : "") << vector[i].get<double>();
    return out.str();
}

std::string extent_lines(const Json& bounds)
{
    std::ostringstream out;
    out.precision(6);
    out << "  from  " << metres(bounds["min"]) << " m\n  to    " << metres(bounds["max"]) << " m\n  size  ";
    for (int axis = 0; axis < 3; ++axis)
        out << (axis ? " x " : "")
            << bounds["max"][std::size_t(axis)].get<double>() - bounds["min"][std::size_t(axis)].get<double>();
    out << " m\n";
    return out.str();
}

/// Returns all digits, because survey coordinates are millions of metres.
std::string origin_line(const Json& out)
{
    if (!out.contains("origin")) return "";
    const Json& origin = out["origin"];
    const std::string crs = origin["crs"];
    return "  0, 0 is x " + number(origin["x"]) + ", y " + number(origin["y"]) + (crs.empty() ? "" : " of " + crs) +
           (origin["unit"] == 1.0 ? "" : ", in units of " + number(origin["unit"]) + " m") + "\n";
}

/// Returns a line that says what is filled and what is a shell, because this is the most frequent surprise.
std::string part_line(const Json& part)
{
    std::string labels = part["label"];
    if (part.contains("labels") && !part["labels"].empty()) {
        labels.clear();
        for (const Json& label : part["labels"]) labels += (labels.empty() ? "" : " and ") + label.get<std::string>();
    }
    std::string line = "  " + part["name"].get<std::string>() + ": " + part["kind"].get<std::string>() + ", " + labels;
    if (part["triangles"] > 0) line += ", " + counted(part["triangles"], "triangle");
    if (part["solid_pieces"] > 0) line += ", " + part["solid_pieces"].dump() + " solid";
    if (part["sheet_pieces"] > 0) {
        line += ", " + part["sheet_pieces"].dump() + (part["kind"] == "mesh" ? " shell" : " sheet") +
                " (without thickness, not filled";
        if (part["open_edges"] > 0) line += "; " + counted(part["open_edges"], "open edge");
        line += ")";
    }
    if (part["solid_pieces"] == 0 && part["sheet_pieces"] == 0) line += ", left out";
    return line + "\n";
}

/// Returns how many parts are filled and how many are not. If the list of parts is cut, also names the first parts with
/// shells.
std::string parts_heading(std::span<const Part> parts)
{
    constexpr std::size_t most_named = 5;
    std::size_t solid = 0, shells = 0, sheets = 0, left_out = 0;
    std::string names;
    for (const Part& part : parts) {
        const bool has_shell = part.sheet_pieces > 0 && part.kind == "mesh";
        if (has_shell && ++shells <= most_named) names += (shells == 1 ? "" : ", ") + part.name;
        solid += part.sheet_pieces == 0 && part.solid_pieces > 0;
        sheets += part.sheet_pieces > 0 && !has_shell;
        left_out += part.sheet_pieces == 0 && part.solid_pieces == 0;
    }
    if (shells > most_named) names += ", …";
    std::string out;
    const auto add = [&](std::size_t count, const std::string& what) {
        if (count > 0) out += (out.empty() ? "" : ", ") + std::to_string(count) + " " + what;
    };
    add(solid, "solid");
    add(shells, "with shells (not filled" + (parts.size() > most_lines ? ": " + names : "") + ")");
    add(sheets, sheets == 1 ? "sheet" : "sheets");
    add(left_out, "left out");
    return "parts: " + out + "\n";
}

std::string more_line(std::size_t count)
{
    return count > most_lines ? "  … and " + std::to_string(count - most_lines) + " more (--json lists all)\n" : "";
}

/// Returns a line for each node and material of the meshes; those with the most triangles come first.
std::string name_lines(const Json& parts, const std::string& purpose)
{
    struct Line {
        std::uint64_t triangles;
        std::string text;
    };
    std::vector<Line> lines;
    const auto has_names = [](const Json& part) { return part.contains("names"); };
    const bool is_one = std::count_if(parts.begin(), parts.end(), has_names) <= 1;
    for (const Json& part : parts)
        for (const Json& group : part.value("names", Json::array())) {
            std::uint64_t triangles = 0;
            std::string labels;
            for (const auto& [label, count] : group["triangles"].items()) {
                triangles += count.get<std::uint64_t>();
                labels += (labels.empty() ? "" : " and ") + label;
            }
            char heights[80];
            std::snprintf(heights, sizeof heights, ", z %.6g to %.6g m, ", group["z"][0].get<double>(),
                          group["z"][1].get<double>());
            lines.push_back({triangles, "  " + (is_one ? "" : part["name"].get<std::string>() + ": ") + "node \"" +
                                            group["node"].get<std::string>() + "\", material \"" +
                                            group["material"].get<std::string>() +
                                            "\": " + counted(triangles, "triangle") + heights + labels + "\n"});
        }
    if (lines.empty()) return "";
    std::stable_sort(lines.begin(), lines.end(),
                     [](const Line& l, const Line& r) { return l.triangles > r.triangles; });
    std::string out = "names in meshes, for " + purpose + "\n";
    for (std::size_t i = 0; i < std::min(most_lines, lines.size()); ++i) out += lines[i].text;
    return out + more_line(lines.size());
}

/// Returns lines about a scene or a map with these parts; `scene` needs only the first `most_lines` of them.
std::string scene_lines(const Json& scene, std::span<const Part> all_parts)
{
    std::string out = "labels\n";
    for (const auto& [label, counts] : scene["labels"].items())
        out += "  " + label + ": " + counted(counts["triangles"], "triangle") + ", " +
               counted(counts["primitives"], "primitive") + "\n";
    if (scene.contains("rules")) out += "labels come from --label, then from the first rule that matches\n";
    if (scene.contains("rules"))
        for (const Json& rule : scene["rules"])
            out += "  " + rule["what"].get<std::string>() + " is " + rule["label"].get<std::string>() + ": " +
                   counted(rule["collisions"], "collision") + "\n";
    out += parts_heading(all_parts);
    const Json& parts = scene["parts"];
    for (std::size_t i = 0; i < std::min(most_lines, parts.size()); ++i) out += part_line(parts[i]);
    const bool is_map = scene["kind"] == "map";
    return out + more_line(all_parts.size()) + name_lines(parts, is_map ? "rules of place such as --on" : "--label");
}

/// Escapes control characters in all texts of a value.
void make_printable(Json& value)
{
    if (value.is_string()) value = printable(value.get<std::string>(), false);
    if (value.is_structured())
        for (Json& item : value) make_printable(item);
}

/// The same in what is printed as text.
void make_printable(Json& out, std::vector<Part>& parts)
{
    make_printable(out);
    for (Part& part : parts) part.name = printable(part.name, false);
}

/// Returns a heading and the first files that were read from outside of the folder of a scene or a robot.
std::string outside_lines(const Json& what, bool is_text)
{
    if (!is_text || !what.contains("outside_files")) return "";
    const Json& files = what["outside_files"];
    std::string out = "files from outside of its folder: " + std::to_string(files.size()) + "\n";
    for (std::size_t i = 0; i < std::min(most_lines, files.size()); ++i)
        out += "  " + files[i].get<std::string>() + "\n";
    return out + more_line(files.size());
}

/// Returns a heading, then a line for each floor, the highest first.
std::string floor_lines(const Json& map)
{
    const Json& floors = map["floors"];
    if (floors.empty()) return "floors\n  none: the map has no ground\n";
    std::string out = "floors (heights around which much of the ground lies; --floor K selects one)\n";
    for (std::size_t k = floors.size(); k-- > 0;) {
        char line[120];
        std::snprintf(line, sizeof line, "  %zu: at %.6g m, %.4g m2, %.1f %% of the ground\n", k,
                      floors[k]["height"].get<double>(), floors[k]["area"].get<double>(),
                      100 * floors[k]["share"].get<double>());
        out += line;
    }
    return out;
}

/// Returns ", floor 0" or ", floors 0, 1, 2".
std::string floor_words(const Json& floors)
{
    if (floors.empty()) return "";
    std::string out = floors.size() == 1 ? ", floor " : ", floors ";
    for (std::size_t k = 0; k < floors.size(); ++k) out += (k > 0 ? ", " : "") + floors[k].dump();
    return out;
}

/// Returns a heading, then a line for each island, the largest first.
std::string island_lines(const Json& reach)
{
    const Json& islands = reach["islands"];
    std::string out = "islands of " + reach["robot"].get<std::string>() + " (ground within which it can drive)\n";
    if (islands.empty()) return out + "  none: it can stand nowhere\n";
    for (std::size_t k = 0; k < std::min(most_lines, islands.size()); ++k) {
        char line[160];
        std::snprintf(line, sizeof line, "  %zu: %.4g m2, %.1f %%, z %.4g to %.4g m, around %.6g, %.6g, %.6g", k,
                      islands[k]["area"].get<double>(), 100 * islands[k]["share"].get<double>(),
                      islands[k]["z"][0].get<double>(), islands[k]["z"][1].get<double>(),
                      islands[k]["at"][0].get<double>(), islands[k]["at"][1].get<double>(),
                      islands[k]["at"][2].get<double>());
        out += line + floor_words(islands[k]["floors"]) + "\n";
    }
    return out + more_line(islands.size());
}

/// Returns a line about the z limits, or nothing if the map has none.
std::string z_limits_line(const Json& map)
{
    if (!map.contains("z_limits")) return "";
    const auto limit = [&](std::size_t end) {
        return map["z_limits"][end].is_null() ? "" : number(map["z_limits"][end]);
    };
    return "  z limits " + limit(0) + ":" + limit(1) +
           " m: layers beyond them are not ground, poses beyond them are outside\n";
}

std::string map_lines(const Json& map, std::span<const Part> parts)
{
    std::string out = "map " + map["name"].get<std::string>() + " (from " + map["scene"]["file"].get<std::string>() +
                      ", hash " + map["hash"].get<std::string>() + ")\n" + extent_lines(map["bounds"]);
    out += "  terrain cells of " + map["resolution"].dump() + " m, " + counted(map["layers"], "layer") +
           "; voxels of " + map["occupancy_resolution"].dump() + " m; format " + map["format"].dump() + "\n" +
           z_limits_line(map) + origin_line(map);
    out += floor_lines(map);
    if (map.contains("reach")) out += island_lines(map["reach"]);
    out += scene_lines(map, parts);
    if (map.contains("changes")) {
        out += "changes\n";
        for (const Json& change : map["changes"]) out += "  " + change.get<std::string>() + "\n";
        return out;
    }
    out += "files\n";
    for (const auto& [name, bytes] : map["files"].items()) out += "  " + name + ": " + bytes.dump() + " bytes\n";
    if (map.contains("verified")) out += "all files match their checksums\n";
    return out;
}

/// Returns a line that says how well the hulls of a mesh collision fit it.
std::string mesh_line(const Json& mesh)
{
    char text[120];
    const double volume = mesh["volume"];
    if (mesh["mesh_volume"].is_null())
        std::snprintf(text, sizeof text,
                      "%.4g m3; added volume unknown, because the mesh is not watertight or overlaps itself", volume);
    else
        std::snprintf(text, sizeof text, "%.4g m3, %.1f %% more than the mesh", volume,
                      100 * (volume / mesh["mesh_volume"].get<double>() - 1));
    const std::string name = mesh["name"];
    return "  " + (name.empty() ? "" : name + ": ") + mesh["file"].get<std::string>() + " as " +
           counted(mesh["parts"], "convex hull") + ", " + text + "\n";
}

std::string robot_lines(const Json& robot)
{
    std::string out = "robot " + robot["name"].get<std::string>() + "\n" + extent_lines(robot["bounds"]) + "parts\n";
    for (const Json& part : robot["parts"]) {
        const std::string name = part["name"];
        out += "  " + (name.empty() ? "" : name + ": ") + part["shape"].get<std::string>();
        if (part.contains("vertices")) out += " of " + part["vertices"].dump() + " vertices";
        out += ", from " + metres(part["bounds"]["min"]) + " to " + metres(part["bounds"]["max"]) + " m\n";
    }
    if (!robot["meshes"].empty()) out += "meshes\n";
    for (const Json& mesh : robot["meshes"]) out += mesh_line(mesh);
    out += "footprint\n  turns within " + metres(Json::array({robot["turning_radius"]})) + " m of its origin\n";
    out += "centre of mass\n  " + metres(robot["mass_center"]) + " m, " +
           (robot["mass_center_given"] ? "as its file says" : "the centroid of its parts' volume: its file has none") +
           "\n";
    out += "contacts\n";
    const bool are_taken = robot.contains("contacts_taken");
    if (are_taken)
        out += "  none given: --max-slope uses the corners of all that lies within 2 cm of the lowest point\n";
    for (const Json& contact : robot[are_taken ? "contacts_taken" : "contacts"]) out += "  " + metres(contact) + " m\n";
    return out;
}

/// Returns all bytes of a regular file; nothing for anything else.
std::string text_of(const fs::path& file) { return is_file(file) ? read_file(file) : ""; }

/// Returns whether the text is an SDF model that can move, and not a world or a piece of scenery.
bool is_moving_model(const std::string& text)
{
    const auto has = [&](const char* what) { return text.find(what) != std::string::npos; };
    return has("<model") && !has("<world") && !has("<static>true") && !has("<static>1");
}

/// Returns whether the argument is a robot. For a URDF or SDF model that could also be a scene, the options decide.
bool is_robot(const std::string& what, bool has_robot_options, bool has_scene_options)
{
    const std::string extension = fs::path(what).extension().string();
    if (has_scene_options && !has_robot_options && !what.starts_with("box:") && extension != ".yaml" &&
        extension != ".yml")
        return false;
    if (what.starts_with("box:") || extension == ".urdf" || extension == ".xacro") return true;
    if (is_folder(what)) {
        if (!does_exist(fs::path(what) / "model.config")) return false;
        return has_robot_options || is_moving_model(text_of(fs::path(what) / "model.sdf"));
    }
    if (extension == ".sdf") return has_robot_options || is_moving_model(text_of(what));
    return (extension == ".yaml" || extension == ".yml") &&
           text_of(what).find("spawnfield-robot/") != std::string::npos;
}

Ending run_info(const InfoArgs& args, const CLI::App& command, Summary& summary)
{
    const std::optional<PictureFile> picture_to = args.picture.empty() ? std::nullopt
                                                                       : std::optional(picture_file(args.picture));
    if (!args.islands) refuse(command, reach_option_names, "is only for --islands");
    const Progress listen = progress_bar(args, "info");
    Json out;
    std::vector<Part> parts;  // of a scene or a map
    std::vector<std::string> robot_options_of_info = robot_option_names;
    robot_options_of_info.emplace_back("--picture");
    const auto has_one_of = [&](const std::vector<std::string>& options) {
        return std::any_of(options.begin(), options.end(),
                           [&](const std::string& option) { return command.count(option) > 0; });
    };
    const bool robot_given = is_robot(args.what, has_one_of(robot_options_of_info), has_one_of(scene_option_names));
    if (is_folder(args.what) && !robot_given && !does_exist(fs::path(args.what) / "model.config")) {
        refuse(command, scene_option_names, "is only for scenes; " + args.what + " is a map");
        refuse(command, robot_options_of_info, "is only for robots; " + args.what + " is a map");
        refuse(command, {"--model-path"}, "is only for scenes and robots; " + args.what + " is a map");
        if (args.verify) {
            refuse(command, change_option_names, "is not for --verify, which examines the files of the map");
            verify_map(args.what);
        }
        QueryArgs query = args;
        query.map = args.what;
        const Session session = open_session(query, summary);
        const Map& map = session.map;
        parts = parts_of(map);
        out = map_json(map, parts, args.verify, args.json ? parts.size() : most_lines);
        if (args.islands) out["reach"] = islands_json(args, session, summary);
    } else if (robot_given) {
        refuse(command, scene_option_names, "is only for scenes; " + args.what + " is a robot");
        refuse(command, {"--verify", "--islands", "--with", "--without"},
               "is only for maps; " + args.what + " is a robot");
        const Robot robot = open_robot(args, args.what, robot_options(args));
        if (picture_to) write_robot_picture(robot, picture_to->path);
        out = robot_json(robot);
    } else {
        refuse(command, robot_options_of_info, "is only for robots; " + args.what + " is not a robot");
        refuse(command, {"--verify", "--islands", "--with", "--without"},
               "is only for maps; " + args.what + " is not a map");
        Scene scene = open_scene(args, args.what, scene_options(args, args));
        out = scene_json(scene);
        parts = std::move(scene.parts);
    }
    if (out["kind"] != "map" && !args.host->outside_files.empty()) out["outside_files"] = args.host->outside_files;
    listen(1);
    summary.lap("load");
    if (!args.json) make_printable(out, parts);
    const std::string kind = out["kind"];
    const std::string text = args.json       ? out.dump(2) + "\n"
                             : kind == "map" ? map_lines(out, parts)
                             : kind == "robot"
                                 ? robot_lines(out)
                                 : "scene " + out["name"].get<std::string>() + "\n" + extent_lines(out["bounds"]) +
                                       origin_line(out) + scene_lines(out, parts);
    write_output(args, "", [&](const auto& sink) { sink(text + outside_lines(out, !args.json)); });
    summary.extra.insert(summary.extra.begin(), args.what);
    return {};
}

}  // namespace

void add_info(CLI::App& app, ChosenCommand& chosen)
{
    auto args = std::make_shared<InfoArgs>();
    CLI::App& command = *app.add_subcommand("info", "Contents of a map, a scene or a robot");
    command
        .add_option("what", args->what,
                    "Map folder, scene or world file, model folder, robot.yaml, .urdf, SDF model or box:LX,LY,LZ")
        ->required();
    command.add_flag("--json", args->json, "Print JSON");
    command.add_option("--picture", args->picture,
                       "Picture of a robot to write (.png, .svg or .pdf): from above, from the side and from the front "
                       "(- for standard output)");
    command.add_flag("--verify", args->verify, "Compare every file of a map with its checksum");
    CLI::Option* const islands = command.add_flag(
        "--islands", args->islands, "List the islands of a map for --robot: ground within which it can drive");
    CLI::Option* const robot = command.add_option("--robot,-r", args->robot, "Robot for --islands");
    islands->needs(robot);
    robot->needs(islands);
    add_reach(command, args->reach);
    add_changes(command, *args);
    add_label_options(command, *args);
    add_model_path(command, *args);
    add_trusted(command, *args);
    add_scene_options(command, *args);
    start_group(command, help_group::robot);
    add_robot_options(command, *args);
    add_common(command, *args);
    command.footer(
        "Example:\n  spawnfield info maps/training/scene.yaml\n  spawnfield info maps/robots/husky.yaml --picture "
        "/tmp/husky.png");
    set_work(command, args, chosen, run_info);
}

}  // namespace spawnfield::cli
