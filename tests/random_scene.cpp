#include "random_scene.h"

#include "slow.h"
#include "worlds/hand_scene.h"

#include <Eigen/Geometry>

#include <cmath>
#include <map>

using namespace spawnfield;

namespace {

using Height = std::function<double(double x, double y)>;

// Function calls contain at most one draw, because C++ may evaluate arguments in any order. Braced lists are evaluated
// from left to right.

/// A scene while it is built.
struct Yard {
    Random random;
    Height ground;
    Scene scene;
};

Label matter(Random& random) { return random.chance(0.45) ? Label::Terrain : Label::Obstacle; }

Mat3 any_rotation(Random& random)
{
    const double roll = random.between(-M_PI, M_PI), pitch = random.between(-M_PI / 2, M_PI / 2);
    return rotation_of_rpy(roll, pitch, random.between(-M_PI, M_PI));
}

Mat3 upright_or_any(Random& random, double upright)
{
    if (random.chance(upright)) return rotation_of_rpy(0, 0, random.between(-M_PI, M_PI));
    return any_rotation(random);
}

/// Returns a random place in the yard, `lift` above the ground.
Vec3 spot(Yard& yard, double lift)
{
    const double x = yard.random.between(-8.5, 8.5), y = yard.random.between(-8.5, 8.5);
    return {x, y, yard.ground(x, y) + lift};
}

Vec3 sizes(Random& random, double low, double high)
{
    const double x = random.between(low, high), y = random.between(low, high), z = random.between(low, high);
    return {x, y, z};
}

/// Returns points on an ellipsoid, so that all of them are corners of their hull.
std::vector<Vec3> points_around(Random& random, int count, const Vec3& radii)
{
    std::vector<Vec3> points;
    for (int i = 0; i < count; ++i) {
        const Vec3 direction = any_rotation(random).col(0);
        points.push_back(direction.cwiseProduct(radii));
    }
    return points;
}

// ---- Ground ----

Height random_height(Random& random)
{
    const double rise = random.between(0, 0.8), turn = random.between(0, 2 * M_PI), wave = random.between(0.2, 0.7);
    return [=](double x, double y) {
        const double along = x * std::cos(turn) + y * std::sin(turn);
        const double across = y * std::cos(turn) - x * std::sin(turn);
        return rise * std::sin(wave * along) * std::cos(0.6 * wave * across + turn);
    };
}

/// Returns labels of terrain with random faces of obstacle and water.
std::vector<Label> mixed_labels(Random& random, std::size_t count)
{
    std::vector<Label> labels(count, Label::Terrain);
    for (Label& label : labels)
        if (random.chance(0.15)) label = random.chance(0.7) ? Label::Obstacle : Label::Water;
    return labels;
}

void add_relief(Yard& yard)
{
    hand::Mesh mesh = hand::relief(16, 20, yard.ground);
    hand::MeshOptions options = {.kind = yard.random.chance(0.5) ? "heightmap" : "mesh"};
    options.sides_up = yard.random.chance(0.4);
    if (options.kind == "mesh") {
        if (yard.random.chance(0.5)) options.labels = mixed_labels(yard.random, mesh.triangles.size());
        for (Triangle& t : mesh.triangles)
            if (yard.random.chance(0.1)) std::swap(t[1], t[2]);
    }
    hand::add_mesh(yard.scene, Label::Terrain, mesh, options);
}

void add_floor(Yard& yard)
{
    yard.ground = [](double, double) { return 0.0; };
    if (yard.random.chance(0.3)) {
        hand::add_mesh(yard.scene, Label::Terrain, hand::rectangle(20, 20), {.kind = "plane"});
    } else {
        const double depth = yard.random.between(0.05, 1);
        const Pose place = {{0, 0, -depth / 2}, Mat3::Identity()};
        hand::add_shape(yard.scene, Label::Terrain, {ShapeKind::Box, {20, 20, depth}, place});
    }
}

// ---- Things ----

void add_box(Yard& yard)
{
    const Vec3 size = sizes(yard.random, 0.2, 2.5);
    const Pose place = {spot(yard, yard.random.between(-0.3, 1.5)), upright_or_any(yard.random, 0.6)};
    hand::add_shape(yard.scene, matter(yard.random), {ShapeKind::Box, size, place});
}

/// Adds a plate or a wedge that is partly in the ground.
void add_ramp(Yard& yard)
{
    const double length = yard.random.between(2, 6), width = yard.random.between(1, 2.5);
    const double slope = yard.random.between(0.1, 0.6), yaw = yard.random.between(-M_PI, M_PI);
    const Vec3 place = spot(yard, yard.random.between(-0.2, 0.6));
    if (yard.random.chance(0.5)) {
        const Mat3 rotation = rotation_of_rpy(0, -slope, yaw);
        hand::add_shape(yard.scene, Label::Terrain, {ShapeKind::Box, {length, width, 0.2}, {place, rotation}});
    } else {
        const hand::Mesh wedge = hand::extruded({{0, 0}, {length, 0}, {length, length * slope}}, -width / 2, width / 2);
        hand::add_mesh(yard.scene, Label::Terrain, hand::moved(wedge, {place, rotation_of_rpy(M_PI / 2, 0, yaw)}));
    }
}

void add_ball(Yard& yard)
{
    const double radius = yard.random.between(0.1, 1.5);
    const Vec3 place = spot(yard, yard.random.between(-radius, 2));
    hand::add_shape(yard.scene, matter(yard.random), {ShapeKind::Sphere, {radius, 0, 0}, {place, Mat3::Identity()}});
}

void add_drum(Yard& yard)
{
    const ShapeKind kind = yard.random.chance(0.5) ? ShapeKind::Cylinder : ShapeKind::Capsule;
    const Vec3 size = {yard.random.between(0.1, 1), yard.random.between(0.2, 3), 0};
    const Pose place = {spot(yard, yard.random.between(-0.3, 1.5)), upright_or_any(yard.random, 0.3)};
    hand::add_shape(yard.scene, matter(yard.random), {kind, size, place});
}

void add_rock(Yard& yard)
{
    const Vec3 radii = sizes(yard.random, 0.3, 1.5);
    const hand::Mesh mesh = hand::convex_hull(points_around(yard.random, 6 + yard.random.below(9), radii));
    const Pose place = {spot(yard, yard.random.between(-0.4, 1)), any_rotation(yard.random)};
    const bool fill = yard.random.chance(0.85);
    hand::add_mesh(yard.scene, matter(yard.random), hand::moved(mesh, place), {.fill = fill});
}

/// Adds a closed mesh that is not convex. Some have a different label for each face, some are wound inside out.
void add_corner(Yard& yard)
{
    const double width = yard.random.between(1, 3), thickness = yard.random.between(0.2, 0.8);
    hand::Mesh mesh = hand::extruded(
        {{thickness, thickness}, {thickness, width}, {0, width}, {0, 0}, {width, 0}, {width, thickness}}, 0,
        yard.random.between(0.3, 2));
    if (yard.random.chance(0.3)) mesh = hand::flipped(mesh);
    hand::MeshOptions options;
    if (yard.random.chance(0.4))
        for (std::size_t i = 0; i < mesh.triangles.size(); ++i) options.labels.push_back(matter(yard.random));
    const Pose place = {spot(yard, yard.random.between(-0.2, 0.5)), upright_or_any(yard.random, 0.6)};
    hand::add_mesh(yard.scene, matter(yard.random), hand::moved(mesh, place), options);
}

/// Adds a closed piece inside another one. This makes no cavity.
void add_nested(Yard& yard)
{
    const Vec3 size = sizes(yard.random, 1.5, 3);
    const Pose place = {spot(yard, yard.random.between(0, 1.5)), upright_or_any(yard.random, 0.6)};
    hand::add_mesh(yard.scene, matter(yard.random), hand::moved(hand::box(size), place));
    hand::add_piece(yard.scene, hand::moved(hand::flipped(hand::box(0.8 * size)), place));
}

/// Adds four walls, a floor and a roof. Mostly one side is missing; then the walls have no thickness and the inside is
/// free.
void add_house(Yard& yard)
{
    const Vec3 size = {yard.random.between(2, 4), yard.random.between(2, 4), yard.random.between(1.5, 3)};
    hand::Mesh mesh = hand::box(size);
    if (yard.random.chance(0.8)) mesh = hand::without(mesh, 2 * std::size_t(yard.random.below(4)), 2);
    const Pose place = {spot(yard, size.z() / 2 + yard.random.between(-0.1, 0.3)), upright_or_any(yard.random, 0.9)};
    hand::add_mesh(yard.scene, matter(yard.random), hand::moved(mesh, place));
}

void add_wall(Yard& yard)
{
    const Vec3 size = {yard.random.between(1, 5), 0.02, yard.random.between(0.3, 2.5)};
    const Pose place = {spot(yard, size.z() / 2), upright_or_any(yard.random, 0.8)};
    if (yard.random.chance(0.5))
        hand::add_shape(yard.scene, Label::Obstacle, {ShapeKind::Box, size, place});
    else
        hand::add_mesh(yard.scene, Label::Obstacle, hand::moved(hand::box(size), place));
}

void add_pole(Yard& yard)
{
    const double length = yard.random.between(0.5, 4);
    const Pose place = {spot(yard, yard.random.between(0, length / 2)), upright_or_any(yard.random, 0.7)};
    if (yard.random.chance(0.6)) {
        hand::add_shape(yard.scene, Label::Obstacle, {ShapeKind::Cylinder, {0.025, length, 0}, place});
    } else {
        hand::add_mesh(yard.scene, Label::Obstacle, hand::moved(hand::box({0.05, 0.05, length}), place));
    }
}

/// Adds a plate overhead: a box, or a sheet with either winding.
void add_storey(Yard& yard)
{
    const double size_x = yard.random.between(2, 7), size_y = yard.random.between(2, 7);
    const Label label = yard.random.chance(0.75) ? Label::Terrain : Label::Obstacle;
    const double tilt = yard.random.chance(0.5) ? yard.random.between(-0.2, 0.2) : 0;
    const double yaw = yard.random.between(-M_PI, M_PI);
    const Pose place = {spot(yard, yard.random.between(0.8, 3)), rotation_of_rpy(tilt, 0, yaw)};
    if (yard.random.chance(0.5)) {
        const double thickness = yard.random.between(0.05, 0.3);
        hand::add_shape(yard.scene, label, {ShapeKind::Box, {size_x, size_y, thickness}, place});
        return;
    }
    const hand::Mesh mesh = hand::moved(hand::rectangle(size_x, size_y), place);
    const bool sides_up = yard.random.chance(0.5);
    hand::add_mesh(yard.scene, label, yard.random.chance(0.3) ? hand::flipped(mesh) : mesh,
                   {.kind = "plane", .sides_up = sides_up});
}

void add_water(Yard& yard)
{
    const double size_x = yard.random.between(2, 6), size_y = yard.random.between(2, 6);
    const double yaw = yard.random.between(-M_PI, M_PI);
    const Pose place = {spot(yard, yard.random.between(-0.4, 0.6)), rotation_of_rpy(0, 0, yaw)};
    if (yard.random.chance(0.5)) {
        hand::add_mesh(yard.scene, Label::Water, hand::moved(hand::rectangle(size_x, size_y), place),
                       {.kind = "plane"});
    } else {
        hand::add_shape(yard.scene, Label::Water,
                        {ShapeKind::Box, {size_x, size_y, yard.random.between(0.1, 1)}, place});
    }
}

// ---- Robots ----

void add_hull(RobotPart& part, Random& random, const Vec3& centre)
{
    const Vec3 size = sizes(random, 0.15, 0.5);
    const hand::Mesh mesh = random.chance(0.5) ? hand::convex_hull(points_around(random, 5 + random.below(6), size))
                                               : hand::box(size);
    const Pose place = {centre, any_rotation(random)};
    part.shape.kind = ShapeKind::Hull;
    part.hull_vertices = hand::moved(mesh, place).vertices;
    for (const Triangle& t : mesh.triangles) part.hull_faces.push_back({int(t[0]), int(t[1]), int(t[2])});
}

RobotPart random_part(Random& random)
{
    RobotPart part;
    const Vec3 centre = {random.between(-0.3, 0.3), random.between(-0.3, 0.3), random.between(0.15, 0.5)};
    switch (random.below(5)) {
    case 0: part.shape = {ShapeKind::Box, sizes(random, 0.1, 0.7), {centre, upright_or_any(random, 0.7)}}; break;
    case 1: part.shape = {ShapeKind::Sphere, {random.between(0.05, 0.4), 0, 0}, {centre, Mat3::Identity()}}; break;
    case 2:
    case 3: {
        const ShapeKind kind = random.chance(0.5) ? ShapeKind::Cylinder : ShapeKind::Capsule;
        const Vec3 size = {random.between(0.05, 0.3), random.between(0.05, 0.6), 0};
        part.shape = {kind, size, {centre, upright_or_any(random, 0.4)}};
        break;
    }
    default: add_hull(part, random, centre);
    }
    return part;
}

// ---- Poses ----

/// Returns a place near a vertex or a primitive of the scene, where verdicts change.
Vec3 near_something(const Scene& scene, Random& random)
{
    const int count = int(scene.pieces.size() + scene.primitives.size());
    const auto pick = std::size_t(random.below(std::max(count, 1)));
    Vec3 place = Vec3::Zero();
    if (pick < scene.pieces.size()) {
        const Piece& piece = scene.pieces[pick];
        const auto triangle = piece.first_triangle + std::uint32_t(random.below(int(piece.triangle_count)));
        place = scene.vertices[scene.triangles[triangle][0]];
    } else if (!scene.primitives.empty()) {
        place = scene.primitives[pick - scene.pieces.size()].shape.pose.position;
    }
    return place + Vec3{random.between(-1.5, 1.5), random.between(-1.5, 1.5), 0};
}

double random_z(const Scene& scene, const Bounds& bounds, Random& random, double x, double y)
{
    const slow::Column column = slow::column(scene, x, y);
    if (column.spans.empty() || random.chance(0.1)) return random.between(bounds.min.z() - 0.5, bounds.max.z() + 2);
    const double top = column.spans[std::size_t(random.below(int(column.spans.size())))].top;
    return top + (random.chance(0.6) ? random.between(0, 0.3) : random.between(0, 1.5));
}

Mat3 random_attitude(Random& random)
{
    const double yaw = random.between(-M_PI, M_PI);
    if (random.chance(0.7)) return rotation_of_rpy(0, 0, yaw);
    if (random.chance(0.2)) return any_rotation(random);
    const double roll = random.between(-0.3, 0.3), pitch = random.between(-0.3, 0.3);
    return rotation_of_rpy(roll, pitch, yaw);
}

}  // namespace

Mat3 rotation_of_rpy(double roll, double pitch, double yaw)
{
    using Eigen::AngleAxisd;
    return (AngleAxisd(yaw, Vec3::UnitZ()) * AngleAxisd(pitch, Vec3::UnitY()) * AngleAxisd(roll, Vec3::UnitX()))
        .toRotationMatrix();
}

Scene random_scene(std::uint64_t seed)
{
    Yard yard = {Random{seed}, {}, {}};
    yard.scene.name = "random-" + std::to_string(seed);
    yard.ground = random_height(yard.random);
    if (yard.random.chance(0.6))
        add_relief(yard);
    else
        add_floor(yard);
    constexpr std::array things = {add_box,    add_ramp,  add_ball, add_drum, add_rock,   add_corner,
                                   add_nested, add_house, add_wall, add_pole, add_storey, add_water};
    const int count = 8 + yard.random.below(16);
    for (int i = 0; i < count; ++i) things[std::size_t(yard.random.below(int(things.size())))](yard);
    return yard.scene;
}

Robot random_robot(std::uint64_t seed)
{
    Random random{seed};
    Robot robot;
    robot.name = "random-" + std::to_string(seed);
    const int count = 1 + random.below(4);
    for (int i = 0; i < count; ++i) robot.parts.push_back(random_part(random));
    return robot;
}

std::vector<Pose> random_poses(const Scene& scene, std::uint64_t seed, std::size_t count)
{
    Random random{seed};
    const Bounds bounds = rough_bounds(scene);
    std::vector<Pose> poses;
    for (std::size_t i = 0; i < count; ++i) {
        Pose pose;
        pose.position = {random.between(bounds.min.x() - 0.5, bounds.max.x() + 0.5),
                         random.between(bounds.min.y() - 0.5, bounds.max.y() + 0.5), 0};
        if (random.chance(0.5)) pose.position = near_something(scene, random);
        pose.position.z() = random_z(scene, bounds, random, pose.position.x(), pose.position.y());
        pose.rotation = random_attitude(random);
        poses.push_back(pose);
    }
    return poses;
}

Bounds rough_bounds(const Scene& scene)
{
    Bounds bounds;
    for (const Vec3& vertex : scene.vertices) bounds.extend(vertex);
    for (const Primitive& primitive : scene.primitives) {
        const Shape& shape = primitive.shape;
        const double reach = shape.kind == ShapeKind::Box ? shape.size.norm() / 2 : shape.size.x() + shape.size.y() / 2;
        bounds.extend(shape.pose.position - Vec3::Constant(reach));
        bounds.extend(shape.pose.position + Vec3::Constant(reach));
    }
    return bounds;
}

Scene scene_of_parts(const Scene& from, const std::vector<std::uint32_t>& parts)
{
    Scene out;
    out.name = from.name;
    for (const std::uint32_t part : parts) {
        const auto number = std::uint32_t(out.parts.size());
        out.parts.push_back(from.parts[part]);
        std::map<std::uint32_t, std::uint32_t> vertices;
        for (const Piece& piece : from.pieces) {
            if (piece.part != part) continue;
            const auto first = std::uint32_t(out.triangles.size());
            for (std::uint32_t t = piece.first_triangle; t < piece.first_triangle + piece.triangle_count; ++t) {
                Triangle corners = from.triangles[t];
                for (std::uint32_t& corner : corners) {
                    const auto [place, is_new] = vertices.emplace(corner, std::uint32_t(out.vertices.size()));
                    if (is_new) out.vertices.push_back(from.vertices[corner]);
                    corner = place->second;
                }
                out.triangles.push_back(corners);
                out.triangle_labels.push_back(from.triangle_labels[t]);
                out.triangle_pieces.push_back(std::uint32_t(out.pieces.size()));
            }
            out.pieces.push_back(piece);
            out.pieces.back().part = number;
            out.pieces.back().first_triangle = first;
        }
        for (const Primitive& primitive : from.primitives)
            if (primitive.part == part) out.primitives.push_back({primitive.shape, number, primitive.label});
    }
    return out;
}
