#include "hard_scene.h"

#include "slow.h"
#include "worlds/hand_scene.h"

#include <algorithm>
#include <cmath>

using namespace spawnfield;

namespace {

// Function calls contain at most one draw, because C++ may evaluate arguments and operands in any order. Braced lists
// are evaluated from left to right.

/// A scene while it is built.
struct Site {
    Random random;
    double cell = 0.1;  ///< m; cell size of the raster
    double half = 10;   ///< m; from the middle to the border
    bool razor = true;
    std::vector<double> heights = {};  ///< m above a level floor at which robots at the offset just touch
    Scene scene = {};
};

/// Returns the scale of things: smaller worlds contain smaller things.
double scale(const Site& site) { return std::clamp(site.half / 6, 0.4, 1.2); }

/// Returns the coordinate, in about half of the calls moved to a border of cells.
double snapped(Site& site, double place)
{
    if (site.random.chance(0.5)) return place;
    return -site.half + std::round((place + site.half) / site.cell) * site.cell;
}

/// Returns a length, in about half of the calls a whole number of cells.
double length(Site& site, double low, double high)
{
    const double value = site.random.between(low, high) * scale(site);
    if (site.random.chance(0.5)) return value;
    return std::max(1.0, std::round(value / site.cell)) * site.cell;
}

double gap(Site& site)
{
    constexpr std::array gaps = {1e-9, 1e-6, 2e-6, 5e-6, 1e-5, 2e-5, 1e-4};
    if (!site.razor || site.random.chance(0.5)) return 0;
    const double size = gaps[std::size_t(site.random.below(int(gaps.size())))];
    return site.random.chance(0.5) ? size : -size;
}

/// Returns the height of a top or a ceiling above its ground.
double height(Site& site, double low, double high)
{
    if (site.random.chance(0.4)) {
        const double touching = site.heights[std::size_t(site.random.below(int(site.heights.size())))];
        return touching + gap(site);
    }
    return length(site, low, high);
}

/// Returns the top of some terrain at (x, y), mostly the lowest; 0 if there is none.
double ground(Site& site, double x, double y)
{
    const slow::Column column = slow::column(site.scene, x, y);
    std::vector<double> tops;
    for (const slow::Span& span : column.spans)
        if (span.terrain && std::isfinite(span.top)) tops.push_back(span.top);
    std::sort(tops.begin(), tops.end());
    if (tops.empty()) return 0;
    return site.random.chance(0.7) ? tops.front() : tops[std::size_t(site.random.below(int(tops.size())))];
}

/// Returns a place on the ground.
Vec3 spot(Site& site)
{
    const double reach = 0.85 * site.half;
    const double x = site.random.between(-reach, reach), y = site.random.between(-reach, reach);
    const Vec3 place = {snapped(site, x), snapped(site, y), 0};
    return {place.x(), place.y(), ground(site, place.x(), place.y())};
}

Vec3 above(Vec3 place, double lift) { return place + Vec3(0, 0, lift); }

/// Returns a place at the height `standing` above the ground, or at any height between `low` and `high`.
Vec3 lifted_spot(Site& site, double standing, double low, double high)
{
    const double lift = site.random.chance(0.5) ? standing : site.random.between(low, high);
    return above(spot(site), lift);
}

Label matter(Site& site) { return site.random.chance(0.45) ? Label::Terrain : Label::Obstacle; }

double any_yaw(Site& site)
{
    if (site.random.chance(0.5)) return M_PI / 2 * site.random.below(4);
    return site.random.between(-M_PI, M_PI);
}

Mat3 turned(Site& site) { return rotation_from_rpy(0, 0, any_yaw(site)); }

Mat3 tilted(Site& site, double limit)
{
    const double roll = site.random.between(-limit, limit), pitch = site.random.between(-limit, limit);
    return rotation_from_rpy(roll, pitch, any_yaw(site));
}

Mat3 upright_or_tilted(Site& site) { return site.random.chance(0.6) ? turned(site) : tilted(site, M_PI); }

/// Adds a box between two corners, as a primitive or a mesh.
void add_block(Site& site, Label label, const Vec3& low, const Vec3& high)
{
    const Vec3 size = high - low;
    const Pose place = {(low + high) / 2, Mat3::Identity()};
    if (site.random.chance(0.6))
        hand::add_shape(site.scene, label, {ShapeKind::Box, size, place});
    else
        hand::add_mesh(site.scene, label, hand::moved(hand::box(size), place));
}

/// Adds a level or upright rectangle without thickness.
void add_sheet(Site& site, Label label, double size_x, double size_y, const Pose& pose)
{
    hand::Mesh mesh = hand::moved(hand::rectangle(size_x, size_y), pose);
    if (site.random.chance(0.4)) mesh = hand::flipped(mesh);
    const bool sides_up = site.random.chance(0.5);
    hand::add_mesh(site.scene, label, mesh, {.kind = "plane", .sides_up = sides_up});
}

// ---- Ground ----

void add_floor(Site& site)
{
    const double side = 2 * site.half;
    if (site.random.chance(0.4)) {
        hand::add_mesh(site.scene, Label::Terrain, hand::rectangle(side, side),
                       {.kind = "plane", .sides_up = site.random.chance(0.5)});
    } else {
        const double depth = site.random.between(0.05, 1);
        hand::add_shape(site.scene, Label::Terrain,
                        {ShapeKind::Box, {side, side, depth}, {{0, 0, -depth / 2}, Mat3::Identity()}});
    }
}

/// Adds smooth hills or random noise, in some scenes with heights that are whole multiples of a cell.
void add_heightmap(Site& site)
{
    const int cells = site.random.below(2) == 0 ? 8 : 13;
    const double rise = site.random.between(0.02, 0.6) * scale(site), wave = site.random.between(0.3, 1.5);
    const bool rough = site.random.chance(0.3), whole = site.random.chance(0.5);
    Random noise{site.random.next()};
    const hand::Mesh mesh = hand::relief(cells, 2 * site.half, [&](double x, double y) {
        const double z = rough ? noise.between(-rise, rise) : rise * std::sin(wave * x + 1) * std::cos(wave * y);
        return whole ? std::round(z / site.cell) * site.cell : z;
    });
    hand::add_mesh(site.scene, Label::Terrain, mesh, {.kind = "heightmap", .sides_up = site.random.chance(0.4)});
}

/// Adds a relief with patches of obstacle and water. Some faces have the opposite winding.
void add_patchwork(Site& site)
{
    const double rise = site.random.between(0, 0.4);
    hand::Mesh mesh = hand::relief(
        9, 2 * site.half, [&](double x, double y) { return rise * std::sin(0.8 * x) * std::sin(0.7 * y + 1); });
    hand::MeshOptions options = {.sides_up = site.random.chance(0.5)};
    for (Triangle& t : mesh.triangles) {
        options.labels.push_back(site.random.chance(0.85)  ? Label::Terrain
                                 : site.random.chance(0.7) ? Label::Obstacle
                                                           : Label::Water);
        if (site.random.chance(0.1)) std::swap(t[1], t[2]);
    }
    hand::add_mesh(site.scene, Label::Terrain, mesh, options);
}

/// Adds slabs of different heights next to each other, with borders on borders of cells.
void add_terraces(Site& site)
{
    const int tiles = 2 + site.random.below(3);
    const double side = 2 * site.half / tiles;
    for (int i = 0; i < tiles * tiles; ++i) {
        if (site.random.chance(0.1)) continue;  // a pit
        const double top = site.random.chance(0.4) ? 0 : height(site, 0, 0.4);
        const Vec3 low = {-site.half + side * (i % tiles), -site.half + side * (i / tiles), -0.5};
        add_block(site, site.random.chance(0.9) ? Label::Terrain : Label::Obstacle, low,
                  {low.x() + side, low.y() + side, top});
    }
}

void add_leaf(Site& site, const Vec3& low, double side)
{
    const auto part = std::uint32_t(site.scene.parts.size() - 1);
    const Pose place = {low + Vec3::Constant(side / 2), Mat3::Identity()};
    site.scene.primitives.push_back(
        {{ShapeKind::Box, Vec3::Constant(side), place}, part, site.scene.parts.back().label});
    ++site.scene.parts.back().solid_pieces;
}

void begin_octomap(Site& site, Label label)
{
    Part part;
    part.kind = "octomap";
    part.label = label;
    site.scene.parts.push_back(part);
}

void add_leaf_ground(Site& site)
{
    begin_octomap(site, Label::Terrain);
    const int tiles = 12;
    const double side = 2 * site.half / tiles;
    for (int i = 0; i < tiles * tiles; ++i) {
        const double step = site.random.chance(0.2) ? side / 8 * site.random.below(4) : 0;
        add_leaf(site, {-site.half + side * (i % tiles), -site.half + side * (i / tiles), step - side}, side);
    }
}

// ---- Things ----

void add_solid(Site& site)
{
    const double radius = length(site, 0.05, 0.6), tall = length(site, 0.1, 1.5);
    const Vec3 place = lifted_spot(site, tall / 2, -0.3, 1.2);
    const Mat3 rotation = upright_or_tilted(site);
    const Label label = matter(site);
    switch (site.random.below(4)) {
    case 0:
        hand::add_shape(site.scene, label,
                        {ShapeKind::Box, {2 * radius, length(site, 0.1, 1.5), tall}, {place, rotation}});
        break;
    case 1: hand::add_shape(site.scene, label, {ShapeKind::Sphere, {radius, 0, 0}, {place, Mat3::Identity()}}); break;
    case 2: hand::add_shape(site.scene, label, {ShapeKind::Cylinder, {radius, tall, 0}, {place, rotation}}); break;
    default: hand::add_shape(site.scene, label, {ShapeKind::Capsule, {radius, tall, 0}, {place, rotation}});
    }
}

void add_wall(Site& site)
{
    const Vec3 low = spot(site);
    const double along = length(site, 0.5, 4), tall = height(site, 0.2, 2);
    if (site.random.chance(0.3)) {
        const Pose place = {above(low, tall / 2), site.random.chance(0.7) ? turned(site) : tilted(site, 0.5)};
        hand::add_mesh(site.scene, Label::Obstacle, hand::moved(hand::box({along, 0.02, std::abs(tall) + 0.1}), place));
        return;
    }
    const bool over_x = site.random.chance(0.5);  // the face is mostly on a border of cells
    const Vec3 size = {over_x ? along : 0.02, over_x ? 0.02 : along, std::max(tall, 0.02)};
    add_block(site, Label::Obstacle, low, low + size);
}

void add_pole(Site& site)
{
    const double tall = length(site, 0.4, 3);
    const Mat3 rotation = site.random.chance(0.7) ? turned(site) : tilted(site, 0.6);
    const Pose place = {lifted_spot(site, tall / 2, tall / 2, tall), rotation};
    const Label label = matter(site);
    switch (site.random.below(3)) {
    case 0: hand::add_mesh(site.scene, label, hand::moved(hand::box({0.05, 0.05, tall}), place)); break;
    case 1: hand::add_shape(site.scene, label, {ShapeKind::Capsule, {0.025, tall, 0}, place}); break;
    default: hand::add_shape(site.scene, label, {ShapeKind::Cylinder, {0.025, tall, 0}, place});
    }
}

void add_kerb(Site& site)
{
    const Vec3 low = spot(site);
    const bool over_x = site.random.chance(0.5);
    const double wide = length(site, 0.05, 0.3), along = length(site, 1, 5),
                 tall = std::max(0.002, std::abs(height(site, 0.02, 0.15)));
    const Label label = matter(site);
    add_block(site, label, low, low + Vec3(over_x ? along : wide, over_x ? wide : along, tall));
}

void add_stairs(Site& site)
{
    const int steps = 2 + site.random.below(5);
    const Vec3 low = spot(site);
    const double run = length(site, 0.1, 0.4), rise = length(site, 0.03, 0.2), wide = length(site, 0.5, 2);
    for (int i = 0; i < steps; ++i)
        add_block(site, Label::Terrain, low + Vec3(run * i, 0, 0), low + Vec3(run * (i + 1), wide, rise * (i + 1)));
}

/// Adds a tilted plate or a wedge.
void add_ramp(Site& site)
{
    const double along = length(site, 1, 4), wide = length(site, 0.5, 2), slope = site.random.between(0.05, 0.9);
    const Vec3 place = spot(site);
    if (site.random.chance(0.5)) {
        const Mat3 rotation = rotation_from_rpy(0, -slope, any_yaw(site));
        hand::add_shape(site.scene, Label::Terrain, {ShapeKind::Box, {along, wide, 0.1}, {place, rotation}});
    } else {
        const hand::Mesh wedge = hand::extruded({{0, 0}, {along, 0}, {along, along * slope}}, -wide / 2, wide / 2);
        hand::add_mesh(site.scene, Label::Terrain,
                       hand::moved(wedge, {place, rotation_from_rpy(M_PI / 2, 0, any_yaw(site))}));
    }
}

void add_storey(Site& site)
{
    const Label label = site.random.chance(0.75) ? Label::Terrain : Label::Obstacle;
    const double size_x = length(site, 1, 6), size_y = length(site, 1, 6), clear = height(site, 0.3, 2.5);
    const Vec3 place = above(spot(site), clear);
    if (site.random.chance(0.5)) {
        const Mat3 rotation = site.random.chance(0.6) ? Mat3(Mat3::Identity()) : tilted(site, 0.2);
        add_sheet(site, label, size_x, size_y, {place, rotation});
    } else {  // the lower side is at the height
        const double thickness = site.random.between(0.02, 0.3);
        add_block(site, label, place - Vec3(size_x / 2, size_y / 2, 0),
                  place + Vec3(size_x / 2, size_y / 2, thickness));
    }
}

/// Adds a deck on two piers, with a ramp up to it.
void add_bridge(Site& site)
{
    const Vec3 low = spot(site);
    const double along = length(site, 1.5, 5), wide = length(site, 0.5, 1.5),
                 deck = std::max(0.1, height(site, 0.4, 1.6)), thick = 0.1;
    const double pier = length(site, 0.1, 0.3);
    add_block(site, Label::Terrain, low + Vec3(0, 0, deck), low + Vec3(along, wide, deck + thick));
    const Label label = matter(site);
    add_block(site, label, low, low + Vec3(pier, wide, deck));
    add_block(site, label, low + Vec3(along - pier, 0, 0), low + Vec3(along, wide, deck));
    const hand::Mesh wedge = hand::extruded({{0, 0}, {2 * deck, 0}, {2 * deck, deck + thick}}, -wide, 0);
    const Pose place = {low - Vec3(2 * deck, 0, 0), rotation_from_rpy(M_PI / 2, 0, 0)};
    hand::add_mesh(site.scene, Label::Terrain, hand::moved(wedge, place));
}

/// Adds two walls and a roof that may be terrain, or a box of sheets without its ends.
void add_tunnel(Site& site)
{
    const Vec3 low = spot(site);
    const double along = length(site, 1, 4), wide = length(site, 0.6, 2), clear = std::max(0.1, height(site, 0.4, 1.5));
    if (site.random.chance(0.4)) {
        const hand::Mesh box = hand::box({along, wide, 2 * clear});
        const hand::Mesh tube = hand::without(hand::without(box, 6, 2), 2, 2);  // sides -x, then x
        const Label label = matter(site);
        hand::add_mesh(site.scene, label, hand::moved(tube, {low, turned(site)}));
        return;
    }
    const double thick = length(site, 0.05, 0.3);
    const Label walls = matter(site), roof = matter(site);
    add_block(site, walls, low, low + Vec3(along, thick, clear));
    add_block(site, walls, low + Vec3(0, thick + wide, 0), low + Vec3(along, 2 * thick + wide, clear));
    add_block(site, roof, low + Vec3(0, 0, clear), low + Vec3(along, 2 * thick + wide, clear + thick));
}

/// Adds an upside-down L, or a leaning block.
void add_overhang(Site& site)
{
    const double wide = length(site, 0.6, 2), thick = length(site, 0.1, 0.4), depth = length(site, 0.3, 1.5);
    const hand::Mesh shape = hand::extruded(
        {{thick, thick}, {thick, wide}, {0, wide}, {0, 0}, {wide, 0}, {wide, thick}}, 0, depth);
    const Mat3 head_down = rotation_from_rpy(-M_PI / 2, 0, any_yaw(site));
    const Pose place = {above(spot(site), wide), site.random.chance(0.7) ? head_down : tilted(site, M_PI)};
    hand::add_mesh(site.scene, matter(site), hand::moved(shape, place));
}

void add_table(Site& site)
{
    const double size_x = length(site, 0.4, 1.5), size_y = length(site, 0.4, 1.5),
                 tall = std::max(0.1, height(site, 0.3, 0.8)), leg = 0.04;
    const Vec3 low = spot(site);
    const Label label = matter(site);
    add_block(site, label, low + Vec3(0, 0, tall), low + Vec3(size_x, size_y, tall + 0.03));
    for (int i = 0; i < 4; ++i) {
        const Vec3 foot = low + Vec3(i % 2 * (size_x - leg), i / 2 * (size_y - leg), 0);
        add_block(site, label, foot, foot + Vec3(leg, leg, tall));
    }
}

/// Adds a surface or a body of water, often level with the ground.
void add_water(Site& site)
{
    const double size_x = length(site, 0.5, 4), size_y = length(site, 0.5, 4);
    const Vec3 place = lifted_spot(site, gap(site), -0.3, 0.5);
    switch (site.random.below(4)) {
    case 0: add_sheet(site, Label::Water, size_x, size_y, {place, tilted(site, 0.1)}); break;
    case 1:
        hand::add_shape(site.scene, Label::Water, {ShapeKind::Sphere, {size_x / 2, 0, 0}, {place, Mat3::Identity()}});
        break;
    case 2: add_sheet(site, Label::Water, size_x, size_y, {place, Mat3::Identity()}); break;
    default: add_block(site, Label::Water, place - Vec3(0, 0, 0.2), place + Vec3(size_x, size_y, 0));
    }
}

/// Adds octree leaves of two sizes on a lattice.
void add_voxels(Site& site)
{
    begin_octomap(site, matter(site));
    const double side = site.random.chance(0.5) ? site.cell : 0.06 * scale(site);
    const Vec3 low = spot(site);
    const int count = 10 + site.random.below(50);
    for (int i = 0; i < count; ++i) {
        const Vec3 step = {double(site.random.below(8)), double(site.random.below(8)), double(site.random.below(8))};
        add_leaf(site, low + 2 * side * step, site.random.chance(0.3) ? 2 * side : side);
    }
}

std::vector<Vec3> points_around(Random& random, int count, double radius)
{
    std::vector<Vec3> points;
    for (int i = 0; i < count; ++i) {
        const double roll = random.between(-M_PI, M_PI), pitch = random.between(-M_PI / 2, M_PI / 2);
        const double stretch = random.between(0.7, 1.1);
        points.push_back(stretch * radius * rotation_from_rpy(roll, pitch, random.between(-M_PI, M_PI)).col(0));
    }
    return points;
}

/// Adds a closed, nearly convex mesh, which is mostly filled. Its winding varies.
void add_rock(Site& site)
{
    const double radius = length(site, 0.1, 0.9);
    hand::Mesh mesh = hand::convex_hull(points_around(site.random, 6 + site.random.below(8), radius));
    if (site.random.chance(0.3)) mesh = hand::flipped(mesh);
    const Vec3 place = lifted_spot(site, 0, -radius, 1);
    const bool fill = site.random.chance(0.8);
    hand::add_mesh(site.scene, matter(site), hand::moved(mesh, {place, Mat3::Identity()}), {.fill = fill});
}

/// Adds a closed piece with another closed piece or a sheet inside it. This makes no cavity.
void add_nested(Site& site)
{
    const double size_x = length(site, 0.6, 2), size_y = length(site, 0.6, 2), size_z = length(site, 0.6, 2);
    const Vec3 size = {size_x, size_y, size_z};
    const Pose place = {lifted_spot(site, size_z / 2, 0, 1), upright_or_tilted(site)};
    hand::add_mesh(site.scene, matter(site), hand::moved(hand::box(size), place));
    hand::Mesh inner = hand::box(0.7 * size);
    if (site.random.chance(0.3)) inner = hand::without(inner, 0, 2);
    hand::add_piece(site.scene, hand::moved(hand::flipped(inner), place));
}

/// Fills the last piece although it has holes, as `solid: true` in a scene file does.
void fill_last_piece(Scene& scene)
{
    scene.pieces.back().solid = scene.pieces.back().open = true;
    --scene.parts.back().sheet_pieces;
    ++scene.parts.back().solid_pieces;
}

/// Adds walls, floor and roof without thickness. The inside is free, or filled in spite of the hole.
void add_house(Site& site)
{
    const double size_x = length(site, 0.8, 3), size_y = length(site, 0.8, 3), size_z = length(site, 0.6, 2);
    const hand::Mesh mesh = hand::without(hand::box({size_x, size_y, size_z}), 2 * std::size_t(site.random.below(6)),
                                          2);
    const Vec3 centre = lifted_spot(site, size_z / 2, size_z / 2 - 0.1, size_z / 2 + 0.3);
    const Pose place = {centre, site.random.chance(0.7) ? turned(site) : tilted(site, 0.4)};
    hand::add_mesh(site.scene, matter(site), hand::moved(mesh, place));
    if (site.random.chance(0.2)) fill_last_piece(site.scene);
}

/// Adds long thin triangles across the scene.
void add_sliver(Site& site)
{
    const double lift = height(site, 0.1, 1.5), roll = site.random.between(-0.5, 0.5),
                 pitch = site.random.between(-0.1, 0.1);
    const double width = site.random.chance(0.5) ? 0.01 : site.cell / 3;
    const Pose place = {above(spot(site), lift), rotation_from_rpy(roll, pitch, any_yaw(site))};
    hand::Mesh mesh = {
        {{-site.half / 2, 0, 0}, {site.half / 2, 0, 0}, {site.half / 2, width, 0}, {-site.half / 2, -width, 0}},
        {{0, 1, 2}, {0, 3, 1}}};
    hand::add_mesh(site.scene, matter(site), hand::moved(mesh, place));
}

/// Adds a thin pyramid inside one cell, standing or hanging.
void add_spike(Site& site)
{
    const double side = std::min(0.03, site.cell / 2), tall = length(site, 0.1, 1.2);
    const bool hangs = site.random.chance(0.4);
    const hand::Mesh mesh = {{{-side, -side, 0}, {side, -side, 0}, {0, side, 0}, {0, 0, hangs ? -tall : tall}},
                             {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
    const double shift = site.random.between(0.1, 0.9) * site.cell,
                 lift = hangs ? tall + std::abs(height(site, 0.1, 1)) : 0;
    const Pose place = {spot(site) + Vec3(shift, shift / 2, lift), Mat3::Identity()};
    hand::add_mesh(site.scene, matter(site), hand::moved(mesh, place));
}

void add_cable(Site& site)
{
    const double lift = height(site, 0.05, 1.5), radius = 0.005,
                 sag = site.random.chance(0.5) ? 0 : site.random.between(-0.2, 0.2);
    const Mat3 rotation = rotation_from_rpy(0, M_PI / 2 + sag, any_yaw(site));
    const Pose place = {above(spot(site), lift + radius), rotation};
    hand::add_shape(site.scene, Label::Obstacle, {ShapeKind::Capsule, {radius, site.half, 0}, place});
}

/// Adds a vertical sheet, which no vertical ray meets.
void add_fence(Site& site)
{
    const double along = length(site, 0.5, 4), tall = length(site, 0.2, 1.5),
                 foot = site.random.chance(0.6) ? 0.0 : height(site, 0.1, 1);
    const Pose upright = {above(spot(site), tall / 2 + foot), rotation_from_rpy(M_PI / 2, 0, any_yaw(site))};
    hand::add_mesh(site.scene, matter(site), hand::moved(hand::rectangle(along, tall), upright));
}

/// Adds terrain and something else with the same top, or one closely above the other.
void add_twins(Site& site)
{
    const Vec3 low = spot(site);
    const double size_x = length(site, 0.5, 2), size_y = length(site, 0.5, 2),
                 tall = std::max(0.02, height(site, 0.1, 0.5));
    add_block(site, Label::Terrain, above(low, -0.1), low + Vec3(size_x, size_y, tall));
    const Vec3 shift = {size_x / 2, 0, gap(site)};
    if (site.random.chance(0.5))
        add_block(site, Label::Obstacle, low + shift, low + shift + Vec3(size_x, size_y, tall));
    else
        add_sheet(site, matter(site), size_x, size_y, {above(low + shift, tall), Mat3::Identity()});
}

/// Adds a ceiling at the top of the robot, or slightly above or below it.
void add_ceiling(Site& site)
{
    const double top = *std::max_element(site.heights.begin(), site.heights.end()) + gap(site);
    const double size_x = length(site, 0.5, 3), size_y = length(site, 0.5, 3);
    const Vec3 place = above(spot(site), top);
    const Label label = matter(site);
    if (site.random.chance(0.5))
        add_sheet(site, label, size_x, size_y, {place, Mat3::Identity()});
    else
        add_block(site, label, place - Vec3(size_x / 2, size_y / 2, 0), place + Vec3(size_x / 2, size_y / 2, 0.05));
}

void add_pebbles(Site& site)
{
    for (int i = 0; i < 6; ++i) {
        const Vec3 place = spot(site);
        const double side = site.random.between(0.004, 0.02);
        add_block(site, Label::Obstacle, place, place + Vec3::Constant(side));
    }
}

struct Feature {
    const char* name;
    void (*add)(Site&);
};

constexpr std::array grounds = {Feature{"floor", add_floor},         Feature{"floor", add_floor},
                                Feature{"heightmap", add_heightmap}, Feature{"patchwork", add_patchwork},
                                Feature{"terraces", add_terraces},   Feature{"leaf-ground", add_leaf_ground}};

constexpr std::array things = {
    Feature{"solid", add_solid},    Feature{"solid", add_solid},       Feature{"wall", add_wall},
    Feature{"pole", add_pole},      Feature{"kerb", add_kerb},         Feature{"stairs", add_stairs},
    Feature{"ramp", add_ramp},      Feature{"storey", add_storey},     Feature{"bridge", add_bridge},
    Feature{"tunnel", add_tunnel},  Feature{"overhang", add_overhang}, Feature{"table", add_table},
    Feature{"water", add_water},    Feature{"water", add_water},       Feature{"voxels", add_voxels},
    Feature{"rock", add_rock},      Feature{"nested", add_nested},     Feature{"house", add_house},
    Feature{"sliver", add_sliver},  Feature{"spike", add_spike},       Feature{"cable", add_cable},
    Feature{"fence", add_fence},    Feature{"twins", add_twins},       Feature{"ceiling", add_ceiling},
    Feature{"pebbles", add_pebbles}};

template <std::size_t N>
void add_one(Site& site, const std::array<Feature, N>& features)
{
    const Feature& feature = features[std::size_t(site.random.below(int(N)))];
    const std::size_t first = site.scene.parts.size();
    feature.add(site);
    for (std::size_t i = first; i < site.scene.parts.size(); ++i)
        site.scene.parts[i].name = feature.name + ("-" + std::to_string(i));
}

Scene scene_of(Site site, std::uint64_t seed)
{
    site.scene.name = "hard-" + std::to_string(seed);
    add_one(site, grounds);
    const int count = 4 + site.random.below(14);
    for (int i = 0; i < count; ++i) add_one(site, things);
    return std::move(site.scene);
}

// ---- Robots ----

RobotPart part_of(ShapeKind kind, const Vec3& size, const Vec3& centre, const Mat3& rotation = Mat3::Identity())
{
    RobotPart part;
    part.shape = {kind, size, {centre, rotation}};
    return part;
}

void move_parts(Robot& robot, const Vec3& by)
{
    for (RobotPart& part : robot.parts) {
        part.shape.pose.position += by;
        for (Vec3& vertex : part.hull_vertices) vertex += by;
    }
}

/// Adds a low body that carries something thin and tall.
void add_mast(Robot& robot, Random& random)
{
    const double tall = random.between(0.5, 2), radius = random.between(0.005, 0.03);
    const Vec3 size = {random.between(0.2, 0.8), random.between(0.2, 0.6), random.between(0.05, 0.3)};
    robot.parts.push_back(part_of(ShapeKind::Box, size, {0, 0, size.z() / 2}));
    const Vec3 foot = {random.between(-size.x(), size.x()) / 2, 0, tall / 2};
    robot.parts.push_back(part_of(ShapeKind::Cylinder, {radius, tall, 0}, foot));
    if (random.chance(0.3))
        robot.parts.push_back(part_of(ShapeKind::Sphere, {2 * radius + 0.02, 0, 0}, foot + Vec3(0, 0, tall / 2)));
}

/// Adds two legs under a beam. Many things fit between the legs.
void add_portal(Robot& robot, Random& random)
{
    const double wide = random.between(0.3, 0.8), tall = random.between(0.2, 0.9), leg = random.between(0.03, 0.1);
    for (const double side : {-wide / 2, wide / 2})
        robot.parts.push_back(part_of(ShapeKind::Box, {random.between(0.1, 0.6), leg, tall}, {0, side, tall / 2}));
    robot.parts.push_back(part_of(ShapeKind::Box, {0.1, wide, leg}, {0, 0, tall - leg / 2}));
}

void add_rod(Robot& robot, Random& random)
{
    const Vec3 size = {random.between(0.01, 0.05), random.between(0.5, 1.5), 0};
    const double roll = random.between(0.2, M_PI / 2), yaw = random.between(-M_PI, M_PI);
    robot.parts.push_back(
        part_of(ShapeKind::Capsule, size, {random.between(-0.5, 0.5), 0, 0.3}, rotation_from_rpy(roll, 0, yaw)));
}

/// Adds a box whose sides are whole cells, so that footprints end on borders of cells.
void add_whole_cells(Robot& robot, Random& random, double cell)
{
    const auto cells = [&](double up_to) { return cell * (1 + random.below(std::max(1, int(up_to / cell)))); };
    const Vec3 size = {cells(0.7), cells(0.5), cells(0.5)};
    robot.parts.push_back(part_of(ShapeKind::Box, size, {0, 0, size.z() / 2}));
}

void scale_robot(Robot& robot, double factor)
{
    for (RobotPart& part : robot.parts) {
        part.shape.size *= factor;
        part.shape.pose.position *= factor;
        for (Vec3& vertex : part.hull_vertices) vertex *= factor;
    }
}

Robot robot_of(Random& random, double cell, double factor)
{
    Robot robot;
    switch (random.below(9)) {
    case 0: add_mast(robot, random); break;
    case 1: add_portal(robot, random); break;
    case 2: add_rod(robot, random); break;
    case 3: add_whole_cells(robot, random, cell); return robot;
    case 4: robot.parts.push_back(part_of(ShapeKind::Sphere, {random.between(0.005, 0.05), 0, 0}, {0, 0, 0.02})); break;
    default: robot = random_robot(random.next());
    }
    scale_robot(robot, factor);
    if (random.chance(0.15)) {
        const double x = random.between(-1.5, 1.5), y = random.between(-1.5, 1.5);
        move_parts(robot, {x, y, random.between(0, 0.5)});
    }
    if (random.chance(0.3)) move_parts(robot, {0, 0, -robot.bounds().min.z()});  // now the robot stands on its origin
    return robot;
}

double offset_of(Random& random, const Robot& robot, double cell, bool razor)
{
    const double contact = -robot.bounds().min.z();
    switch (random.below(8)) {
    case 0: return 0;
    case 1: return std::max(0.0, contact);
    case 2: return std::max(-0.05, contact) + (razor ? random.between(0, 3e-5) : 0.001);
    case 3: return random.between(0, 1);
    case 4: return cell * random.below(std::max(2, int(0.5 / cell)));
    default: return std::max(0.0, contact) + random.between(0.005, 0.25);
    }
}

double resolution_of(Random& random)
{
    constexpr std::array usual = {0.02, 0.05, 0.1, 0.125, 0.2, 0.25, 0.5};
    if (random.chance(0.6)) return usual[std::size_t(random.below(int(usual.size())))];
    return std::exp(random.between(std::log(0.02), std::log(0.5)));
}

double max_height_of(Random& random, double offset)
{
    if (random.chance(0.3)) return std::max(0.0, offset);
    return random.between(0.2, 1.5);
}

/// Returns a shift of the scene: zero, whole metres, or anything up to a few kilometres.
Vec3 whereabouts(Random& random)
{
    if (random.chance(0.6)) return Vec3::Zero();
    const double x = random.between(-4000, 4000), y = random.between(-4000, 4000), z = random.between(-300, 300);
    if (random.chance(0.5)) return {std::round(x), std::round(y), std::round(z)};
    return {x, y, z};
}

}  // namespace

HardCase hard_case(std::uint64_t seed, const HardOptions& options)
{
    Random random{seed * 7919 + 5};
    HardCase out;
    out.seed = seed;
    out.resolution = resolution_of(random);
    const double most = std::min(10.0, 200 * out.resolution);
    const double half = out.resolution * std::ceil(random.between(2.0, most) / out.resolution);
    const double size = std::clamp(half / 5, 0.4, 1.0) * random.between(0.7, 1.1);
    out.robot = robot_of(random, out.resolution, size);
    out.robot.name = "hard-" + std::to_string(seed);
    out.offset = offset_of(random, out.robot, out.resolution, options.razor);
    out.max_height = max_height_of(random, out.offset);
    for (int i = random.below(6); i >= 0; --i)
        out.yaws.push_back(random.chance(0.3) ? M_PI / 4 * random.below(8) : random.between(-M_PI, M_PI));
    const Bounds body = out.robot.bounds();
    const double bottom = std::max(0.0, out.offset + body.min.z()), top = std::max(0.02, out.offset + body.max.z());
    Site site = {Random{random.next()}, out.resolution, half, options.razor, {bottom, top, std::max(0.0, out.offset)}};
    const Vec3 place = whereabouts(random);
    out.scene = shifted(scene_of(std::move(site), seed), place);
    if (random.chance(0.15)) out.map_bounds = {place - Vec3(half, half, 5) * 0.6, place + Vec3(half, half, 5) * 0.7};
    return out;
}

std::vector<std::string> hard_features()
{
    std::vector<std::string> names;
    for (const Feature& feature : grounds) names.push_back(feature.name);
    for (const Feature& feature : things) names.push_back(feature.name);
    std::sort(names.begin(), names.end());
    names.erase(std::unique(names.begin(), names.end()), names.end());
    return names;
}

Scene shifted(Scene scene, const Vec3& by)
{
    for (Vec3& vertex : scene.vertices) vertex += by;
    for (Piece& piece : scene.pieces) piece.bottom += by.z();
    for (Primitive& primitive : scene.primitives) primitive.shape.pose.position += by;
    return scene;
}

namespace {

const Mat3 flip = Vec3(1, -1, 1).asDiagonal();

Pose mirrored(const Pose& pose) { return {flip * pose.position, flip * pose.rotation * flip}; }

}  // namespace

Scene mirrored(Scene scene)
{
    for (Vec3& vertex : scene.vertices) vertex = flip * vertex;
    for (Triangle& t : scene.triangles) std::swap(t[1], t[2]);
    for (Primitive& primitive : scene.primitives) primitive.shape.pose = mirrored(primitive.shape.pose);
    return scene;
}

Robot mirrored(Robot robot)
{
    for (RobotPart& part : robot.parts) {
        part.shape.pose = mirrored(part.shape.pose);
        for (Vec3& vertex : part.hull_vertices) vertex = flip * vertex;
        for (auto& face : part.hull_faces) std::swap(face[1], face[2]);
    }
    for (Vec3& contact : robot.contacts) contact = flip * contact;
    return robot;
}

Robot enlarged(Robot robot, double factor)
{
    for (RobotPart& part : robot.parts) {
        const Vec3 centre = part.centre();
        part.shape.size *= factor;
        for (Vec3& vertex : part.hull_vertices) vertex = centre + factor * (vertex - centre);
    }
    return robot;
}

Scene on_binary_lattice(Scene scene)
{
    const auto rounded = [](const Vec3& place) -> Vec3 { return (place * 0x1p20).array().round().matrix() * 0x1p-20; };
    for (Vec3& vertex : scene.vertices) vertex = rounded(vertex);
    for (Primitive& primitive : scene.primitives)
        primitive.shape.pose.position = rounded(primitive.shape.pose.position);
    for (Piece& piece : scene.pieces) piece.bottom = std::round(piece.bottom * 0x1p20) * 0x1p-20;
    return scene;
}
