#include "scene/bodies.h"

#include "base/number.h"
#include "scene/extrusion.h"
#include "scene/heightmap.h"
#include "scene/mesh.h"
#include "scene/pieces.h"

#include <spawnfield/error.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace spawnfield {
namespace {

namespace fs = std::filesystem;
using Kind = CollisionGeometry::Kind;

constexpr std::array kind_names{"box", "sphere", "cylinder", "capsule", "ellipsoid", "plane", "mesh", "heightmap", "polyline", "unknown"};
constexpr double beyond_bounds = 50;  // m that planes go on, for what hangs over the map's rim: more than any robot's reach

/// What stands for ground in most worlds; a name matches from the start of one of its words on.
constexpr std::array ground_names{"ground*", "terrain*", "floor*", "road*", "street*", "sidewalk*", "pavement*", "asphalt*", "bridge*", "ramp*"};

/// Whether the glob matches the name from a word's start: "GroundB_01" in "warehouse_GroundB_01".
bool matches_from_a_word(const std::string& glob, const std::string& name)
{
    for (std::size_t start = 0; start < name.size(); ++start) {
        const bool is_start = start == 0 || !std::isalnum(static_cast<unsigned char>(name[start - 1]));
        if (is_start && matches(glob, name.substr(start))) return true;
    }
    return false;
}

bool matches_body(const std::string& glob, const CollisionBody& body)
{
    return matches(glob, scoped_name(body)) ||
           std::any_of(body.names.begin(), body.names.end(), [&](const std::string& name) { return matches(glob, name); });
}

/// The default rules, with what they decided.
class GroundRules {
public:
    GroundRules()
    {
        rules_.push_back({"plane", Label::Terrain, 0});
        rules_.push_back({"heightmap", Label::Terrain, 0});
        for (const char* const name : ground_names) rules_.push_back({std::string("name ") + name, Label::Terrain, 0});
        rules_.push_back({"all else", Label::Obstacle, 0});
    }

    Label label_of(const CollisionBody& body)
    {
        for (std::size_t r = 0; r < rules_.size(); ++r)
            if (holds(r, body)) {
                ++rules_[r].count;
                return rules_[r].label;
            }
        return Label::Obstacle;
    }

    bool has_ground() const { return rules_.back().count == 0 || std::any_of(rules_.begin(), rules_.end() - 1, [](const NameRule& r) { return r.count > 0; }); }
    std::vector<NameRule> take() { return std::move(rules_); }

private:
    bool holds(std::size_t rule, const CollisionBody& body) const
    {
        if (rule == 0) return body.geometry.kind == Kind::Plane;
        if (rule == 1) return body.geometry.kind == Kind::Heightmap;
        if (rule + 1 == rules_.size()) return true;
        return std::any_of(body.names.begin(), body.names.end(), [&](const std::string& name) { return matches_from_a_word(ground_names[rule - 2], name); });
    }

    std::vector<NameRule> rules_;
};

/// A closed mesh around the ellipsoid: rings of latitude, corners so far out that the faces stay outside of it.
FileMesh ellipsoid_mesh(const Vec3& radii, int rings, int around)
{
    const double out = 1 / (std::cos(std::numbers::pi / (2 * rings)) * std::cos(std::numbers::pi / around));
    FileMesh mesh;
    mesh.materials.push_back("");
    FileMesh::Node& node = mesh.nodes.emplace_back();
    node.name = "ellipsoid";
    const auto add = [&](double latitude, double longitude) {
        const Vec3 unit(std::cos(latitude) * std::cos(longitude), std::cos(latitude) * std::sin(longitude), std::sin(latitude));
        node.vertices.push_back(out * unit.cwiseProduct(radii));
    };
    add(-std::numbers::pi / 2, 0);
    for (int ring = 1; ring < rings; ++ring)
        for (int k = 0; k < around; ++k) add(std::numbers::pi * (double(ring) / rings - 0.5), 2 * std::numbers::pi * k / around);
    add(std::numbers::pi / 2, 0);
    const auto corner = [&](int ring, int k) {
        return ring == 0 ? 0u : ring == rings ? std::uint32_t(node.vertices.size() - 1) : std::uint32_t(1 + (ring - 1) * around + k % around);
    };
    for (int ring = 0; ring < rings; ++ring)
        for (int k = 0; k < around; ++k) {
            if (ring > 0) node.triangles.push_back({corner(ring, k), corner(ring, k + 1), corner(ring + 1, k)});
            if (ring + 1 < rings) node.triangles.push_back({corner(ring, k + 1), corner(ring + 1, k + 1), corner(ring + 1, k)});
        }
    node.materials.assign(node.triangles.size(), 0);
    return mesh;
}

/// Heights as Gazebo has them: the brightest pixel lies size.z above black, however bright it is
/// (gazebo::common::ImageHeightmap, HeightmapShape); between pixels, `sampling` - 1 samples are interpolated bilinearly.
Heightmap gazebo_heights(const fs::path& file, const CollisionGeometry& geometry)
{
    std::vector<std::string> ignored;
    const GreyImage image = read_height_file(file, {}, false, ignored).image;
    if (image.rows < 2 || image.cols < 2) throw FileError(file.string(), "has " + std::to_string(image.cols) + " x " + std::to_string(image.rows) + " pixels, needs at least 2 x 2");
    if (image.largest == 0) throw FileError(file.string(), "has float pixels: a <heightmap> needs an image of 8 or 16 bits; bake the elevation model itself");
    const double brightest = *std::max_element(image.pixels.begin(), image.pixels.end());
    const double scale = brightest > 0 ? geometry.size.z() / brightest : 0;
    const int s = int(geometry.sampling);
    const std::uint64_t wanted = (std::uint64_t(image.rows - 1) * s + 1) * (std::uint64_t(image.cols - 1) * s + 1);
    if (wanted > max_heights) throw FileError(file.string(), "has " + std::to_string(wanted) + " samples with <sampling> " + std::to_string(s) + ", needs at most " + std::to_string(max_heights));
    Heightmap map;
    map.size = {geometry.size.x(), geometry.size.y()};
    map.rows = (image.rows - 1) * s + 1;
    map.cols = (image.cols - 1) * s + 1;
    map.heights.reserve(wanted);
    const auto pixel = [&](int row, int col) { return image.pixels[std::size_t(std::min(row, image.rows - 1)) * image.cols + std::min(col, image.cols - 1)]; };
    for (int row = 0; row < map.rows; ++row)
        for (int col = 0; col < map.cols; ++col) {
            const double v = double(row % s) / s, u = double(col % s) / s;
            const double upper = pixel(row / s, col / s) * (1 - u) + pixel(row / s, col / s + 1) * u;
            const double lower = pixel(row / s + 1, col / s) * (1 - u) + pixel(row / s + 1, col / s + 1) * u;
            map.heights.push_back(scale * (upper * (1 - v) + lower * v));
        }
    return map;
}

/// The part of the infinite plane z = 0 of `pose` that lies in the box: a convex polygon's corners, none if they do not meet.
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
            for (std::size_t k = 0; k < polygon.size(); ++k) {
                const Vec3 &p = polygon[k], &q = polygon[(k + 1) % polygon.size()];
                const double dp = sign * p[axis] - limit, dq = sign * q[axis] - limit;
                if (dp <= 0) kept.push_back(p);
                if ((dp < 0 && dq > 0) || (dp > 0 && dq < 0)) kept.push_back(p + dp / (dp - dq) * (q - p));
            }
            polygon = std::move(kept);
        }
    return polygon;
}

class BodyAppender {
public:
    BodyAppender(Scene& scene, const fs::path& file, ModelPaths& paths, const SceneOptions& options)
        : scene_(scene), file_(file), paths_(paths), options_(options)
    {
    }

    /// Keeps pointers to the bodies meanwhile.
    void append(std::vector<CollisionBody>& bodies)
    {
        make_names_unique(bodies);
        find_files(bodies);
        label(bodies);
        for (std::size_t b = 0; b < bodies.size(); ++b)
            if (bodies[b].geometry.kind != Kind::Plane) append_body(bodies[b], labels_[b]);
        choose_bounds(bodies);
        for (std::size_t b = 0; b < bodies.size(); ++b)
            if (bodies[b].geometry.kind == Kind::Plane) append_plane(bodies[b], labels_[b]);
        tell_ellipsoids();
        tell_idle_rules(bodies);
    }

    std::vector<std::string> take_missing()
    {
        for (const auto& [uri, lost] : lost_)
            missing_.push_back(file_.string() + ": " + lost.first + ": " + uri + " is found nowhere" +
                               (lost.second > 1 ? " (" + std::to_string(lost.second) + " collisions)" : "") + ": it is left out");
        return std::move(missing_);
    }

private:
    static void make_names_unique(std::vector<CollisionBody>& bodies)
    {
        std::map<std::string, int> seen;
        for (CollisionBody& body : bodies)
            if (const int before = seen[scoped_name(body)]++; before > 0) body.names.back() += "_" + std::to_string(before + 1);
    }

    /// Files of meshes and heightmaps; what is not found becomes Unknown and is told.
    void find_files(std::vector<CollisionBody>& bodies)
    {
        for (CollisionBody& body : bodies) {
            CollisionGeometry& geometry = body.geometry;
            if (geometry.kind == Kind::Unknown && !geometry.element.empty() && geometry.element != "empty")
                missing_.push_back(file_.string() + ": \"" + scoped_name(body) + "\": <" + geometry.element + "> is no geometry that is known here: it is left out");
            if (geometry.kind != Kind::Mesh && geometry.kind != Kind::Heightmap) continue;
            const fs::path found = paths_.find(geometry.uri, geometry.folder);
            if (fs::is_regular_file(found)) {
                files_[&body] = found;
                if (geometry.kind == Kind::Mesh) meshes_.expect(found);
                continue;
            }
            ++lost_.try_emplace(geometry.uri.empty() ? "a mesh without <uri>" : geometry.uri, "\"" + scoped_name(body) + "\"", std::size_t{0}).first->second.second;
            geometry.kind = Kind::Unknown;
            geometry.element.clear();
        }
    }

    void label(const std::vector<CollisionBody>& bodies)
    {
        GroundRules rules;
        std::size_t unknown = 0;
        for (const CollisionBody& body : bodies) {
            const bool counts = body.geometry.kind != Kind::Unknown;
            unknown += !counts;
            const auto told = std::find_if(options_.labels.begin(), options_.labels.end(), [&](const LabelRule& rule) { return matches_body(rule.pattern, body); });
            labels_.push_back(!counts ? Label::Ignore : told != options_.labels.end() ? told->label : rules.label_of(body));
        }
        if (!rules.has_ground() && options_.labels.empty()) {
            scene_.rules.push_back({"all: nothing is a plane, a heightmap or named as ground", Label::Terrain, bodies.size() - unknown});
            scene_.notices.push_back(file_.string() + ": nothing in it is a plane, a heightmap or named as ground, so everything is terrain (--label 'GLOB=LABEL' tells it apart)");
            std::replace(labels_.begin(), labels_.end(), Label::Obstacle, Label::Terrain);
            return;
        }
        scene_.rules = rules.take();
    }

    /// The options' rules, those that match the body for all of its faces.
    std::vector<FaceRule> rules_for(const CollisionBody& body) const
    {
        std::vector<FaceRule> out;
        for (const LabelRule& rule : options_.labels)
            out.push_back({matches_body(rule.pattern, body) ? "*" : rule.pattern, true, true, rule.label});
        return out;
    }

    std::uint32_t add_part(const CollisionBody& body, Label label)
    {
        Part part;
        part.name = scoped_name(body);
        part.kind = kind_names[std::size_t(body.geometry.kind)];
        part.label = label;
        scene_.parts.push_back(std::move(part));
        return std::uint32_t(scene_.parts.size() - 1);
    }

    void append_body(const CollisionBody& body, Label label)
    {
        const CollisionGeometry& geometry = body.geometry;
        if (geometry.kind == Kind::Unknown) return;
        const std::uint32_t part = add_part(body, label);
        if (const std::optional<Shape> shape = shape_of(geometry, body.pose)) {
            if (label == Label::Ignore) return;
            scene_.primitives.push_back({*shape, part, label});
            scene_.parts[part].solid_pieces = 1;
            return;
        }
        try {
            if (geometry.kind == Kind::Heightmap) {
                const Pose middle = body.pose * Pose{geometry.position, Mat3::Identity()};
                if (label != Label::Ignore) append_heightmap(scene_, part, gazebo_heights(files_.at(&body), geometry), middle, true);
            } else if (geometry.kind == Kind::Polyline) {
                append_mesh_body(body, part, extruded(geometry.outlines, geometry.size[0]), Vec3::Ones());
            } else if (geometry.kind == Kind::Ellipsoid) {
                append_ellipsoid(body, part);
            } else {
                const auto mesh = meshes_.read(files_.at(&body));
                if (geometry.submesh.empty()) append_mesh_body(body, part, *mesh, geometry.size);
                else append_mesh_body(body, part, submesh_of(*mesh, geometry, files_.at(&body).string()), geometry.size);
            }
        } catch (const std::domain_error& error) {
            throw FileError(file_.string(), "\"" + scoped_name(body) + "\": <polyline>: " + error.what());
        } catch (const FileError& error) {
            throw FileError(file_.string(), "\"" + scoped_name(body) + "\": " + error.what());
        }
    }

    void append_mesh_body(const CollisionBody& body, std::uint32_t part, const FileMesh& mesh, const Vec3& scale)
    {
        MeshOptions options;
        options.pose = body.pose;
        options.scale = scale;
        options.up = 'z';  // as Gazebo: a file's own axes count, whatever it says is up
        options.rules = rules_for(body);
        const MeshNames names = append_mesh(scene_, part, mesh, options);
        if (options_.labels.empty()) return;
        mesh_names_.insert(names.nodes.begin(), names.nodes.end());
        mesh_names_.insert(names.materials.begin(), names.materials.end());
    }

    void append_ellipsoid(const CollisionBody& body, std::uint32_t part)
    {
        constexpr int rings = 48, around = 96;
        append_mesh_body(body, part, ellipsoid_mesh(body.geometry.size, rings, around), Vec3::Ones());
        const double out = 1 / (std::cos(std::numbers::pi / (2 * rings)) * std::cos(std::numbers::pi / around)) - 1;
        ++ellipsoids_;
        ellipsoid_growth_ = std::max(ellipsoid_growth_, out * body.geometry.size.maxCoeff());
    }

    void tell_ellipsoids()
    {
        if (ellipsoids_ > 0)
            scene_.notices.push_back(file_.string() + ": " + std::to_string(ellipsoids_) + (ellipsoids_ == 1 ? " ellipsoid is" : " ellipsoids are") +
                                     " a mesh around it, at most " + number(std::ceil(ellipsoid_growth_ * 1e4) / 1e4) + " m larger");
    }

    /// Those of the options; else all but the planes, and these as far as they are drawn.
    void choose_bounds(const std::vector<CollisionBody>& bodies)
    {
        scene_.map_bounds = options_.bounds;
        if (!scene_.map_bounds.is_empty()) return;
        bool has_plane = false;
        Bounds all = scene_.bounds();
        for (const CollisionBody& body : bodies)
            if (body.geometry.kind == Kind::Plane) {
                has_plane = true;
                for (const double u : {-0.5, 0.5})
                    for (const double v : {-0.5, 0.5}) {
                        const Pose pose = plane_pose(body);
                        all.extend(pose.position + pose.rotation * Vec3(u * body.geometry.size[0], v * body.geometry.size[1], 0));
                    }
            }
        if (has_plane) scene_.map_bounds = all;
    }

    static Pose plane_pose(const CollisionBody& body)
    {
        const Mat3 turn = Eigen::Quaterniond::FromTwoVectors(Vec3::UnitZ(), body.geometry.normal).toRotationMatrix();
        return body.pose * Pose{Vec3::Zero(), turn};
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
        // Gazebo's planes bear on the side that their normal looks to.
        append_sheet(scene_, part, corners, triangles, true);
    }

    /// Rules of the options that match nothing: most often slips of the pen.
    void tell_idle_rules(const std::vector<CollisionBody>& bodies)
    {
        for (const LabelRule& rule : options_.labels) {
            const auto is_match = [&](const std::string& name) { return matches(rule.pattern, name); };
            const bool is_used = std::any_of(mesh_names_.begin(), mesh_names_.end(), is_match) ||
                                 std::any_of(bodies.begin(), bodies.end(), [&](const CollisionBody& body) { return matches_body(rule.pattern, body); });
            if (!is_used)
                scene_.notices.push_back(file_.string() + ": label \"" + rule.pattern + "\" matches no model, link, collision, node or material");
        }
    }

    Scene& scene_;
    const fs::path file_;
    ModelPaths& paths_;
    const SceneOptions& options_;
    MeshFiles meshes_;
    std::vector<Label> labels_;  ///< one for each body
    std::map<const CollisionBody*, fs::path> files_;
    std::map<std::string, std::pair<std::string, std::size_t>> lost_;  ///< by URI: whose first, how often
    std::vector<std::string> missing_;
    std::set<std::string> mesh_names_;
    std::size_t ellipsoids_ = 0;
    double ellipsoid_growth_ = 0;  ///< m
};

}  // namespace

void append_bodies(Scene& scene, const fs::path& file, std::vector<CollisionBody> bodies, ModelPaths& paths, const SceneOptions& options,
                   std::vector<std::string> missing)
{
    BodyAppender appender(scene, file, paths, options);
    appender.append(bodies);
    for (std::string& line : appender.take_missing()) missing.push_back(std::move(line));
    if (options.strict && !missing.empty()) throw FileError(missing[0], std::to_string(missing.size()) + " in all are missing, and --strict does not allow it");
    scene.notices.insert(scene.notices.end(), missing.begin(), missing.end());
}

}  // namespace spawnfield
