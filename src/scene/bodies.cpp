#include "scene/bodies.h"

#include "base/number.h"
#include "base/polygon2.h"
#include "base/rotation.h"
#include "mesh/sphere_mesh.h"
#include "scene/extrusion.h"
#include "scene/gazebo_heights.h"
#include "scene/ground_rules.h"
#include "scene/label_rules.h"
#include "scene/mesh.h"
#include "scene/pieces.h"
#include "scene/shape_slope.h"

#include <spawnfield/error.h>
#include <spawnfield/input_file.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace spawnfield {
namespace {

namespace fs = std::filesystem;
using Kind = CollisionGeometry::Kind;

constexpr std::array kind_names{"box",   "sphere", "cylinder",  "capsule",  "ellipsoid",
                                "plane", "mesh",   "heightmap", "polyline", "unknown"};
constexpr double around_the_rest = 10;  // m of ground plane around all other geometry
// m by which planes extend beyond the map's bounds, for robots that overhang its edge; larger than any robot.
constexpr double beyond_bounds = 50;

/// Returns a closed mesh around the ellipsoid with these half axes. `sphere` is a mesh around the unit sphere.
FileMesh ellipsoid_mesh(const SphereMesh& sphere, const Vec3& radii)
{
    FileMesh mesh;
    mesh.materials.push_back("");
    FileMesh::Node& node = mesh.nodes.emplace_back();
    node.name = "ellipsoid";
    for (const Vec3& vertex : sphere.vertices) node.vertices.push_back(vertex.cwiseProduct(radii));
    node.triangles = sphere.triangles;
    node.materials.assign(node.triangles.size(), 0);
    return mesh;
}

/// Returns the corners of the convex polygon in which the infinite plane z = 0 of `pose` meets the box; empty if they
/// do not meet.
std::vector<Vec3> plane_in_box(const Pose& pose, const Bounds& box)
{
    const double reach = (box.max - box.min).norm();
    const Vec3 normal = pose.rotation.col(2), middle = (box.min + box.max) / 2;
    const Vec3 foot = middle - normal * normal.dot(middle - pose.position);
    std::vector<Vec3> polygon;
    for (const auto& [u, v] : {std::pair{-1, -1}, std::pair{1, -1}, std::pair{1, 1}, std::pair{-1, 1}})
        polygon.push_back(foot + reach * (u * pose.rotation.col(0) + v * pose.rotation.col(1)));
    for (int axis = 0; axis < 3; ++axis)
        for (const double sign : {1.0, -1.0}) {
            const double limit = sign > 0 ? box.max[axis] : -box.min[axis];
            std::vector<Vec3> kept;
            const auto distance = [&](const Vec3& p) { return sign * p[axis] - limit; };
            clip_polygon(polygon, distance, [&](const Vec3& p, bool) { kept.push_back(p); });
            polygon = std::move(kept);
        }
    return polygon;
}

class BodyAppender {
public:
    BodyAppender(Scene& scene, const fs::path& file, ModelPaths& paths, const SceneOptions& options, bool is_incomplete)
        : scene_(scene), file_(file), paths_(paths), options_(options), is_incomplete_(is_incomplete),
          meshes_(mesh_formats(options.any_mesh))
    {
    }

    /// Appends all bodies. Keeps pointers to them until it returns.
    void append(std::vector<CollisionBody>& bodies)
    {
        make_names_unique(bodies);
        find_files(bodies);
        label(bodies);
        for (std::size_t b = 0; b < bodies.size(); ++b)
            if (bodies[b].geometry.kind != Kind::Plane)
                append_body(bodies[b], labels_[b], by_slope_[b] ? options_.auto_slope : std::nullopt);
        choose_bounds(bodies);
        for (std::size_t b = 0; b < bodies.size(); ++b)
            if (bodies[b].geometry.kind == Kind::Plane) append_plane(bodies[b], labels_[b]);
        note_ellipsoids();
        note_unused_rules(bodies);
        if (everything_is_terrain_)
            scene_.notices.push_back(file_.string() +
                                     ": nothing in it is a plane, a heightmap or named as ground, so everything is "
                                     "terrain, also walls and furniture. " +
                                     labelling_advice(scene_));
    }

    std::vector<std::string> take_missing()
    {
        for (const auto& [uri, entry] : not_found_)
            missing_.push_back(file_.string() + ": " + entry.first + ": " + uri + " is not found" +
                               (entry.second > 1 ? " (" + std::to_string(entry.second) + " collisions)" : "") +
                               ": it is ignored");
        return std::move(missing_);
    }

private:
    static void make_names_unique(std::vector<CollisionBody>& bodies)
    {
        std::map<std::string, int> seen;
        for (CollisionBody& body : bodies)
            if (const int before = seen[scoped_name(body)]++; before > 0)
                body.names.back() += "_" + std::to_string(before + 1);
    }

    /// Finds the files of meshes and heightmaps. A geometry whose file is not found becomes Unknown, with a notice.
    void find_files(std::vector<CollisionBody>& bodies)
    {
        for (CollisionBody& body : bodies) {
            CollisionGeometry& geometry = body.geometry;
            if (geometry.kind == Kind::Unknown && !geometry.element.empty() && geometry.element != "empty")
                ignore(body, "<" + geometry.element + "> is not a known geometry");
            if (geometry.kind != Kind::Mesh && geometry.kind != Kind::Heightmap) continue;
            const fs::path found = file_of(body);
            if (is_file(found)) {
                files_[&body] = found;
                if (geometry.kind == Kind::Mesh) meshes_.expect(found);
                continue;
            }
            ++not_found_
                  .try_emplace(geometry.uri.empty() ? "a mesh without <uri>" : geometry.uri,
                               "\"" + scoped_name(body) + "\"", std::size_t{0})
                  .first->second.second;
            geometry.kind = Kind::Unknown;
            geometry.element.clear();
            is_incomplete_ = true;
        }
    }

    fs::path file_of(const CollisionBody& body)
    {
        try {
            return paths_.find(body.geometry.uri, body.geometry.folder);
        } catch (const FileError& error) {  // it is in no folder from which files may be read
            throw fault(body, error.what());
        }
    }

    FileError fault(const CollisionBody& body, const std::string& what) const
    {
        return FileError(file_.string(), "\"" + scoped_name(body) + "\": " + what);
    }

    void label(const std::vector<CollisionBody>& bodies)
    {
        GroundRules rules(options_.auto_slope.has_value());
        std::size_t unknown = 0;
        for (const CollisionBody& body : bodies) {
            const bool counts = body.geometry.kind != Kind::Unknown;
            unknown += !counts;
            const auto match = std::find_if(options_.labels.begin(), options_.labels.end(),
                                            [&](const LabelRule& rule) { return matches_body(rule.pattern, body); });
            const std::optional<Label> label = !counts                          ? Label::Ignore
                                               : match != options_.labels.end() ? match->label
                                                                                : rules.label_of(body);
            labels_.push_back(label.value_or(Label::Obstacle));
            by_slope_.push_back(!label && options_.auto_slope);
        }
        const bool is_unlabelled = !rules.has_ground() && options_.labels.empty() && !options_.auto_slope;
        if (is_unlabelled && !is_incomplete_) {
            everything_is_terrain_ = scene_.is_unlabelled = true;
            scene_.rules.push_back(
                {"all: nothing is a plane, a heightmap or named as ground", Label::Terrain, bodies.size() - unknown});
            std::replace(labels_.begin(), labels_.end(), Label::Obstacle, Label::Terrain);
            return;
        }
        if (is_unlabelled)
            scene_.notices.push_back(file_.string() +
                                     ": nothing in it is a plane, a heightmap or named as ground. Because "
                                     "parts of it are missing, none of it becomes terrain");
        scene_.rules = rules.take();
    }

    /// Returns the rules of the options. A rule that matches the body applies to all of its faces.
    std::vector<FaceRule> rules_for(const CollisionBody& body) const
    {
        std::vector<FaceRule> out;
        for (const LabelRule& rule : options_.labels)
            out.push_back(matches_body(rule.pattern, body) ? FaceRule{"*", "*", rule.label}
                                                           : FaceRule{rule.pattern, rule.pattern, rule.label, true});
        return out;
    }

    std::uint32_t add_part(const CollisionBody& body, Label label)
    {
        return spawnfield::add_part(scene_, scoped_name(body), kind_names[std::size_t(body.geometry.kind)], label);
    }

    /// Appends a body. Its label is `label`, or follows from the slope if `auto_slope` (rad) is given.
    void append_body(const CollisionBody& body, Label label, std::optional<double> auto_slope)
    {
        const CollisionGeometry& geometry = body.geometry;
        if (geometry.kind == Kind::Unknown) return;
        const std::uint32_t part = add_part(body, label);
        if (const std::optional<Shape> shape = shape_of(geometry, body.pose)) {
            if (label == Label::Ignore) return;
            const std::optional<Label> by_slope = auto_slope ? label_by_slope(*shape, *auto_slope) : label;
            if (!by_slope) return append_mesh_body(body, part, box_mesh(shape->size), Vec3::Ones(), auto_slope);
            scene_.primitives.push_back({*shape, part, *by_slope});
            scene_.parts[part].label = *by_slope;
            scene_.parts[part].solid_pieces = 1;
            return;
        }
        try {
            if (geometry.kind == Kind::Heightmap) {
                const Pose middle = body.pose * Pose{geometry.position, Mat3::Identity()};
                if (label == Label::Ignore) return;
                const Heightmap found = gazebo_heights(files_.at(&body), geometry);
                append_heightmap(scene_, part, found, middle, true);
                for (const std::string& text : found.notices)
                    scene_.notices.push_back(files_.at(&body).string() + ": " + text);
            } else if (geometry.kind == Kind::Polyline) {
                append_mesh_body(body, part, extruded(geometry.outlines, geometry.size[0]), Vec3::Ones(), auto_slope);
            } else if (geometry.kind == Kind::Ellipsoid) {
                append_ellipsoid(body, part, auto_slope);
            } else {
                const auto mesh = meshes_.read(files_.at(&body));
                if (!has_submesh(*mesh, geometry))
                    return ignore_last_part(
                        body, "<submesh> \"" + geometry.submesh + "\" is not a node of " + files_.at(&body).string());
                if (geometry.submesh.empty())
                    append_mesh_body(body, part, *mesh, geometry.size, auto_slope);
                else
                    append_mesh_body(body, part, submesh_of(*mesh, geometry, files_.at(&body).string()), geometry.size,
                                     auto_slope);
            }
        } catch (const std::domain_error& error) {
            throw fault(body, std::string("<polyline>: ") + error.what());
        } catch (const FileError& error) {
            throw fault(body, error.what());
        }
    }

    void ignore(const CollisionBody& body, const std::string& why)
    {
        missing_.push_back(file_.string() + ": \"" + scoped_name(body) + "\": " + why + ": it is ignored");
        is_incomplete_ = true;
    }

    /// Removes the part that was added last, with a message.
    void ignore_last_part(const CollisionBody& body, const std::string& why)
    {
        scene_.parts.pop_back();
        ignore(body, why);
    }

    void append_mesh_body(const CollisionBody& body, std::uint32_t part, const FileMesh& mesh, const Vec3& scale,
                          std::optional<double> auto_slope)
    {
        MeshOptions options;
        options.pose = body.pose;
        options.scale = scale;
        options.up = 'z';  // Gazebo keeps the axes of the file and ignores its up axis
        options.rules = rules_for(body);
        options.auto_slope = auto_slope;
        append_mesh(scene_, part, mesh, options);
    }

    void append_ellipsoid(const CollisionBody& body, std::uint32_t part, std::optional<double> auto_slope)
    {
        constexpr int rounds = 4;  // 5,120 triangles; the distance is less than a thousandth of the half axes
        const SphereMesh sphere = mesh_around_unit_sphere(rounds);
        append_mesh_body(body, part, ellipsoid_mesh(sphere, body.geometry.size), Vec3::Ones(), auto_slope);
        ++ellipsoids_;
        ellipsoid_growth_ = std::max(ellipsoid_growth_,
                                     (sphere.vertices[0].norm() - 1) * body.geometry.size.maxCoeff());
    }

    void note_ellipsoids()
    {
        if (ellipsoids_ > 0)
            scene_.notices.push_back(file_.string() + ": " + std::to_string(ellipsoids_) +
                                     (ellipsoids_ == 1 ? " ellipsoid is replaced by a mesh around it"
                                                       : " ellipsoids are replaced by meshes around them") +
                                     ", at most " + number(std::ceil(ellipsoid_growth_ * 1e4) / 1e4) + " m larger");
    }

    /// Sets the bounds of the map: those of the options, if given; else all geometry without planes, and the planes as
    /// far as visuals show them. Planes that are not shown, or not larger than the other geometry, give no information
    /// about the extent of the world. Then the bounds are the other geometry and some metres around it.
    void choose_bounds(const std::vector<CollisionBody>& bodies)
    {
        scene_.map_bounds = options_.bounds;
        std::vector<const CollisionBody*> planes;
        for (const CollisionBody& body : bodies)
            if (body.geometry.kind == Kind::Plane) planes.push_back(&body);
        if (!scene_.map_bounds.is_empty() || planes.empty()) return;
        Bounds rest = scene_.bounds();
        if (rest.is_empty())
            for (const CollisionBody* const plane : planes) rest.extend(plane->pose.position);
        Bounds all = rest;
        bool is_larger = false;
        for (const CollisionBody* const plane : planes) {
            Bounds drawn = drawn_bounds(*plane);
            if (plane->geometry.size.x() == 0)
                drawn.min.head<2>() = drawn.max.head<2>() = rest.min.head<2>();  // only its height is used
            all.extend(drawn.min);
            all.extend(drawn.max);
            is_larger = is_larger || ((drawn.max - drawn.min) - (rest.max - rest.min)).head<2>().maxCoeff() > 0;
        }
        if (!is_larger) {
            all.min.head<2>() = rest.min.head<2>().array() - around_the_rest;
            all.max.head<2>() = rest.max.head<2>().array() + around_the_rest;
            scene_.notices.push_back(file_.string() +
                                     ": the ground plane is infinite, and no <visual> shows it larger than the rest of "
                                     "the world. The map covers " +
                                     "the rest and " + number(around_the_rest) + " m around it (--bounds sets it)");
        }
        scene_.map_bounds = all;
    }

    /// Returns the bounds of the plane as far as visuals show it; only its origin if none does.
    static Bounds drawn_bounds(const CollisionBody& plane)
    {
        Bounds box;
        const Pose pose = plane_pose(plane);
        for (const double u : {-0.5, 0.5})
            for (const double v : {-0.5, 0.5})
                box.extend(pose.position +
                           pose.rotation * Vec3(u * plane.geometry.size[0], v * plane.geometry.size[1], 0));
        return box;
    }

    static Pose plane_pose(const CollisionBody& body)
    {
        return body.pose * Pose{Vec3::Zero(), rotation_from_z_to(body.geometry.normal)};
    }

    void append_plane(const CollisionBody& body, Label label)
    {
        const std::uint32_t part = add_part(body, label);
        if (label == Label::Ignore) return;
        Bounds box = scene_.map_bounds;
        box.min -= Vec3::Constant(beyond_bounds);
        box.max += Vec3::Constant(beyond_bounds);
        const std::vector<Vec3> corners = plane_in_box(plane_pose(body), box);
        std::vector<Triangle> triangles;
        for (std::uint32_t k = 1; k + 1 < corners.size(); ++k) triangles.push_back({0, k, k + 1});
        // Robots stand on a plane only on the side of its normal, as in Gazebo.
        append_sheet(scene_, part, corners, triangles, true);
    }

    /// Adds a notice for each rule of the options that matches nothing, because it is most often a typing error.
    void note_unused_rules(const std::vector<CollisionBody>& bodies)
    {
        const Names mesh_names = options_.labels.empty() ? Names() : names_of(scene_.face_groups);
        for (const LabelRule& rule : options_.labels) {
            const bool is_used = matches_one(rule.pattern, mesh_names) ||
                                 std::any_of(bodies.begin(), bodies.end(), [&](const CollisionBody& body) {
                                     return matches_body(rule.pattern, body);
                                 });
            if (!is_used)
                scene_.notices.push_back(file_.string() + ": label \"" + rule.pattern +
                                         "\" matches no model, link, collision, node or material");
        }
    }

    Scene& scene_;
    const fs::path file_;
    ModelPaths& paths_;
    const SceneOptions& options_;
    bool is_incomplete_;  ///< a part of the world is missing, which may be the ground
    MeshFiles meshes_;
    std::vector<Label> labels_;   ///< one for each body
    std::vector<bool> by_slope_;  ///< one for each body: no rule gave a label, so the slope decides
    bool everything_is_terrain_ = false;
    std::map<const CollisionBody*, fs::path> files_;
    /// For each URI that is not found: the first body that names it, and the number of bodies.
    std::map<std::string, std::pair<std::string, std::size_t>> not_found_;
    std::vector<std::string> missing_;
    std::size_t ellipsoids_ = 0;
    double ellipsoid_growth_ = 0;  ///< m
};

}  // namespace

void append_bodies(Scene& scene, const fs::path& file, std::vector<CollisionBody> bodies, ModelPaths& paths,
                   const SceneOptions& options, std::vector<std::string> missing)
{
    BodyAppender appender(scene, file, paths, options, !missing.empty());
    appender.append(bodies);
    for (std::string& line : appender.take_missing()) missing.push_back(std::move(line));
    if (options.strict && !missing.empty())
        throw FileError(missing[0], std::to_string(missing.size()) +
                                        " files or parts are missing, and --strict does not allow this");
    scene.notices.insert(scene.notices.end(), missing.begin(), missing.end());
    scene.missing = std::move(missing);
}

}  // namespace spawnfield
