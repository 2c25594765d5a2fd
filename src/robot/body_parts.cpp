#include "robot/body_parts.h"

#include "robot/ellipsoid.h"
#include "robot/mesh_parts.h"

#include <spawnfield/error.h>

#include <cstdio>
#include <stdexcept>

namespace spawnfield {
namespace {

using Kind = CollisionGeometry::Kind;

/// "link "arm::hand": collision "palm"".
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
    std::snprintf(text, sizeof text, "its ellipsoid counts as a polyhedron around it, %.1f %% more in volume",
                  100 * ellipsoid_growth(part, body.geometry.size));
    robot.notices.push_back(file + ": " + place_of(body) + ": " + text);
    robot.parts.push_back(std::move(part));
}

void append_mesh_body(Robot& robot, const CollisionBody& body, ModelPaths& paths, const std::string& file,
                      int most_parts)
{
    const CollisionGeometry& geometry = body.geometry;
    const std::filesystem::path found = paths.find(geometry.uri, geometry.folder);
    if (!std::filesystem::is_regular_file(found))
        fail(body, file,
             "<mesh> " + geometry.uri +
                 " is found neither beside the file, nor in --model-path, GZ_SIM_RESOURCE_PATH, GAZEBO_MODEL_PATH, nor "
                 "in the folders above the file");
    try {
        // As Gazebo takes COLLADA: its <unit> counts, its <up_axis> does not.
        const FileMesh mesh = submesh_of(read_mesh(found), geometry, found.string());
        robot.notices.insert(robot.notices.end(), mesh.notices.begin(), mesh.notices.end());
        append_mesh(robot, {body.names[1], found, placed(mesh.nodes, geometry.size, body.pose)}, most_parts);
    } catch (const std::domain_error& error) {
        fail(body, file,
             "<mesh> cannot be used: " + found.string() + ": its convex hull has no volume: " + error.what());
    } catch (const FileError& error) {
        fail(body, file, std::string("<mesh> cannot be used: ") + error.what());
    }
}

}  // namespace

void append_body(Robot& robot, const CollisionBody& body, ModelPaths& paths, const std::string& file, int most_parts)
{
    const CollisionGeometry& geometry = body.geometry;
    if (geometry.kind == Kind::Mesh) return append_mesh_body(robot, body, paths, file, most_parts);
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
        geometry.kind == Kind::Plane       ? "is a <plane>, which no robot can be made of: it has no end"
        : geometry.kind == Kind::Heightmap ? "is a <heightmap>, which no robot can be made of: it has no thickness"
        : geometry.kind == Kind::Polyline
            ? "is a <polyline>, which robots cannot have here: a box or a mesh does"
            : "is a <" + geometry.element +
                  ">, which is not known here; known: box, sphere, cylinder, capsule, ellipsoid, mesh";
    fail(body, file, why);
}

}  // namespace spawnfield
