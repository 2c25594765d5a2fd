#include "compounds.h"

#include <algorithm>
#include <cmath>
#include <numbers>

using namespace spawnfield;

namespace worlds {
namespace {

constexpr double pi = std::numbers::pi;

Element box(const std::string& name, const Vec3& size, const Vec3& centre, const Mat3& rotation = Mat3::Identity())
{
    return {name, {.kind = ShapeKind::Box, .size = size, .pose = {centre, rotation}}};
}

/// Returns a box that stands on the ground and reaches `sunk` into it.
Element block(const std::string& name, const Vec3& size, double x, double y)
{
    return box(name, {size.x(), size.y(), size.z() + sunk}, {x, y, (size.z() - sunk) / 2});
}

/// Returns a capsule along the z axis of `rotation`, `length` m from end to end.
Element capsule(const std::string& name, double radius, double length, const Vec3& centre,
                const Mat3& rotation = Mat3::Identity())
{
    return {name, {.kind = ShapeKind::Capsule, .size = {radius, length - 2 * radius, 0}, .pose = {centre, rotation}}};
}

Element upright_capsule(const std::string& name, double radius, double bottom, double top, double x = 0, double y = 0)
{
    return capsule(name, radius, top - bottom, {x, y, (bottom + top) / 2});
}

/// Adds two slabs over the walls, and an attic that fills the space between them.
void add_roof(const HouseSize& size, double pitch, double x, Compound& out)
{
    constexpr double thickness = 0.25, overhang = 0.5;  // m
    const double half = size.width / 2, ridge = half * std::tan(pitch), slope = (half + overhang) / std::cos(pitch);
    out.push_back(box("attic", {size.length - 0.1, size.width * 0.5, ridge / 2}, {x, 0, size.walls + ridge / 4}));
    for (const double side : {-1.0, 1.0}) {
        const double y = side * (half + overhang) / 2;
        const Vec3 centre(x, y, size.walls + ridge - std::abs(y) * std::tan(pitch) + thickness / 2);
        const char* name = side < 0 ? "roof-right" : "roof-left";
        out.push_back(
            box(name, {size.length + 2 * overhang, slope, thickness}, centre, rotation_from_rpy(-side * pitch, 0, 0)));
    }
}

}  // namespace

Compound house_of_boxes(Random& random, const HouseSize& size)
{
    Compound out = {block("wall", {size.length, size.width, size.walls}, 0, 0)};
    const double pitch = random.between(0.5, 0.75), ridge = size.walls + size.width / 2 * std::tan(pitch);
    add_roof(size, pitch, 0, out);
    const double x = random.between(-0.3, 0.3) * size.length;
    out.push_back(box("chimney", {0.7, 0.7, ridge - size.walls + 0.9}, {x, 0.8, (size.walls + ridge + 0.9) / 2}));
    if (random.chance(0.4)) out.push_back(block("porch", {2.4, 1.8, 2.6}, 0.2 * size.length, -size.width / 2 - 0.7));
    if (random.chance(0.3)) out.push_back(block("shed", {3.2, 4.5, 2.4}, size.length / 2 + 1.5, 0.6));
    return out;
}

Compound church_of_boxes()
{
    const HouseSize nave = {20, 10, 7};
    Compound out = {block("nave", {nave.length, nave.width, nave.walls}, 0, 0)};
    add_roof(nave, 0.85, 0, out);
    out.push_back(block("tower", {6, 6, 19}, -12.5, 0));
    out.push_back(box("belfry", {4.6, 4.6, 4}, {-12.5, 0, 21}));
    out.push_back(upright_capsule("spire", 0.5, 22, 28, -12.5));
    out.push_back(block("choir", {5, 7, 6}, 12, 0));
    return out;
}

Compound broad_tree(Random& random)
{
    const double radius = random.between(1.5, 2.8), clear = random.between(2.0, 2.9),
                 thick = random.between(0.16, 0.34);
    const double height = clear + 2 * radius + random.between(0.1, 2.5);
    return {upright_capsule("trunk", thick, -sunk, clear + radius), upright_capsule("crown", radius, clear, height)};
}

Compound conifer(Random& random)
{
    const double radius = random.between(0.7, 1.2), bottom = random.between(0.1, 0.7), height = random.between(6, 12);
    return {upright_capsule("trunk", random.between(0.14, 0.24), -sunk, bottom + radius),
            upright_capsule("crown", radius, bottom, height)};
}

Compound bush(Random& random)
{
    const double radius = random.between(0.4, 0.75);
    return {upright_capsule("leaves", radius, -sunk, 1.1 + radius)};
}

Compound boulder(Random& random)
{
    const double size = random.between(1.1, 2.4);
    Compound out = {block("large", {size, size * random.between(0.7, 1), random.between(1.1, 1.9)}, 0, 0)};
    if (random.chance(0.4)) out.push_back(block("small", {0.5 * size, 0.6 * size, 1.05}, 0.6 * size, 0.1 * size));
    return out;
}

Compound fountain()
{
    constexpr int sides = 12;
    constexpr double radius = 4.3, rim = 0.4, height = 0.6;  // m
    const double length = 2 * (radius + rim / 2) * std::tan(pi / sides);
    Compound out;
    for (int i = 0; i < sides; ++i) {
        const double turn = 2 * pi * i / sides;
        const Vec3 centre(radius * std::cos(turn), radius * std::sin(turn), (height - sunk) / 2);
        out.push_back(
            box("rim-" + std::to_string(i), {rim, length, height + sunk}, centre, rotation_from_rpy(0, 0, turn)));
    }
    out.push_back(block("plinth", {1.4, 1.4, 1.1}, 0, 0));
    out.push_back(upright_capsule("column", 0.35, 0, 3.4));
    out.push_back(box("bowl", {2.2, 2.2, 0.25}, {0, 0, 2.2}));
    return out;
}

Compound bench()
{
    const Mat3 leaning = rotation_from_rpy(-0.15, 0, 0);
    return {block("leg-left", {0.1, 0.4, 0.42}, -0.75, 0), block("leg-right", {0.1, 0.4, 0.42}, 0.75, 0),
            box("seat", {1.8, 0.45, 0.06}, {0, 0, 0.45}), box("back", {1.8, 0.05, 0.7}, {0, 0.26, 0.78}, leaning)};
}

Compound street_lamp()
{
    const Mat3 lying = rotation_from_rpy(0, pi / 2, 0);
    return {upright_capsule("pole", 0.09, -sunk, 5), capsule("arm", 0.05, 1.3, {0.6, 0, 4.9}, lying),
            box("light", {0.5, 0.25, 0.15}, {1.2, 0, 4.85})};
}

Compound car_of_boxes(Random& random)
{
    const double length = random.between(3.8, 4.6);
    Compound out = {box("body", {length, 1.75, 0.8}, {0, 0, 0.7}),
                    box("cabin", {0.55 * length, 1.6, 0.55}, {-0.08 * length, 0, 1.3})};
    const Mat3 across = rotation_from_rpy(pi / 2, 0, 0);
    for (const double x : {-0.32, 0.32})
        for (const double y : {-0.78, 0.78})
            out.push_back(
                capsule("wheel-" + std::to_string(out.size() - 2), 0.3, 0.7, {x * length, 0.65 * y, 0.3}, across));
    return out;
}

Compound fence(double length)
{
    constexpr double spacing = 2.5;  // m between posts
    const int panels = std::max(1, int(std::lround(length / spacing)));
    Compound out;
    for (int i = 0; i <= panels; ++i)
        out.push_back(block("post-" + std::to_string(i), {0.1, 0.1, 1.25}, length * i / panels, 0));
    for (const double z : {0.55, 1.05})
        out.push_back(box(z < 1 ? "lower-rail" : "upper-rail", {length, 0.05, 0.12}, {length / 2, 0, z}));
    return out;
}

Compound jetty(double length, double depth)
{
    constexpr double width = 2, thickness = 0.25, spacing = 4;  // m
    const double pile = depth - thickness;
    Compound out = {box("deck", {length, width, thickness}, {-length / 2, 0, -thickness / 2})};
    for (double x = 2 * spacing; x < length; x += spacing)
        for (const double y : {-0.8, 0.8})
            out.push_back(
                box("pile-" + std::to_string(out.size() - 1), {0.25, 0.25, pile}, {-x, y, -thickness - pile / 2}));
    return out;
}

Compound hut() { return {block("wall", {4, 3, 2.6}, 0, 0), box("roof", {4.4, 3.4, 0.2}, {0, 0, 2.7})}; }

Compound mast(double height) { return {upright_capsule("pole", 0.25, 0, height)}; }

Compound border_stone() { return {block("stone", {0.1, 0.1, 1.2}, 0, 0)}; }

}  // namespace worlds
