#include "bridge.h"
#include "complex_landmarks.h"
#include "island.h"
#include "things.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>

using namespace spawnfield;

namespace worlds {
namespace {

constexpr int house_models = 28, tower_models = 4, car_models = 6;
constexpr int wild_trees = 1500;
constexpr double highest = 80;         // m, limit for the tops of buildings
constexpr double deepest_floor = 1.5;  // m below the sea; no building, car, tree or fence stands deeper
constexpr double panel = 3;            // m, length of a fence panel
constexpr double low_fence = 0.9, high_fence = 1.6;
constexpr double lot_width = 17, lot_depth = (StreetGrid::block_v - StreetGrid::street) / 2;

/// A model and its size around its own origin, m.
struct Model {
    Pieces pieces;
    Vec2 half_size;
    double height;
};

Model model_of(Pieces pieces)
{
    Model model = {std::move(pieces), Vec2::Zero(), 0};
    for (const hand::Mesh& piece : model.pieces)
        for (const Vec3& vertex : piece.vertices) {
            model.half_size = model.half_size.cwiseMax(vertex.head<2>().cwiseAbs());
            model.height = std::max(model.height, vertex.z());
        }
    return model;
}

/// A frame in the town: its middle in the world, and its rotation as quarter turns from the direction of the streets.
struct Site {
    Vec2 middle;
    int quarters;

    double yaw() const { return StreetGrid::turn + quarters * std::numbers::pi / 2; }
    Vec2 to_world(const Vec2& local) const { return middle + Eigen::Rotation2Dd(yaw()) * local; }
};

/// Returns a pose at a place that is rounded to whole centimetres, so that equal models stay equal when they are
/// written.
Pose pose_at(const Vec2& p, double z, double yaw)
{
    const auto rounded = [](double x) { return std::round(100 * x) / 100; };
    return {{rounded(p.x()), rounded(p.y()), rounded(z)}, rotation_from_rpy(0, 0, yaw)};
}

/// Adds the houses, cars, fences and trees to the island.
class Settler {
public:
    Settler(std::uint64_t seed, Bridge bridge) : random_(seed), island_(random_), bridge_(bridge) {}

    World settle();

private:
    struct Ground {
        double low, high;  ///< m
        bool whole;        ///< the ground has no hole here
    };

    void make_models();
    Ground ground_under(const Site& site, const Vec2& half_size) const;
    bool is_on_bridge(const Vec2& p, double margin) const;

    void add_bridge_of_canal();
    void add_block(int i, int j);
    void add_row(const Site& row);
    void add_lot(const Site& lot);
    void add_towers(const Site& block);
    void add_cars_in_rows(const Site& block);
    void add_park(const Site& block);
    void add_street_cars(const Vec2& corner);
    void add_wild_trees();

    bool add_building(const Site& site, const Model& model);
    void add_car(const Site& site, double steepest);
    void add_tree(const Vec2& p);
    void add_fence(const Vec2& from, const Vec2& to, double height);
    void add_panel(const Vec2& from, const Vec2& to, double height);

    Random random_;
    const Island island_;
    const Bridge bridge_;
    World world_;
    std::vector<Model> houses_, towers_, cars_;
};

void Settler::make_models()
{
    constexpr double foundation = 3;  // m; the ground may fall by this much under a house
    for (int i = 0; i < house_models; ++i)
        houses_.push_back(model_of(i % 4 == 0 ? house(random_, foundation)
                                              : Pieces{recessed_house(random_, {.foundation = foundation})}));
    for (int i = 0; i < tower_models; ++i)
        towers_.push_back(model_of({recessed_house(random_, {foundation, 12 + 3 * i, 13 + 3 * i})}));
    for (int i = 0; i < car_models; ++i) cars_.push_back(model_of(car(random_)));
}

Settler::Ground Settler::ground_under(const Site& site, const Vec2& half_size) const
{
    Ground ground = {INFINITY, -INFINITY, true};
    for (const double u : {-1.0, -0.5, 0.0, 0.5, 1.0})
        for (const double v : {-1.0, 0.0, 1.0}) {
            const Vec2 p = site.to_world(Vec2(u, v).cwiseProduct(half_size));
            ground.low = std::min(ground.low, island_.height(p));
            ground.high = std::max(ground.high, island_.height(p));
            ground.whole = ground.whole && island_.has_ground(p);
        }
    return ground;
}

bool Settler::is_on_bridge(const Vec2& p, double margin) const
{
    const Vec2 off = (StreetGrid::from_world(p) - Vec2(Island::canal_u, Island::bridge_v)).cwiseAbs();
    return off.x() < bridge_length / 2 + margin && off.y() < bridge_half_width + margin;
}

void Settler::add_bridge_of_canal()
{
    const Vec2 middle(Island::canal_u, Island::bridge_v), half(bridge_length / 2, 0);
    const auto ground = [&](const Vec2& uv) { return island_.height(StreetGrid::to_world(uv)); };
    const BridgeSite site = {pose_at(StreetGrid::to_world(middle), 0, StreetGrid::turn), ground(middle - half),
                             ground(middle + half), ground(middle), Island::sea_level + 4};
    add_bridge(world_.scene, site, bridge_);
}

/// Adds a building with its floor at the highest ground around it. Returns false, and adds nothing, if the ground has a
/// hole or is too steep or too deep under the sea, or if the building would be too high.
bool Settler::add_building(const Site& site, const Model& model)
{
    const Ground ground = ground_under(site, model.half_size);
    if (!ground.whole || ground.high - ground.low > 2.5 || ground.low < Island::sea_level - deepest_floor) return false;
    if (ground.high + model.height > highest) return false;
    add_thing(world_.scene, "house", Label::Obstacle, model.pieces, pose_at(site.middle, ground.high, site.yaw()));
    return true;
}

void Settler::add_car(const Site& site, double steepest)
{
    const Model& model = cars_[std::size_t(random_.below(car_models))];
    const Ground ground = ground_under(site, model.half_size);
    if (!ground.whole || ground.low < Island::sea_level - deepest_floor || is_on_bridge(site.middle, 4)) return;
    if (ground.high - ground.low > steepest * 2 * model.half_size.x()) return;
    add_thing(world_.scene, "car", Label::Obstacle, model.pieces,
              pose_at(site.middle, (ground.low + ground.high) / 2 - 0.05, site.yaw()));
}

/// Adds a trunk without a crown, because a robot would pass under the crown.
void Settler::add_tree(const Vec2& p)
{
    const double radius = random_.between(0.12, 0.3), length = random_.between(4, 9);
    if (!island_.has_ground(p) || island_.height(p) < Island::sea_level - deepest_floor) return;
    const Pose pose = pose_at(p, island_.height(p) + length / 2 - 0.5, 0);
    hand::add_shape(world_.scene, Label::Obstacle,
                    {.kind = ShapeKind::Cylinder, .size = {radius, length, 0}, .pose = pose});
    world_.scene.parts.back().name = "tree-" + std::to_string(world_.scene.parts.size() - 1);
}

/// Adds a thin upright box that follows the ground and reaches a little into it. Adds nothing where the ground is
/// missing, too steep or too deep.
void Settler::add_panel(const Vec2& from, const Vec2& to, double height)
{
    constexpr double sunk = 0.3, thickness = 0.04;  // m
    const double z0 = island_.height(from), z1 = island_.height(to);
    const bool usable = island_.has_ground(from) && island_.has_ground(to) &&
                        std::min(z0, z1) > Island::sea_level - deepest_floor;
    if (!usable || std::abs(z1 - z0) > 0.4 * panel) return;
    const Vec2 along = to - from, middle = (from + to) / 2;
    const Mat3 rotation = rotation_from_rpy(0, -std::atan2(z1 - z0, along.norm()), std::atan2(along.y(), along.x()));
    const Vec3 centre(middle.x(), middle.y(), (z0 + z1) / 2 + (height - sunk) / 2);
    hand::add_shape(world_.scene, Label::Obstacle,
                    {.size = {along.norm(), thickness, height + sunk}, .pose = {centre, rotation}});
    world_.scene.parts.back().name = "fence-" + std::to_string(world_.scene.parts.size() - 1);
}

/// Adds a row of panels, with about one in ten missing.
void Settler::add_fence(const Vec2& from, const Vec2& to, double height)
{
    const int panels = std::max(1, int((to - from).norm() / panel));
    const Vec2 step = (to - from) / panels;
    for (int i = 0; i < panels; ++i)
        if (!random_.chance(0.1)) add_panel(from + i * step, from + (i + 1) * step, height);
}

/// Adds a house at the street (towards -y), and a garden with fences and a tree behind it.
void Settler::add_lot(const Site& lot)
{
    const Model& model = houses_[std::size_t(random_.below(house_models))];
    const double setback = random_.between(3, 5), shift = random_.between(-0.8, 0.8);
    const double back = lot_depth / 2, front = -back + setback + 2 * model.half_size.y();
    const Site place = {lot.to_world({shift, -back + setback + model.half_size.y()}), lot.quarters};
    if (random_.chance(0.06) || !add_building(place, model)) return;
    const double height = random_.chance(0.12) ? high_fence : low_fence;
    add_fence(lot.to_world({lot_width / 2, front}), lot.to_world({lot_width / 2, back}), height);
    add_fence(lot.to_world({-lot_width / 2, back}), lot.to_world({lot_width / 2, back}), height);
    const double x = random_.between(-6, 6), y = random_.between(front + 2, back - 1.5);
    add_tree(lot.to_world({x, y}));
}

/// Adds five lots side by side; `row` is their middle.
void Settler::add_row(const Site& row)
{
    for (int lot = -2; lot <= 2; ++lot) add_lot({row.to_world({lot * lot_width, 0}), row.quarters});
}

void Settler::add_towers(const Site& block)
{
    for (const double x : {-28.0, 0.0, 28.0}) {
        const double y = random_.between(-12, 12);
        // These are drawn before the call, because compilers may compute arguments in any order.
        const Model& model = towers_[std::size_t(random_.below(tower_models))];
        const int quarters = block.quarters + random_.below(2);
        add_building({block.to_world({x, y}), quarters}, model);
    }
    for (int i = 0; i < 14; ++i) {
        const double x = random_.between(-40, 40), y = random_.between(17, 25) * (i % 2 == 0 ? 1 : -1);
        add_tree(block.to_world({x, y}));
    }
}

/// Adds a car park with three rows of cars.
void Settler::add_cars_in_rows(const Site& block)
{
    for (const double y : {-18.0, 0.0, 18.0})
        for (double x = -38; x < 40; x += 3.2)
            if (random_.chance(0.45))
                add_car({block.to_world({x + random_.between(-0.3, 0.3), y}), block.quarters + 1}, 0.15);
}

void Settler::add_park(const Site& block)
{
    for (int i = 0; i < 45; ++i) {
        const double x = random_.between(-41, 41), y = random_.between(-25, 25);
        add_tree(block.to_world({x, y}));
    }
    const Vec2 corners[] = {{-42, -26}, {42, -26}, {42, 26}, {-42, 26}};
    for (std::size_t i = 0; i < 4; ++i) {
        const Vec2 from = corners[i], to = corners[(i + 1) % 4];
        for (const double start : {0.0, 0.55})  // a gate in the middle of each side
            add_fence(block.to_world(from + start * (to - from)), block.to_world(from + (start + 0.45) * (to - from)),
                      high_fence);
    }
}

/// Adds cars along two streets of a block; some stand across the street.
void Settler::add_street_cars(const Vec2& corner)
{
    for (int i = 0; i < 5; ++i) {
        const bool along_u = random_.chance(0.6), across = random_.chance(0.1);
        const double distance = random_.between(8, along_u ? StreetGrid::block_u - 8 : StreetGrid::block_v - 8);
        const double side = random_.between(across ? 0 : 2.6, across ? 1.5 : 3.6) * (random_.chance(0.5) ? 1 : -1);
        const Vec2 uv = corner + (along_u ? Vec2(distance, side) : Vec2(side, distance));
        add_car({StreetGrid::to_world(uv), (along_u ? 0 : 1) + (across ? 1 : 0) + 2 * random_.below(2)}, 0.12);
    }
}

void Settler::add_block(int i, int j)
{
    const Vec2 corner(i * StreetGrid::block_u, j * StreetGrid::block_v);
    const Site block = {StreetGrid::to_world(corner + Vec2(StreetGrid::block_u, StreetGrid::block_v) / 2), 0};
    const double kind = random_.between(0, 1);
    if (kind < 0.07)
        add_park(block);
    else if (kind < 0.12)
        add_cars_in_rows(block);
    else if (kind < 0.22)
        add_towers(block);
    else
        for (const int side : {0, 2}) add_row({Site{block.middle, side}.to_world({0, -lot_depth / 2}), side});
    add_street_cars(corner);
}

/// Adds trees on dry ground outside the town.
void Settler::add_wild_trees()
{
    for (int i = 0; i < wild_trees; ++i) {
        const double x = random_.between(0, Island::side), y = random_.between(0, Island::side);
        const Vec2 p(Island::low_x + x, Island::low_y + y);
        if (!island_.is_in_town(StreetGrid::from_world(p)) && island_.height(p) > Island::sea_level + 1) add_tree(p);
    }
}

World Settler::settle()
{
    world_.scene.name = bridge_ == Bridge::OneObject ? "complex" : "complex-deck";
    make_models();
    island_.add_to(world_.scene);
    add_bridge_of_canal();
    for (int j = -Island::most_blocks; j < Island::most_blocks; ++j)
        for (int i = -Island::most_blocks; i < Island::most_blocks; ++i)
            if (island_.is_settled(i, j)) add_block(i, j);
    add_wild_trees();
    world_.landmarks = complex_landmarks(world_.scene, island_);
    return std::move(world_);
}

}  // namespace

World complex_district(std::uint64_t seed, Bridge bridge) { return Settler(seed, bridge).settle(); }

}  // namespace worlds
