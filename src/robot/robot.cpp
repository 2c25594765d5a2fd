#include "base/foreign_file.h"
#include "base/number.h"
#include "base/text.h"
#include "base/yaml_map.h"
#include "model/jointed_model.h"
#include "robot/body_parts.h"
#include "robot/hull.h"
#include "robot/mesh_parts.h"
#include "robot/wheels.h"

#include <spawnfield/error.h>
#include <spawnfield/input_file.h>
#include <spawnfield/robot.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>

namespace spawnfield {

const char* name_of(Drive drive) { return drive_names.begin()[std::size_t(drive)]; }

Drive drive_called(const std::string& name)
{
    const auto found = std::find(drive_names.begin(), drive_names.end(), name);
    if (found == drive_names.end())
        throw ArgumentError("drive_called", "\"" + name + "\" is no drive; needs differential, omni, legged or car");
    return Drive(found - drive_names.begin());
}

Vec3 RobotPart::centre() const
{
    if (shape.kind != ShapeKind::Hull) return shape.pose.position;
    return std::accumulate(hull_vertices.begin(), hull_vertices.end(), Vec3(Vec3::Zero())) /
           double(hull_vertices.size());
}

Bounds RobotPart::bounds() const
{
    if (shape.kind != ShapeKind::Hull) return bounds_of(shape);
    Bounds box;
    for (const Vec3& vertex : hull_vertices) box.extend(vertex);
    return box;
}

Bounds Robot::bounds() const
{
    Bounds all;
    for (const RobotPart& part : parts) {
        const Bounds box = part.bounds();
        all.extend(box.min);
        all.extend(box.max);
    }
    return all;
}

namespace {

std::vector<double> split_numbers(const std::string& text, const std::string& argument)
{
    std::vector<double> out;
    for (std::size_t start = 0; start <= text.size();) {
        const std::size_t comma = std::min(text.find(',', start), text.size());
        double value = 0;
        if (!parse_number(std::string_view(text).substr(start, comma - start), value) || !std::isfinite(value))
            throw ArgumentError("robot \"" + argument + "\": \"" + text.substr(start, comma - start) +
                                "\" is not a finite number");
        out.push_back(value);
        start = comma + 1;
    }
    return out;
}

/// Returns the robot of `box:LX,LY,LZ[@x,y,z]`, lengths in m. Without @ the box stands on the origin.
Robot box_robot(const std::string& argument)
{
    const std::string spec = argument.substr(4);
    const std::size_t at_sign = spec.find('@');
    const auto size = split_numbers(spec.substr(0, at_sign), argument);
    if (size.size() != 3)
        throw ArgumentError("robot \"" + argument + "\": has " + std::to_string(size.size()) +
                            " side lengths, needs 3 (box:LX,LY,LZ[@x,y,z])");
    for (const double side : size)
        if (!(side > 0))
            throw ArgumentError("robot \"" + argument + "\": side length is " + number(side) + ", needs > 0 m");
    RobotPart part;
    part.shape.size = {size[0], size[1], size[2]};
    part.shape.pose.position = {0, 0, size[2] / 2};
    if (at_sign != std::string::npos) {
        const auto centre = split_numbers(spec.substr(at_sign + 1), argument);
        if (centre.size() != 3)
            throw ArgumentError("robot \"" + argument + "\": has " + std::to_string(centre.size()) +
                                " coordinates after @, needs 3");
        part.shape.pose.position = {centre[0], centre[1], centre[2]};
    }
    return {argument, {part}, {}, {}};
}

void append_mesh_part(Robot& robot, const YamlMap& map, const std::filesystem::path& folder,
                      const RobotOptions& options)
{
    const std::filesystem::path file = folder / map.text("mesh");
    const Vec3 scale = map.scale();
    const char chosen_up = map.has("up") ? map.one_of("up", {"y", "z"}, "z")[0] : char{0};
    try {
        FileMesh mesh = read_mesh(file, mesh_formats(options.any_mesh));
        const char up = chosen_up != 0 ? chosen_up : mesh.up;
        for (FileMesh::Node& node : mesh.nodes)
            for (Vec3& vertex : node.vertices) vertex = turned_up(vertex.cwiseProduct(scale), up);
        robot.notices.insert(robot.notices.end(), mesh.notices.begin(), mesh.notices.end());
        append_mesh(robot, {map.text("name", ""), file, placed(std::move(mesh.nodes), Vec3::Ones(), map.pose())},
                    options.mesh_parts);
    } catch (const std::domain_error& error) {
        map.fail("mesh", "cannot be used: " + file.string() + ": its convex hull has no volume: " + error.what());
    } catch (const FileError& error) {
        map.fail("mesh", std::string("cannot be used: ") + error.what());
    }
}

void append_part(Robot& robot, const YamlMap& map, const std::filesystem::path& folder, const RobotOptions& options)
{
    const std::string kind = only_key(map, {"box", "sphere", "cylinder", "capsule", "mesh"},
                                      {"name", "xyz", "rpy", "rpy_deg", "scale", "up"});
    if (kind == "mesh") {
        map.only({"name", "mesh", "xyz", "rpy", "rpy_deg", "scale", "up"});
        append_mesh_part(robot, map, folder, options);
        return;
    }
    map.only({"name", "xyz", "rpy", "rpy_deg", kind.c_str()});
    RobotPart part;
    part.shape = read_shape(map, kind);
    part.name = map.text("name", "");
    robot.parts.push_back(std::move(part));
}

RobotDrive read_drive(const YamlMap& map)
{
    RobotDrive out;
    if (map.has("drive")) out.kind = drive_called(map.one_of("drive", drive_names, ""));
    if (map.has("max_step")) out.max_step = map.finite("max_step");
    if (map.has("turning_radius")) out.turning_radius = map.positive("turning_radius");
    if (map.has("wheel_radius")) out.wheel_radius = map.positive("wheel_radius");
    if (out.max_step && *out.max_step < 0) map.fail("max_step", "is " + number(*out.max_step) + ", needs >= 0 m");
    if (out.kind == Drive::Car && !out.turning_radius)
        map.fail("drive", "is car, which needs turning_radius: the smallest radius of its curves, m");
    if (out.kind == Drive::Legged && !out.max_step)
        map.fail("drive", "is legged, which needs max_step: the largest step that it climbs, m");
    if (out.turning_radius && out.kind != Drive::Car) map.fail("turning_radius", "is only for drive: car");
    return out;
}

Robot read_robot_yaml(const std::filesystem::path& file, const RobotOptions& options)
{
    const YamlMap root = read_yaml(file, "spawnfield-robot/1");
    root.only(
        {"format", "name", "parts", "contacts", "mass_center", "drive", "max_step", "turning_radius", "wheel_radius"});
    Robot robot;
    robot.name = root.text("name", file.stem().string());
    std::size_t count = 0;
    for (const YAML::Node& node : root.list("parts"))
        append_part(robot, {node, file.string(), "part " + std::to_string(++count)}, file.parent_path(), options);
    if (robot.parts.empty()) root.fail("parts", "is empty, needs at least one part");
    if (root.has("contacts")) robot.contacts = root.vectors("contacts");
    if (root.has("mass_center")) robot.mass_center = root.vector("mass_center");
    robot.drive = read_drive(root);
    return robot;
}

/// Reads a URDF or an SDF model, from its file or from the model's folder.
Robot read_model_robot(const std::filesystem::path& file_or_folder, const RobotOptions& options)
{
    const std::filesystem::path file = model_file_of(file_or_folder);
    ModelPaths paths(options.model_paths, file);
    const bool is_urdf = lower_case(file.extension().string()) == ".urdf";
    JointedModel model = is_urdf ? read_urdf_model(file, options.joints) : read_sdf_model(file, paths, options.joints);
    Robot robot;
    robot.name = model.name;
    robot.notices = std::move(model.notices);
    if (model.mass > 0) robot.mass_center = model.mass_moment / model.mass;
    robot.drive.wheel_radius = wheel_radius_of(model);
    for (const CollisionBody& body : model.bodies) append_body(robot, body, paths, file.string(), options);
    if (robot.parts.empty())
        throw FileError(file.string(), "has no <collision>, needs at least one (<visual> elements are not used)");
    return robot;
}

constexpr const char* known_kinds = "a robot.yaml, a .urdf, an SDF model (.sdf or its folder) or box:LX,LY,LZ[@x,y,z]";

Robot read_robot(const std::string& robot, const RobotOptions& options)
{
    const std::filesystem::path file = robot;
    const std::string extension = lower_case(file.extension().string());
    if (is_folder(file)) return read_model_robot(file, options);
    if (is_missing(file)) throw FileError(robot, std::string("does not exist; a robot is ") + known_kinds);
    require_file(file);
    refuse_foreign_robot(file);
    if (extension == ".urdf" || extension == ".sdf" || extension == ".world") return read_model_robot(file, options);
    if (extension != ".yaml" && extension != ".yml")
        throw FileError(robot, std::string("is not in a known robot format; a robot is ") + known_kinds);
    if (!options.joints.empty())
        throw ArgumentError("load_robot",
                            "joint \"" + options.joints[0].joint + "\" is given, but " + robot + " has no joints");
    return read_robot_yaml(file, options);
}

/// Returns how to convert a robot to metres. `text` is the robot as the user gave it.
std::string unit_advice(const std::string& text)
{
    if (text.starts_with("box:")) return "divide its lengths by 1000 or 100";
    return "divide lengths and positions by 1000 or 100, and give meshes scale: 0.001 or 0.01 (robot.yaml) or "
           "scale=\"0.001 0.001 0.001\" (URDF)";
}

/// Returns a notice if the robot is larger than 50 m, because its lengths are then likely in millimetres or
/// centimetres.
std::vector<std::string> size_notices(const Robot& robot, const std::string& text)
{
    constexpr double usual = 50;  // m
    const Bounds box = robot.bounds();
    const Vec3 size = box.max - box.min;
    if (size.maxCoeff() <= usual) return {};
    char words[100];
    std::snprintf(words, sizeof words, ": is %.6g x %.6g x %.6g m; if it is in millimetres or centimetres, ", size.x(),
                  size.y(), size.z());
    return {text + words + unit_advice(text)};
}

/// Throws FileError if the robot reaches more than farthest_robot_point from its origin.
void check_reach(const Robot& robot, const std::string& text)
{
    const Bounds box = robot.bounds();
    const double reach = std::max(box.min.cwiseAbs().maxCoeff(), box.max.cwiseAbs().maxCoeff());
    if (reach <= farthest_robot_point) return;
    throw FileError(text, "reaches " + number(reach) + " m from its origin, needs at most " +
                              number(farthest_robot_point) + " m; is it in millimetres or centimetres? " +
                              unit_advice(text));
}

}  // namespace

Robot load_robot(const std::string& robot, const RobotOptions& options)
{
    constexpr int most_parts = 64;
    if (options.mesh_parts < 1 || options.mesh_parts > most_parts)
        throw ArgumentError("load_robot", "mesh_parts", options.mesh_parts, "1 .. " + std::to_string(most_parts));
    if (robot.starts_with("box:")) {
        if (!options.joints.empty())
            throw ArgumentError("load_robot",
                                "joint \"" + options.joints[0].joint + "\" is given, but " + robot + " has no joints");
        Robot box = box_robot(robot);
        check_reach(box, robot);
        box.notices = size_notices(box, robot);
        return box;
    }
    Robot out = read_robot(robot, options);
    check_reach(out, robot);
    for (std::string& notice : size_notices(out, robot)) out.notices.push_back(std::move(notice));
    out.joints = options.joints;
    out.mesh_parts = options.mesh_parts;
    for (std::string& text : growth_notices(out)) out.notices.push_back(robot + ": " + std::move(text));
    return out;
}

}  // namespace spawnfield
