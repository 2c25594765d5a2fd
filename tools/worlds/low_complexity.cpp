#include "hand_scene.h"
#include "valley_town.h"
#include "world.h"

#include <cmath>
#include <functional>
#include <numbers>

using namespace spawnfield;

namespace worlds {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double world_side = 500, ground_side = 499.9;  // m: the last column of a raster has no ground
constexpr int ground_cells = 500;                        // along a side
constexpr double lowest = 31, highest = 124;             // m: of all that is solid

/// What grows on a stretch of land.
struct Growth {
    int count;             ///< of plants; fewer where there is no room
    double spacing;        ///< m between neighbours
    double conifers, bushes;  ///< shares; the others are broad trees
    std::function<bool(const Vec2&)> grows_at;
};

class Valley {
public:
    explicit Valley(std::uint64_t seed) : random_(seed), land_(random_), edge_(random_, 50, 140), placer_(land_, world_.scene)
    {
        world_.scene.name = "low-complexity";
    }

    World build();

private:
    Vec2 anywhere();
    void add_ground();
    void add_lake();
    void add_jetty(const Vec2& shore, const Vec2& outwards);
    void add_border();
    void add_mast();
    void keep_paths();
    void add_fields();
    void add_hedge(const Vec2& from, const Vec2& to);
    void grow(const Growth& growth);
    void grow_all();
    void add_boulders();
    bool is_dense_forest(const Vec2& p) const;
    bool is_thin_forest(const Vec2& p) const { return land_.unevenness(p) > 0.5; }
    void add_landmark(const char* name, const Vec2& centre, double side);

    World world_;
    Random random_;
    const ValleyLand land_;
    const Waves edge_;  ///< of the forest
    Placer placer_;
    TownFrame town_ = {land_.town().centre, 0.2};
    Vec2 landing_ = Vec2::Zero();  ///< where the jetty begins
};

Vec2 Valley::anywhere()
{
    constexpr double margin = 3;  // m: no crown reaches over the edge
    const double x = random_.between(margin, ground_side - margin), y = random_.between(margin, ground_side - margin);
    return {x, y};
}

void Valley::add_ground()
{
    const double half = ground_side / 2;
    const auto height = [&](double x, double y) { return land_.height({x + half, y + half}); };
    const hand::Mesh mesh = hand::relief(ground_cells, ground_side, height);
    hand::add_mesh(world_.scene, Label::Terrain, hand::moved(mesh, {{half, half, 0}, Mat3::Identity()}), {.kind = "heightmap"});
    world_.scene.parts.back().name = "ground";
}

void Valley::add_lake()
{
    const auto& [centre, radius] = land_.lake();
    const Pose pose = {{centre.x(), centre.y(), ValleyLand::water}, Mat3::Identity()};
    hand::add_mesh(world_.scene, Label::Water, hand::moved(hand::rectangle(2 * radius, 2 * radius), pose), {.kind = "plane"});
    world_.scene.parts.back().name = "lake";
    const Vec2 outwards = (land_.town().centre - centre).normalized();
    Vec2 shore = centre;
    while (!land_.is_dry(shore, 0.15)) shore += 0.5 * outwards;
    landing_ = shore;
    add_jetty(shore, outwards);
}

/// A deck on piles that reach down to the lowest height of the world.
void Valley::add_jetty(const Vec2& shore, const Vec2& outwards)
{
    constexpr double length = 24, width = 2, deck = ValleyLand::water + 0.5, thick = 0.25, spacing = 4;  // m; deck: top
    const Mat3 rotation = rotation_from_rpy(0, 0, std::atan2(outwards.y(), outwards.x()));
    const auto box = [&](const std::string& name, const Vec3& size, const Vec3& centre) {
        return Element{name, {.kind = ShapeKind::Box, .size = size, .pose = {centre, Mat3::Identity()}}};
    };
    Compound jetty = {box("deck", {length, width, thick}, {-length / 2, 0, deck - thick / 2})};
    const double pile = deck - thick - lowest;
    for (double x = 2 * spacing; x < length; x += spacing)
        for (const double y : {-0.8, 0.8})
            jetty.push_back(box("pile-" + std::to_string(jetty.size() - 1), {0.25, 0.25, pile}, {-x, y, lowest + pile / 2}));
    placer_.add("jetty", jetty, {{shore.x(), shore.y(), 0}, rotation});
}

/// Stones in the corners: with them the scene spans 500 x 500 m.
void Valley::add_border()
{
    constexpr double side = 0.1, height = 1.2;  // m
    const Compound stone = {{"", {.kind = ShapeKind::Box, .size = {side, side, 2 * height}, .pose = {}}}};
    for (const double y : {side / 2, world_side - side / 2})
        for (const double x : {side / 2, world_side - side / 2}) placer_.add("border-stone", stone, {x, y}, 0);
}

/// On the hill, up to the world's greatest height.
void Valley::add_mast()
{
    constexpr double radius = 0.25, foot = 100;  // m
    const Vec2 top = land_.hill().centre;
    const Compound hut = {{"hut", {.kind = ShapeKind::Box, .size = {4, 3, 5.6}, .pose = {{3.2, 0, 0}, Mat3::Identity()}}}};
    const Compound pole = {{"pole", {.kind = ShapeKind::Capsule, .size = {radius, highest - foot - 2 * radius, 0}, .pose = {}}}};
    placer_.add("mast-hut", hut, top, 0.3);
    placer_.add("mast", pole, {{top.x(), top.y(), (highest + foot) / 2}, Mat3::Identity()});
    placer_.keep_clear({top, 9});
}

/// From the town to the jetty, through the dense forest, and up the hill: ground alone, no tree stands on it.
void Valley::keep_paths()
{
    constexpr double half_width = 2.2;  // m
    const std::vector<std::vector<Vec2>> paths = {
        {town_.point(-86, 0), (town_.point(-86, 0) + landing_) / 2 + Vec2(0, 8), landing_},
        {town_.point(-86, 0), {185, 250}, {150, 290}, {160, 340}, {110, 380}, {120, 440}, {90, 500}},
        {town_.point(86, 0), {390, 260}, {380, 320}, {410, 370}, {400, 420}, land_.hill().centre},
        {town_.point(0, 86), {270, 350}, {300, 420}, {290, 500}},
        {town_.point(0, -86), {320, 60}, {350, 0}},
    };
    for (const std::vector<Vec2>& path : paths)
        for (std::size_t i = 1; i < path.size(); ++i) placer_.keep_clear(path[i - 1], path[i], half_width);
}

/// A row of bushes and now and then a tree.
void Valley::add_hedge(const Vec2& from, const Vec2& to)
{
    const double length = (to - from).norm();
    for (double at = 0; at < length; at += random_.between(1.2, 2.2)) {
        const Vec2 straight = from + at / length * (to - from);
        const Vec2 place = straight + 16 * Vec2(edge_.at(straight), edge_.at(-straight));
        const bool is_tree = random_.chance(0.06);
        const Compound plant = is_tree ? broad_tree(random_) : bush(random_);
        if (!placer_.is_clear({place, 0.5})) continue;
        placer_.add(is_tree ? "tree" : "bush", plant, place, 0);
    }
}

/// Between the forest and the hill: hedges along fields, and an orchard.
void Valley::add_fields()
{
    constexpr double left = 215, right = 360, bottom = 325, top = 480, row = 8;  // m
    add_hedge({left, bottom}, {left - 8, top});
    add_hedge({left + 20, 410}, {right, 418});
    add_hedge({left, bottom}, {right, bottom + 10});
    for (double y = bottom + 20; y < 400; y += row)
        for (double x = 300; x < right; x += row)
            if (placer_.is_clear({{x, y}, 2})) placer_.add("tree", broad_tree(random_), Vec2(x, y), 0);
}

bool Valley::is_dense_forest(const Vec2& p) const
{
    const double edge = 60 * edge_.at(p);
    return p.x() < 178 + edge && p.y() > 238 + edge;
}

void Valley::grow(const Growth& growth)
{
    constexpr int draws = 60;  // for each plant
    for (int i = 0, left = draws * growth.count; i < growth.count && left > 0; --left) {
        const Vec2 place = anywhere();
        const Disc ground = {place, growth.spacing / 2};
        if (!growth.grows_at(place) || !land_.is_dry(place) || !placer_.is_clear(ground)) continue;
        const double kind = random_.between(0, 1);
        const bool is_conifer = kind < growth.conifers, is_bush = !is_conifer && kind < growth.conifers + growth.bushes;
        const Compound plant = is_conifer ? conifer(random_) : is_bush ? bush(random_) : broad_tree(random_);
        placer_.add(is_bush ? "bush" : "tree", plant, place, 0);
        placer_.keep_clear(ground);
        ++i;
    }
}

void Valley::grow_all()
{
    grow({2600, 2.5, 0.19, 0.04, [this](const Vec2& p) { return is_dense_forest(p); }});
    grow({700, 4.5, 0.25, 0.15, [this](const Vec2& p) { return is_thin_forest(p); }});
    const auto is_shore = [this](const Vec2& p) {
        const double out = (p - land_.lake().centre).norm();
        return out < land_.lake().radius + 30 && (p - landing_).norm() > 30;
    };
    grow({160, 3, 0, 0.6, is_shore});
    grow({120, 12, 0.1, 0.2, [](const Vec2&) { return true; }});
}

void Valley::add_boulders()
{
    constexpr int count = 60;
    for (int i = 0; i < count;) {
        const Disc ground = {anywhere(), 2.5};
        if (!land_.is_dry(ground.centre) || !placer_.is_clear(ground)) continue;
        const double yaw = random_.between(-pi, pi);
        placer_.add("boulder", boulder(random_), ground.centre, yaw);
        placer_.keep_clear(ground);
        ++i;
    }
}

/// A square on the map, as low as its ground and as high as what stands in it.
void Valley::add_landmark(const char* name, const Vec2& centre, double side)
{
    const Vec2 low = centre - Vec2(side / 2, side / 2), high = centre + Vec2(side / 2, side / 2);
    Bounds where;
    for (double y = low.y(); y <= high.y(); y += 1)
        for (double x = low.x(); x <= high.x(); x += 1) where.extend({x, y, land_.height({x, y})});
    const Bounds ground = where;
    for (const Primitive& primitive : world_.scene.primitives)
        if (const Bounds bounds = bounds_of(primitive.shape); bounds.meets(ground, 2))
            where.max.z() = std::max(where.max.z(), bounds.max.z());
    world_.landmarks.push_back({name, where});
}

World Valley::build()
{
    add_ground();
    add_lake();
    add_border();
    add_mast();
    keep_paths();
    add_town(placer_, random_, town_);
    add_fields();
    add_boulders();
    grow_all();
    add_landmark("fountain", town_.centre, 24);
    add_landmark("lake", landing_, 56);
    add_landmark("dense_forest", {90, 340}, 50);
    add_landmark("thin_forest", {440, 240}, 60);
    add_landmark("town", town_.point(42, 0), 60);
    return std::move(world_);
}

}  // namespace

World low_complexity(std::uint64_t seed) { return Valley(seed).build(); }

}  // namespace worlds
