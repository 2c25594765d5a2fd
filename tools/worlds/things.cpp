#include "things.h"

#include <Eigen/Geometry>

#include <cmath>
#include <map>
#include <numbers>

using namespace spawnfield;

namespace worlds {

using Vec2 = Eigen::Vector2d;

hand::Mesh profile_along_x(const std::vector<Vec2>& profile, double length)
{
    Mat3 rotation;
    rotation << 0, 0, 1, 1, 0, 0, 0, 1, 0;
    return hand::moved(hand::extruded(profile, -length / 2, length / 2), {Vec3::Zero(), rotation});
}

hand::Mesh profile_along_y(const std::vector<Vec2>& profile, double y0, double y1)
{
    Mat3 upright;  // (x, y, z) to (x, -z, y)
    upright << 1, 0, 0, 0, 0, -1, 0, 1, 0;
    return hand::moved(hand::extruded(profile, -y1, -y0), {Vec3::Zero(), upright});
}

namespace {

Mat3 turned(double angle, const Vec3& axis) { return Eigen::AngleAxisd(angle, axis).toRotationMatrix(); }

hand::Mesh box(const Vec3& size, const Vec3& centre)
{
    return hand::moved(hand::box(size), {centre, Mat3::Identity()});
}

std::vector<Vec2> circle(int corners, double radius)
{
    std::vector<Vec2> polygon;
    for (int i = 0; i < corners; ++i) {
        const double angle = 2 * std::numbers::pi * i / corners;
        polygon.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
    }
    return polygon;
}

hand::Mesh cone(int corners, double radius, double bottom, double top)
{
    hand::Mesh mesh;
    for (const Vec2& corner : circle(corners, radius)) mesh.vertices.emplace_back(corner.x(), corner.y(), bottom);
    mesh.vertices.emplace_back(0, 0, top);
    const auto n = std::uint32_t(corners);
    for (std::uint32_t i = 0; i < n; ++i) mesh.triangles.push_back({i, (i + 1) % n, n});
    for (std::uint32_t i = 2; i < n; ++i) mesh.triangles.push_back({0, i, i - 1});
    return mesh;
}

hand::Mesh icosahedron()
{
    const double t = std::numbers::phi;
    hand::Mesh mesh = {{{-1, t, 0},
                        {1, t, 0},
                        {-1, -t, 0},
                        {1, -t, 0},
                        {0, -1, t},
                        {0, 1, t},
                        {0, -1, -t},
                        {0, 1, -t},
                        {t, 0, -1},
                        {t, 0, 1},
                        {-t, 0, -1},
                        {-t, 0, 1}},
                       {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                        {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                        {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}}};
    for (Vec3& vertex : mesh.vertices) vertex.normalize();
    return mesh;
}

/// Splits each triangle of a ball into four. The new corners are on the ball, too.
hand::Mesh subdivided(const hand::Mesh& ball)
{
    hand::Mesh out = {ball.vertices, {}};
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
        const auto [found, is_new] = middles.try_emplace(std::minmax(a, b), std::uint32_t(out.vertices.size()));
        if (is_new) out.vertices.push_back((ball.vertices[a] + ball.vertices[b]).normalized());
        return found->second;
    };
    for (const auto& [a, b, c] : ball.triangles) {
        const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
        out.triangles.insert(out.triangles.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
    }
    return out;
}

/// Returns an uneven ball of 80 triangles, or of 320 if `fine`.
hand::Mesh rough_ball(Random& random, bool fine, const Vec3& radii, const Vec3& centre)
{
    static const hand::Mesh coarse_ball = subdivided(icosahedron()), fine_ball = subdivided(coarse_ball);
    hand::Mesh mesh = fine ? fine_ball : coarse_ball;
    for (Vec3& vertex : mesh.vertices) vertex = centre + random.between(0.8, 1.1) * vertex.cwiseProduct(radii);
    return mesh;
}

struct Gable {
    double length, width, walls, ridge;  ///< m; walls and ridge are heights above the ground
};

void add_gabled_house(const Gable& size, double foundation, const Pose& pose, Pieces& out)
{
    const double half = size.width / 2, pitch = (size.ridge - size.walls) / half;
    const std::vector<Vec2> walls = {
        {-half, -foundation}, {half, -foundation}, {half, size.walls}, {0, size.ridge}, {-half, size.walls}};
    const double eave = half + 0.5, inner = size.ridge - 0.05, outer = size.ridge + 0.2;
    const std::vector<Vec2> roof = {{0, inner}, {eave, inner - pitch * eave},  {eave, outer - pitch * eave},
                                    {0, outer}, {-eave, outer - pitch * eave}, {-eave, inner - pitch * eave}};
    out.push_back(hand::moved(profile_along_x(walls, size.length), pose));
    out.push_back(hand::moved(profile_along_x(roof, size.length + 0.8), pose));
}

void add_conifer(Random& random, Pieces& out)
{
    const double height = random.between(5, 14), bare = random.between(0.6, 2), radius = 0.2 * height;
    out.push_back(hand::extruded(circle(6, 0.02 * height), -0.6, bare + 0.5));
    for (int tier = 0; tier < 3; ++tier) {
        const double bottom = bare + tier * 0.25 * (height - bare);
        out.push_back(cone(10, radius * (1 - 0.25 * tier), bottom, bottom + 0.5 * (height - bare)));
    }
}

void add_leaf_tree(Random& random, Pieces& out)
{
    const double height = random.between(4, 11), bare = random.between(1, 2.5),
                 width = random.between(0.25, 0.4) * height;
    out.push_back(hand::extruded(circle(8, 0.03 * height), -0.6, (bare + height) / 2));
    out.push_back(rough_ball(random, false, {width, width, (height - bare) / 2}, {0, 0, (bare + height) / 2}));
}

}  // namespace

hand::Mesh ball()
{
    static const hand::Mesh made = subdivided(icosahedron());
    return made;
}

hand::Mesh blocks(const BlockGrid& grid)
{
    const int nx = int(grid.x.size()) - 1, ny = int(grid.y.size()) - 1, nz = int(grid.z.size()) - 1;
    const auto filled = [&](int i, int j, int k) {
        return i >= 0 && j >= 0 && k >= 0 && i < nx && j < ny && k < nz && grid.filled(i, j, k);
    };
    hand::Mesh mesh;
    std::map<std::array<int, 3>, std::uint32_t> corners;
    const auto corner = [&](const std::array<int, 3>& at) {
        const auto [found, is_new] = corners.try_emplace(at, std::uint32_t(mesh.vertices.size()));
        if (is_new)
            mesh.vertices.emplace_back(grid.x[std::size_t(at[0])], grid.y[std::size_t(at[1])],
                                       grid.z[std::size_t(at[2])]);
        return found->second;
    };
    // Adds the side of a block towards -axis (side 0) or +axis (side 1).
    const auto add_side = [&](const std::array<int, 3>& block, int axis, int side) {
        std::array<std::array<int, 3>, 4> at;
        at.fill(block);
        const std::size_t a = std::size_t(axis), u = (a + 1) % 3, v = (a + 2) % 3;
        for (std::array<int, 3>& c : at) c[a] += side;
        for (const std::size_t i : {1, 2}) at[i][u] += 1;
        for (const std::size_t i : {2, 3}) at[i][v] += 1;
        if (side == 0) std::swap(at[1], at[3]);
        const std::uint32_t first = corner(at[0]), third = corner(at[2]);
        mesh.triangles.push_back({first, corner(at[1]), third});
        mesh.triangles.push_back({first, third, corner(at[3])});
    };
    for (int k = 0; k < nz; ++k)
        for (int j = 0; j < ny; ++j)
            for (int i = 0; i < nx; ++i) {
                if (!filled(i, j, k)) continue;
                for (int axis = 0; axis < 3; ++axis)
                    for (const int side : {0, 1}) {
                        const int step = 2 * side - 1;
                        if (!filled(i + (axis == 0) * step, j + (axis == 1) * step, k + (axis == 2) * step))
                            add_side({i, j, k}, axis, side);
                    }
            }
    return mesh;
}

Pieces house(Random& random, double foundation)
{
    Pieces out;
    const double length = random.between(8, 13), width = random.between(6, 8.5), walls = random.between(2.6, 5.4);
    const double ridge = walls + width / 2 * random.between(0.6, 1.1);
    add_gabled_house({length, width, walls, ridge}, foundation, {}, out);
    const double chimney = random.between(-0.3, 0.3) * length;
    out.push_back(box({0.6, 0.6, ridge - walls + 0.8}, {chimney, 0.8, (walls + ridge + 0.8) / 2}));
    if (random.chance(0.5)) {
        const double side = random.chance(0.5) ? 1 : -1;
        const Pose pose = {{0.2 * length, side * width / 2, 0}, turned(std::numbers::pi / 2, Vec3::UnitZ())};
        add_gabled_house({6, 0.4 * length, 0.8 * walls, 0.8 * walls + 0.16 * length}, foundation, pose, out);
    }
    return out;
}

std::vector<double> window_borders(double length, int windows, double half_width)
{
    std::vector<double> out = {-length / 2};
    for (int i = 0; i < windows; ++i) {
        const double middle = -length / 2 + (i + 0.5) * length / windows;
        out.insert(out.end(), {middle - half_width, middle + half_width});
    }
    out.push_back(length / 2);
    return out;
}

hand::Mesh recessed_house(Random& random, const RecessedHouse& plan)
{
    const double length = random.between(10, 14), depth = random.between(8, 10), storey = random.between(2.7, 3.2);
    const int windows = 3, storeys = plan.least_storeys + random.below(plan.most_storeys - plan.least_storeys + 1);
    const int door = random.below(windows);
    BlockGrid grid;
    grid.x = window_borders(length, windows, 0.6);
    const double recess = random.between(0.15, 1.2);
    grid.y = {-depth / 2, -depth / 2 + recess, depth / 2 - 0.2, depth / 2};
    grid.z = {-plan.foundation};
    for (int i = 0; i < storeys; ++i)
        grid.z.insert(grid.z.end(), {i * storey + (i == 0 ? 0.1 : 0), i * storey + 0.9, i * storey + 2.2});
    grid.z.push_back(storeys * storey);
    const bool set_back = random.chance(0.4);
    grid.filled = [=, top = 3 * storeys](int i, int j, int k) {
        const bool opening = i % 2 == 1, front = j == 0, back = j == 2, window = k % 3 == 2, sill = k == 1;
        if (set_back && storeys > 1 && k > top - 3 && i < 2) return false;
        if (!opening || !(front || back)) return true;
        return !(window || (sill && front && i / 2 == door));
    };
    return blocks(grid);
}

Pieces tree(Random& random)
{
    Pieces out;
    if (random.chance(0.5))
        add_conifer(random, out);
    else
        add_leaf_tree(random, out);
    return out;
}

Pieces car(Random& random)
{
    const double scale = random.between(0.9, 1.15);
    const std::vector<Vec2> side = {{-2.1, 0.3}, {2.1, 0.3},  {2.1, 0.75},  {1.1, 0.9},
                                    {0.5, 1.4},  {-1.0, 1.4}, {-1.7, 0.95}, {-2.1, 0.9}};
    const Mat3 upright = turned(std::numbers::pi / 2, Vec3::UnitX());
    Pieces out = {hand::moved(hand::extruded(side, -0.85, 0.85), {Vec3::Zero(), upright})};
    for (const double x : {-1.3, 1.3})
        for (const double y : {-0.8, 0.8})
            out.push_back(hand::moved(hand::extruded(circle(8, 0.32), -0.1, 0.1), {{x, y, 0.32}, upright}));
    for (hand::Mesh& mesh : out)
        for (Vec3& vertex : mesh.vertices) vertex *= scale;
    return out;
}

Pieces rock(Random& random)
{
    const bool boulder = random.chance(0.1);
    const double size = boulder ? random.between(1.2, 3) : random.between(0.15, 1);
    const double length = size * random.between(0.8, 1.4), width = size * random.between(0.7, 1),
                 height = size * random.between(0.5, 0.9);
    return {rough_ball(random, boulder, {length, width, height}, {0, 0, 0.2 * height})};
}

Pieces fence_panel(Random& random, const Vec3& from, const Vec3& to)
{
    const Vec3 along = to - from;
    const double yaw = std::atan2(along.y(), along.x()), pitch = -std::asin(along.z() / along.norm());
    const Mat3 rotation = rotation_from_rpy(0, pitch, yaw);
    const double thickness = random.between(0.02, 0.04);
    Pieces out = {hand::moved(hand::box({0.05, 0.05, 1.6}), {from + Vec3(0, 0, 0.4), rotation_from_rpy(0, 0, yaw)})};
    for (const double height : {0.45, 0.95}) {
        const Pose pose = {(from + to) / 2 + Vec3(0, 0, height), rotation};
        out.push_back(hand::moved(hand::box({along.norm(), thickness, 0.12}), pose));
    }
    return out;
}

void add_thing(Scene& scene, const char* name, Label label, const Pieces& pieces, const Pose& pose)
{
    hand::add_mesh(scene, label, hand::moved(pieces.front(), pose));
    for (std::size_t i = 1; i < pieces.size(); ++i) hand::add_piece(scene, hand::moved(pieces[i], pose));
    scene.parts.back().name = name + ("-" + std::to_string(scene.parts.size() - 1));
}

}  // namespace worlds
