#include "robot/body_parts.h"

#include "robot/ellipsoid.h"
#include "robot/mesh_parts.h"

#include <spawnfield/error.h>
#include <spawnfield/input_file.h>

#include <cstdio>
#include <stdexcept>

namespace spawnfield {
namespace {

using Kind = CollisionGeometry::Kind;

/// Returns where a body is in its file, for messages: link "arm::hand": collision "palm".
std::string place_of(const CollisionBody& body)
{
    return "link \"" + body.names[1] + "\"" +
           (body.names.back().empty() ? "" : ": collision \"" + body.names.back() + "\"");
}

[[noreturn]] void fail(const CollisionBody& body, const std::string& file, const std::string& what)
{
    throw FileError(file, place_of(body) + ": " + what +
                              (body.geometry.line ? " (line " + std::to_string(*body.geometry.line) + ")" : ""));
}

void append_ellipsoid(Robot& robot, const CollisionBody& body, const std::string& file)
{
    RobotPart part = ellipsoid_hull(body.geometry.size, body.pose);
    part.name = body.names[1];
    char text[120];
    std::snprintf(text, sizeof text, "its ellipsoid is replaced by a polyhedron around it, with %.1f %% more volume",
                  100 * ellipsoid_growth(part, body.geometry.size));
    robot.notices.push_back(file + ": " + place_of(body) + ": " + text);
    robot.parts.push_back(std::move(part));
}

std::filesystem::path mesh_file_of(const CollisionBody& body, ModelPaths& paths, const std::string& file)
{
    const std::string& uri = body.geometry.uri;
    std::filesystem::path found;
    try {
        found = paths.find(uri, body.geometry.folder);
    } catch (const FileError& error) {  // it is in no folder from which files may be read
        fail(body, file, std::string("<mesh> cannot be used: ") + error.what());
    }
    if (!is_file(found))
        fail(body, file,
             "<mesh> " + uri +
                 " was not found beside the file, in --model-path, in GZ_SIM_RESOURCE_PATH, in GAZEBO_MODEL_PATH or "
                 "in the folders above the file; add its folder to --model-path or fix the URI");
    return found;
}

void append_mesh_body(Robot& robot, const CollisionBody& body, ModelPaths& paths, const std::string& file,
                      const RobotOptions& options)
{
    const CollisionGeometry& geometry = body.geometry;
    const std::filesystem::path found = mesh_file_of(body, paths, file);
    try {
        // Like Gazebo, this applies the <unit> of a COLLADA file and ignores its <up_axis>.
        const FileMesh mesh = submesh_of(read_mesh(found, mesh_formats(options.any_mesh)), geometry, found.string());
        robot.notices.insert(robot.notices.end(), mesh.notices.begin(), mesh.notices.end());
        append_mesh(robot, {body.names[1], found, placed(mesh.nodes, geometry.size, body.pose)}, options.mesh_parts);
    } catch (const std::domain_error& error) {
        fail(body, file,
             "<mesh> cannot be used: " + found.string() + ": its convex hull has no volume: " + error.what());
    } catch (const FileError& error) {
        fail(body, file, std::string("<mesh> cannot be used: ") + error.what());
    }
}

}  // namespace

void append_body(Robot& robot, const CollisionBody& body, ModelPaths& paths, const std::string& file,
                 const RobotOptions& options)
{
    const CollisionGeometry& geometry = body.geometry;
    if (geometry.kind == Kind::Mesh) return append_mesh_body(robot, body, paths, file, options);
    if (geometry.kind == Kind::Unknown && (geometry.element.empty() || geometry.element == "empty")) return;
    if (const std::optional<Shape> shape = shape_of(geometry, body.pose)) {
        RobotPart part;
        part.shape = *shape;
        part.name = body.names[1];
        robot.parts.push_back(std::move(part));
        return;
    }
    if (geometry.kind == Kind::Ellipsoid) return append_ellipsoid(robot, body, file);
    const std::string why =
        geometry.kind == Kind::Plane ? "is a <plane>, which a robot cannot have because it is infinite; use a <box>"
        : geometry.kind == Kind::Heightmap
            ? "is a <heightmap>, which a robot cannot have because it has no thickness; use a <mesh>"
        : geometry.kind == Kind::Polyline
            ? "is a <polyline>, which is not supported in robots; use a <box> or a <mesh>"
            : "is a <" + geometry.element +
                  ">, which is unknown; use box, sphere, cylinder, capsule, ellipsoid or mesh";
    fail(body, file, why);
}

}  // namespace spawnfield
