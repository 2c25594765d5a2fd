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
constexpr double world_side = 500, ground_side = 499.9;  // m; the last column of a raster has no ground
constexpr int ground_cells = 500;                        // cells along a side
constexpr double lowest = 31, highest = 124;             // m, of everything that is solid

/// The plants in one kind of area.
struct Growth {
    int count;                ///< number of plants; fewer if there is no room
    double spacing;           ///< m between neighbours
    double conifers, bushes;  ///< shares of the plants; the others are broad trees
    std::function<bool(const Vec2&)> grows_at;
};

class Valley {
public:
    explicit Valley(std::uint64_t seed)
        : random_(seed), land_(random_), edge_(waves_between(random_, 50, 140)), placer_(land_, world_.scene)
    {
        world_.scene.name = "low-complexity";
    }

    World build();

private:
    Vec2 anywhere();
    void add_ground();
    void add_lake();
    void add_border();
    void add_mast();
    void keep_paths();
    void add_fields();
    void add_hedge(const Vec2& from, const Vec2& to);
    bool plant(const Disc& ground, double conifers, double bushes);
    void grow(const Growth& growth);
    void grow_all();
    void add_boulders();
    bool is_dense_forest(const Vec2& p) const;
    void add_landmark(const char* name, const Vec2& centre, int side);

    World world_;
    Random random_;
    const ValleyLand land_;
    const Waves edge_;  ///< of the dense forest
    Placer placer_;
    const TownFrame town_ = {land_.town().centre, 0.2};
    Vec2 landing_ = Vec2::Zero();  ///< where the jetty begins
};

Vec2 Valley::anywhere()
{
    constexpr double margin = 3;  // m, so that no crown reaches over the edge
    const double x = random_.between(margin, ground_side - margin), y = random_.between(margin, ground_side - margin);
    return {x, y};
}

void Valley::add_ground()
{
    const double half = ground_side / 2;
    const auto height = [&](double x, double y) { return land_.height({x + half, y + half}); };
    const hand::Mesh mesh = hand::relief(ground_cells, ground_side, height);
    hand::add_mesh(world_.scene, Label::Terrain, hand::moved(mesh, {{half, half, 0}, Mat3::Identity()}),
                   {.kind = "heightmap"});
    world_.scene.parts.back().name = "ground";
}

/// Adds the water, and a jetty on the side of the town. Its piles reach down to the lowest height of the world.
void Valley::add_lake()
{
    constexpr double deck = ValleyLand::water + 0.5, length = 24;  // m
    const auto& [centre, radius] = land_.lake();
    const Pose pose = {{centre.x(), centre.y(), ValleyLand::water}, Mat3::Identity()};
    hand::add_mesh(world_.scene, Label::Water, hand::moved(hand::rectangle(2 * radius, 2 * radius), pose),
                   {.kind = "plane"});
    world_.scene.parts.back().name = "lake";

    const Vec2 outwards = (land_.town().centre - centre).normalized();
    landing_ = centre;
    while (!land_.is_dry(landing_, 0.15)) landing_ += 0.5 * outwards;
    const Mat3 rotation = rotation_from_rpy(0, 0, std::atan2(outwards.y(), outwards.x()));
    placer_.add("jetty", jetty(length, deck - lowest), {{landing_.x(), landing_.y(), deck}, rotation});
}

/// Adds stones in the corners, so that the scene spans 500 x 500 m.
void Valley::add_border()
{
    constexpr double inside = 0.05;  // m, half of the width of a stone
    for (const double y : {inside, world_side - inside})
        for (const double x : {inside, world_side - inside}) placer_.add("border", border_stone(), {x, y}, 0);
}

/// Adds a mast on the hill, up to the greatest height of the world, and a hut beside it.
void Valley::add_mast()
{
    constexpr double foot = 100;  // m, inside the hill
    const Vec2 top = land_.hill().centre;
    placer_.add("mast", mast(highest - foot), {{top.x(), top.y(), foot}, Mat3::Identity()});
    placer_.add("hut", hut(), top + Vec2(4, 1), 0.3);
    placer_.keep_clear({top, 9});
}

/// Keeps the ground of the paths free of trees: from the town to the jetty, through the dense forest, up the hill, and
/// out of the town.
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

/// Adds a plant if there is room for it.
bool Valley::plant(const Disc& ground, double conifers, double bushes)
{
    if (!land_.is_dry(ground.centre) || !placer_.is_clear(ground)) return false;
    const double kind = random_.between(0, 1);
    if (kind < conifers)
        placer_.add("tree", conifer(random_), ground.centre, 0);
    else if (kind < conifers + bushes)
        placer_.add("bush", bush(random_), ground.centre, 0);
    else
        placer_.add("tree", broad_tree(random_), ground.centre, 0);
    placer_.keep_clear(ground);
    return true;
}

/// Adds a winding row of bushes with some trees.
void Valley::add_hedge(const Vec2& from, const Vec2& to)
{
    constexpr double bend = 16;      // m
    constexpr double bushes = 0.94;  // share
    const double length = (to - from).norm();
    for (double distance = 0; distance < length; distance += random_.between(1.3, 2.1)) {
        const Vec2 straight = from + distance / length * (to - from);
        plant({straight + bend * Vec2(swing(edge_, straight), swing(edge_, -straight)), 0.5}, 0, bushes);
    }
}

/// Adds hedges along fields, and an orchard, between the forest and the hill.
void Valley::add_fields()
{
    constexpr double left = 215, right = 360, bottom = 325, top = 480, row = 8;  // m
    add_hedge({left, bottom}, {left - 8, top});
    add_hedge({left + 20, 410}, {right, 418});
    add_hedge({left, bottom}, {right, bottom + 10});
    for (double y = bottom + 20; y < 400; y += row)
        for (double x = 300; x < right; x += row) plant({{x, y}, 2}, 0, 0);
}

bool Valley::is_dense_forest(const Vec2& p) const
{
    const double edge = 60 * swing(edge_, p);
    return p.x() < 178 + edge && p.y() > 238 + edge;
}

void Valley::grow(const Growth& growth)
{
    constexpr int draws_per_plant = 60;
    int missing = growth.count;
    for (int draws = draws_per_plant * growth.count; missing > 0 && draws > 0; --draws) {
        const Vec2 place = anywhere();
        if (growth.grows_at(place) && plant({place, growth.spacing / 2}, growth.conifers, growth.bushes)) --missing;
    }
}

void Valley::grow_all()
{
    const auto in_dense_forest = [this](const Vec2& p) { return is_dense_forest(p); };
    const auto in_thin_forest = [this](const Vec2& p) { return land_.unevenness(p) > 0.5; };
    const auto around_lake = [this](const Vec2& p) {
        return (p - land_.lake().centre).norm() < land_.lake().radius + 30 && (p - landing_).norm() > 30;
    };
    const auto everywhere = [](const Vec2&) { return true; };
    grow({.count = 2600, .spacing = 2.5, .conifers = 0.19, .bushes = 0.04, .grows_at = in_dense_forest});
    grow({.count = 700, .spacing = 4.5, .conifers = 0.25, .bushes = 0.15, .grows_at = in_thin_forest});
    grow({.count = 160, .spacing = 3, .conifers = 0, .bushes = 0.6, .grows_at = around_lake});
    grow({.count = 120, .spacing = 12, .conifers = 0.1, .bushes = 0.2, .grows_at = everywhere});
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

/// Adds a landmark: a square on the map, `side` m across, from its lowest ground to the top of the highest thing in it.
void Valley::add_landmark(const char* name, const Vec2& centre, int side)
{
    const Vec2 corner = centre - Vec2(side / 2.0, side / 2.0);
    Bounds where;
    for (int row = 0; row <= side; ++row)
        for (int col = 0; col <= side; ++col) where.extend(placer_.on_ground(corner + Vec2(col, row)));
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
