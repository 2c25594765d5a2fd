#include "town.h"

#include "worlds/things.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>

using namespace spawnfield;
using namespace worlds;

namespace bench {
namespace {

using Vec2 = Eigen::Vector2d;

struct Extents {
    double side;  ///< m
    int cells;    ///< cells of the ground along a side
};

constexpr double block = 80, street = 12, pavement = 2.5, kerb = 0.15, ground = 2;  // m

class Town {
public:
    Town(std::uint64_t seed, const Extents& extents) : random_(seed), side_(extents.side), cells_(extents.cells)
    {
        scene_.name = "town";
    }

    Scene build();

private:
    double shore(double y) const;
    double height(double x, double y) const;
    void add_ground();
    void add_bridge();
    void add_block(const Vec2& corner);
    void add_pavement(const Vec2& corner);
    void add_house(const Vec2& centre, double turn);
    void add_garden(const Vec2& centre);
    void add_street_things(const Vec2& corner);

    Random random_;
    const double side_;
    const int cells_;
    Scene scene_;
};

/// Returns the x of the coast at y. The coast is a bay; half of the square is under water.
double Town::shore(double y) const
{
    const double turn = 2 * std::numbers::pi * y / side_;
    return side_ * (0.5 + 0.06 * std::sin(turn) + 0.02 * std::sin(3 * turn));
}

/// Returns the height of the ground: level land 2 m above the water (with bumps of 5 cm), a beach, and a sea bed with
/// dunes.
double Town::height(double x, double y) const
{
    const double inland = shore(y) - x;
    if (inland > 15) return ground + 0.05 * std::sin(x / 30) * std::cos(y / 25);
    if (inland > 0) return ground * inland / 15;
    return std::max(-12.0, 0.12 * inland) + 0.4 * std::min(1.0, -inland / 20) * std::sin(x / 9) * std::cos(y / 7);
}

void Town::add_ground()
{
    const Vec3 middle(side_ / 2, side_ / 2, 0);
    const auto relief = [&](double x, double y) { return height(x + middle.x(), y + middle.y()); };
    hand::add_mesh(scene_, Label::Terrain, hand::moved(hand::relief(cells_, side_, relief), {middle, Mat3::Identity()}),
                   {.kind = "heightmap"});
    scene_.parts.back().name = "ground";
    hand::add_mesh(scene_, Label::Water, hand::moved(hand::rectangle(side_, side_), {middle, Mat3::Identity()}),
                   {.kind = "plane"});
    scene_.parts.back().name = "sea";
}

/// Adds a bridge from the coast out over the water: a ramp up to a deck on piers, with railings.
void Town::add_bridge()
{
    const double y = side_ / 2, from = shore(y) - 60, to = std::min(side_ - 20, shore(y) + 0.3 * side_), deck = 7,
                 half = 5;
    const std::vector<Vec2> profile = {
        {from, height(from, y) - 1}, {from + 50, deck - 0.8}, {to, deck - 0.8}, {to, deck},
        {from + 50, deck},           {from, height(from, y)}};
    // profile_along_y needs a polygon that is visible from its first corner, so the profile is split in two.
    add_thing(scene_, "bridge", Label::Terrain,
              {profile_along_y({profile[0], profile[1], profile[4], profile[5]}, y - half, y + half)}, {});
    hand::add_piece(scene_, profile_along_y({profile[1], profile[2], profile[3], profile[4]}, y - half, y + half));
    const std::vector<Vec2> railing = {
        {from + 50, deck - 0.1}, {to, deck - 0.1}, {to, deck + 1}, {from + 50, deck + 1}};
    for (const double edge : {y - half + 0.2, y + half - 0.4})
        add_thing(scene_, "railing", Label::Obstacle, {profile_along_y(railing, edge, edge + 0.2)}, {});
    for (double x = from + 55; x < to; x += 25)
        for (const double pier : {y - 3, y + 3}) {
            const double foot = height(x, pier) - 1;
            const Pose middle = {{x, pier, (deck - 0.7 + foot) / 2}, Mat3::Identity()};
            add_thing(scene_, "pier", Label::Obstacle, {hand::box({1.2, 1.2, deck - 0.7 - foot})}, middle);
        }
}

void Town::add_pavement(const Vec2& corner)
{
    const double x0 = corner.x() + street / 2, x1 = corner.x() + block - street / 2;
    const double y0 = corner.y() + street / 2, y1 = corner.y() + block - street / 2;
    const BlockGrid ring = {{x0, x0 + pavement, x1 - pavement, x1},
                            {y0, y0 + pavement, y1 - pavement, y1},
                            {ground - 1, ground + kerb},
                            [](int i, int j, int) { return i != 1 || j != 1; }};
    add_thing(scene_, "pavement", Label::Terrain, {blocks(ring)}, {});
}

void Town::add_house(const Vec2& centre, double turn)
{
    const Pose pose = {{centre.x(), centre.y(), ground}, rotation_from_rpy(0, 0, turn)};
    if (random_.chance(0.35))
        add_thing(scene_, "house", Label::Obstacle, house(random_, 1), pose);
    else
        add_thing(scene_, "house", Label::Obstacle, {recessed_house(random_)}, pose);
}

/// Adds a fence with gaps around the yard inside the block, and trees in the yard.
void Town::add_garden(const Vec2& centre)
{
    const double half = 11;
    const Vec2 corners[] = {{-half, -half}, {half, -half}, {half, half}, {-half, half}};
    for (std::size_t i = 0; i < 4; ++i)
        for (int k = 0; k < 7; ++k) {
            if (random_.chance(0.15)) continue;
            const Vec2 along = (corners[(i + 1) % 4] - corners[i]) / 7, from = centre + corners[i] + k * along,
                       to = from + along;
            const Pieces panel = fence_panel(random_, {from.x(), from.y(), ground}, {to.x(), to.y(), ground});
            add_thing(scene_, "fence", Label::Obstacle, panel, {});
        }
    for (int i = 0; i < 5; ++i) {
        const double x = random_.between(-9, 9), y = random_.between(-9, 9), turn = random_.between(-3, 3);
        const Pose pose = {{centre.x() + x, centre.y() + y, ground}, rotation_from_rpy(0, 0, turn)};
        add_thing(scene_, "tree", Label::Obstacle, tree(random_), pose);
    }
}

/// Adds cars along the kerbs, and trees on the pavements.
void Town::add_street_things(const Vec2& corner)
{
    for (int i = 0; i < 5; ++i) {
        const bool along_x = random_.chance(0.5);
        const double distance = random_.between(street, block - street), side = street / 2 - 1.1;
        const Vec2 place = corner + (along_x ? Vec2(distance, side) : Vec2(side, distance));
        const Pose pose = {{place.x(), place.y(), ground}, rotation_from_rpy(0, 0, along_x ? 0 : std::numbers::pi / 2)};
        add_thing(scene_, "car", Label::Obstacle, car(random_), pose);
    }
    for (double distance = street; distance < block - street; distance += 14) {
        const Vec2 place = corner + Vec2(distance, street / 2 + 0.7);
        add_thing(scene_, "tree", Label::Obstacle, tree(random_),
                  {{place.x(), place.y(), ground + kerb}, Mat3::Identity()});
    }
}

void Town::add_block(const Vec2& corner)
{
    const Vec2 centre = corner + Vec2(block / 2, block / 2);
    const double ring = block / 2 - street / 2 - pavement - 8;
    add_pavement(corner);
    for (int side = 0; side < 4; ++side) {
        const double turn = side * std::numbers::pi / 2;
        for (const double along : {-17.0, 0.0, 17.0})
            add_house(
                centre + Eigen::Rotation2Dd(turn) * Vec2(along + (along > 0 ? -1 : 1) * random_.between(0, 1), -ring),
                turn);
    }
    add_garden(centre);
    add_street_things(corner);
}

Scene Town::build()
{
    add_ground();
    add_bridge();
    for (int row = 0; (row + 1) * block <= side_; ++row)
        for (int col = 0; (col + 1) * block <= side_; ++col) {
            const Vec2 corner(col * block, row * block);
            const double coast = std::min(shore(corner.y()), shore(corner.y() + block));
            const bool under_bridge = std::abs(corner.y() + block / 2 - side_ / 2) < block &&
                                      corner.x() + block > coast - 70;
            if (corner.x() + block < coast - 15 && !under_bridge) add_block(corner);
        }
    return std::move(scene_);
}

}  // namespace

Scene town_scene(std::uint64_t seed) { return Town(seed, {1280, 400}).build(); }

Scene small_town_scene(std::uint64_t seed) { return Town(seed, {240, 96}).build(); }

}  // namespace bench
