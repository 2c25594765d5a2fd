#include "arrays.h"
#include "bindings.h"

#include <spawnfield/error.h>
#include <spawnfield/map.h>
#include <spawnfield/poses.h>
#include <spawnfield/robot.h>
#include <spawnfield/scene_parts.h>

#include <nanobind/stl/map.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <array>
#include <map>

namespace spawnfield::python {
namespace {

Label label_called(const std::string& name)
{
    for (const Label label : {Label::Terrain, Label::Obstacle, Label::Water})
        if (name == to_string(label)) return label;
    throw ArgumentError("--label is \"" + name + "\", needs terrain, obstacle or water");
}

Solid solid_called(const std::string& name)
{
    if (name == "auto") return Solid::Auto;
    if (name == "yes") return Solid::Yes;
    if (name == "no") return Solid::No;
    throw ArgumentError("--solid is \"" + name + "\", needs auto, yes or no");
}

/// Adds triangles with the vertices that they index.
void add_triangles(Scene& scene, const std::string& name, const std::string& label, const Numbers& vertices,
                   const Indices& faces, const std::string& solid)
{
    if (vertices.ndim() != 2 || vertices.shape(1) != 3)
        throw ArgumentError("--vertices needs an array of shape (n, 3)");
    if (faces.ndim() != 2 || faces.shape(1) != 3) throw ArgumentError("--faces needs an array of shape (n, 3)");
    std::vector<Vec3> points;
    for (std::size_t i = 0; i < vertices.shape(0); ++i) points.emplace_back(vertices.data() + 3 * i);
    std::vector<Triangle> triangles;
    for (std::size_t i = 0; i < faces.shape(0); ++i) {
        Triangle triangle;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::int64_t index = faces.data()[3 * i + k];
            if (index < 0 || std::size_t(index) >= points.size())
                throw ArgumentError("--faces: row " + std::to_string(i) + " has the vertex " + std::to_string(index) +
                                    ", but there are " + std::to_string(points.size()) + " vertices");
            triangle[k] = std::uint32_t(index);
        }
        triangles.push_back(triangle);
    }
    add_mesh(scene, name, label_called(label), points, triangles, solid_called(solid));
}

/// Adds a box, cylinder, capsule or sphere. `pose`: array of shape (1, 7), as for poses_of().
void add_solid(Scene& scene, const std::string& name, const std::string& label, const std::string& kind,
               const std::array<double, 3>& size, const Numbers& pose)
{
    Shape shape{.size = {size[0], size[1], size[2]}, .pose = poses_of(pose).at(0)};
    for (const ShapeKind one : {ShapeKind::Box, ShapeKind::Sphere, ShapeKind::Cylinder, ShapeKind::Capsule})
        if (kind == to_string(one)) shape.kind = one;
    add_shape(scene, name, label_called(label), shape);
}

std::shared_ptr<Robot> robot_of(const std::string& file, const std::vector<std::string>& model_paths,
                                const std::map<std::string, double>& joints, int mesh_parts)
{
    RobotOptions options;
    options.model_paths.assign(model_paths.begin(), model_paths.end());
    for (const auto& [name, value] : joints) options.joints.push_back({name, value});
    options.mesh_parts = mesh_parts;
    return std::make_shared<Robot>(load_robot(file, options));
}

nb::dict about(const Robot& robot)
{
    const auto list_of = [](const Vec3& value) { return std::vector{value.x(), value.y(), value.z()}; };
    nb::dict out;
    out["name"] = robot.name;
    out["parts"] = robot.parts.size();
    out["lower"] = list_of(robot.bounds().min);
    out["upper"] = list_of(robot.bounds().max);
    out["mass_center"] = list_of(mass_center_of(robot));
    out["notices"] = robot.notices;
    return out;
}

nb::dict about(const Map& map)
{
    const auto list_of = [](const Vec3& value) { return std::vector{value.x(), value.y(), value.z()}; };
    nb::dict out;
    out["name"] = map.name;
    out["folder"] = map.folder.string();
    out["hash"] = map.hash;
    out["resolution"] = map.resolution;
    out["lower"] = list_of(map.bounds.min);
    out["upper"] = list_of(map.bounds.max);
    out["layers"] = map.layers;
    return out;
}

/// Returns poses as `check` and other commands read them. `has_text`: with the rows of a CSV file, for results that are
/// files.
std::shared_ptr<PoseTable> table_of(const Numbers& numbers, bool has_text)
{
    auto out = std::make_shared<PoseTable>();
    out->poses = poses_of(numbers);
    static const std::map<std::size_t, std::string> headers{
        {3, "x,y,z"}, {4, "x,y,z,yaw"}, {6, "x,y,z,roll,pitch,yaw"}, {7, "x,y,z,qx,qy,qz,qw"}};
    out->header = headers.at(numbers.shape(1));
    out->rows = has_text ? rows_of(numbers) : std::vector<std::string>(out->poses.size());
    return out;
}

}  // namespace

void bind_scenes(nb::module_& module)
{
    nb::class_<Scene>(module, "Scene")
        .def(nb::init<>())
        .def_rw("name", &Scene::name)
        .def_rw("is_unlabelled", &Scene::is_unlabelled)
        .def("add_triangles", &add_triangles)
        .def("add_solid",
             [](Scene& scene, const std::string& name, const std::string& label, const std::string& kind, double a,
                double b, double c, const Numbers& pose) {
                 add_solid(scene, name, label, kind, {a, b, c}, pose);
             })
        .def("part_names", [](const Scene& scene) {
            std::vector<std::string> names;
            for (const Part& part : scene.parts) names.push_back(part.name);
            return names;
        });
    nb::class_<Robot>(module, "Robot").def("about", [](const Robot& robot) { return about(robot); });
    module.def("load_robot", &robot_of);
    nb::class_<Map>(module, "Map").def("about", [](const Map& map) { return about(map); });
    module.def("read_map", [](const std::string& folder) {
        const nb::gil_scoped_release unlocked;
        return std::make_shared<Map>(read_map(folder));
    });
    nb::class_<PoseTable>(module, "Poses");
    module.def("poses", &table_of);
}

}  // namespace spawnfield::python
