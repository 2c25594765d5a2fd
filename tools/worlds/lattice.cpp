#include "lattice.h"

#include "things.h"

#include <cmath>
#include <numbers>

using namespace spawnfield;

namespace worlds {
namespace {

Mat3 any_rotation(Random& random)
{
    const double roll = random.between(-std::numbers::pi, std::numbers::pi), pitch = random.between(-1.5, 1.5);
    return rotation_from_rpy(roll, pitch, random.between(-std::numbers::pi, std::numbers::pi));
}

template <class Add>
Scene lattice(const char* name, const std::array<int, 3>& counts, const Add& add)
{
    Scene scene;
    scene.name = name;
    for (int k = 0; k < counts[2]; ++k)
        for (int j = 0; j < counts[1]; ++j)
            for (int i = 0; i < counts[0]; ++i) add(scene, Vec3(i, j, k));
    return scene;
}

}  // namespace

Scene grid_of_boxes(int cols, int rows, int heights, std::uint64_t seed)
{
    Random random(seed);
    return lattice("grid-box", {cols, rows, heights}, [&](Scene& scene, const Vec3& place) {
        Shape box;
        for (double& side : box.size) side = random.between(0.2, 0.4);
        box.pose = {place, any_rotation(random)};
        hand::add_shape(scene, Label::Obstacle, box);
    });
}

Scene grid_of_balls(int cols, int rows, int heights, std::uint64_t seed)
{
    Random random(seed);
    return lattice("grid-hull", {cols, rows, heights}, [&](Scene& scene, const Vec3& place) {
        hand::Mesh mesh = ball();
        // These are drawn one by one, because compilers may compute arguments in any order.
        const double z = random.between(0.1, 0.2), y = random.between(0.1, 0.2), x = random.between(0.1, 0.2);
        const Vec3 radii(x, y, z);
        for (Vec3& vertex : mesh.vertices) vertex = vertex.cwiseProduct(radii);
        hand::add_mesh(scene, Label::Obstacle, hand::moved(mesh, {place, any_rotation(random)}));
    });
}

Scene empty_scene()
{
    Scene scene;
    scene.name = "empty";
    return scene;
}

Robot hull_robot()
{
    constexpr int slices = 16, rings = 7;  // rings of corners between the poles
    const Vec3 radii(0.495, 0.335, 0.195), centre(0, 0, 0.195);
    RobotPart part;
    part.shape.kind = ShapeKind::Hull;
    const auto add = [&](const Vec3& unit) { part.hull_vertices.push_back(centre + unit.cwiseProduct(radii)); };
    add({0, 0, -1});
    for (int ring = 1; ring <= rings; ++ring)
        for (int slice = 0; slice < slices; ++slice) {
            const double up = std::numbers::pi * ring / (rings + 1), around = 2 * std::numbers::pi * slice / slices;
            add({std::sin(up) * std::cos(around), std::sin(up) * std::sin(around), -std::cos(up)});
        }
    add({0, 0, 1});
    const auto corner = [](int ring, int slice) { return 1 + ring * slices + slice % slices; };
    for (int slice = 0; slice < slices; ++slice) {
        part.hull_faces.push_back({0, corner(0, slice + 1), corner(0, slice)});
        part.hull_faces.push_back({corner(rings - 1, slice), corner(rings - 1, slice + 1), 1 + rings * slices});
        for (int ring = 0; ring + 1 < rings; ++ring) {
            part.hull_faces.push_back({corner(ring, slice), corner(ring, slice + 1), corner(ring + 1, slice + 1)});
            part.hull_faces.push_back({corner(ring, slice), corner(ring + 1, slice + 1), corner(ring + 1, slice)});
        }
    }
    Robot robot;
    robot.name = "hull";
    robot.parts.push_back(std::move(part));
    return robot;
}

}  // namespace worlds
