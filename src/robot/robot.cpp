#include "base/number.h"
#include "robot/hull.h"
#include "robot/urdf.h"
#include "scene/mesh.h"
#include "scene/yaml_map.h"

#include <spawnfield/error.h>
#include <spawnfield/robot.h>

#include <cmath>
#include <numeric>

namespace spawnfield {

Vec3 RobotPart::centre() const
{
    if (shape.kind != ShapeKind::Hull) return shape.pose.position;
    return std::accumulate(hull_vertices.begin(), hull_vertices.end(), Vec3(Vec3::Zero())) / double(hull_vertices.size());
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
            throw ArgumentError("robot \"" + argument + "\": \"" + text.substr(start, comma - start) + "\" is no finite number");
        out.push_back(value);
        start = comma + 1;
    }
    return out;
}

/// `box:LX,LY,LZ[@x,y,z]`; without @ the box stands on the origin.
Robot box_robot(const std::string& argument)
{
    const std::string spec = argument.substr(4);
    const std::size_t at = spec.find('@');
    const auto size = split_numbers(spec.substr(0, at), argument);
    if (size.size() != 3)
        throw ArgumentError("robot \"" + argument + "\": has " + std::to_string(size.size()) + " side lengths, needs 3 (box:LX,LY,LZ[@x,y,z])");
    for (const double side : size)
        if (!(side > 0)) throw ArgumentError("robot \"" + argument + "\": side length is " + number(side) + ", needs > 0 m");
    RobotPart part;
    part.shape.size = {size[0], size[1], size[2]};
    part.shape.pose.position = {0, 0, size[2] / 2};
    if (at != std::string::npos) {
        const auto centre = split_numbers(spec.substr(at + 1), argument);
        if (centre.size() != 3)
            throw ArgumentError("robot \"" + argument + "\": has " + std::to_string(centre.size()) + " coordinates after @, needs 3");
        part.shape.pose.position = {centre[0], centre[1], centre[2]};
    }
    return {argument, {part}, {}, {}};
}

RobotPart read_hull(const YamlMap& map, const std::filesystem::path& folder)
{
    const std::filesystem::path file = folder / map.text("mesh");
    const Vec3 scale = map.scale();
    const Pose pose = map.pose();
    const char given_up = map.has("up") ? map.one_of("up", {"y", "z"}, "z")[0] : char{0};
    try {
        const FileMesh mesh = read_mesh(file);
        const char up = given_up != 0 ? given_up : mesh.up;
        std::vector<Vec3> points;
        for (const FileMesh::Node& node : mesh.nodes)
            for (const Vec3& vertex : node.vertices)
                points.push_back(pose.rotation * turned_up(vertex.cwiseProduct(scale), up) + pose.position);
        return convex_hull(points);
    } catch (const std::domain_error& error) {
        map.fail("mesh", "cannot be used: " + file.string() + ": its convex hull has no volume: " + error.what());
    } catch (const FileError& error) {
        map.fail("mesh", std::string("cannot be used: ") + error.what());
    }
}

RobotPart read_robot_part(const YamlMap& map, const std::filesystem::path& folder)
{
    const std::string kind = only_key(map, {"box", "sphere", "cylinder", "capsule", "mesh"}, {"name", "xyz", "rpy", "rpy_deg", "scale", "up"});
    if (kind == "mesh") {
        map.only({"name", "mesh", "xyz", "rpy", "rpy_deg", "scale", "up"});
        return read_hull(map, folder);
    }
    map.only({"name", "xyz", "rpy", "rpy_deg", kind.c_str()});
    RobotPart part;
    part.shape = read_shape(map, kind);
    return part;
}

Robot read_robot_yaml(const std::filesystem::path& file)
{
    const YamlMap root = read_yaml(file, "spawnfield-robot/1");
    root.only({"format", "name", "parts", "contacts"});
    Robot robot;
    robot.name = root.text("name", file.stem().string());
    std::size_t count = 0;
    for (const YAML::Node& node : root.list("parts"))
        robot.parts.push_back(read_robot_part({node, file.string(), "part " + std::to_string(++count)}, file.parent_path()));
    if (robot.parts.empty()) root.fail("parts", "is empty, needs at least one part");
    if (root.has("contacts")) robot.contacts = root.vectors("contacts");
    return robot;
}

}  // namespace

Robot load_robot(const std::string& robot, const RobotOptions& options)
{
    if (robot.starts_with("box:")) return box_robot(robot);
    const std::filesystem::path file = robot;
    if (!std::filesystem::is_regular_file(file))
        throw FileError(robot, "does not exist; a robot is a robot.yaml, a .urdf or box:LX,LY,LZ[@x,y,z]");
    if (file.extension() == ".urdf") return read_urdf(file, options);
    if (file.extension() == ".yaml" || file.extension() == ".yml") return read_robot_yaml(file);
    throw FileError(robot, "is no known robot format, needs .yaml, .urdf or box:LX,LY,LZ[@x,y,z]");
}

}  // namespace spawnfield
