#include "hills.h"

#include "base/rotation.h"
#include "worlds/things.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <queue>

using namespace spawnfield;
using namespace worlds;

namespace bench {
namespace {

using Vec2 = Eigen::Vector2d;

/// Contents of a tile.
struct Amounts {
    double side;                                                         ///< m
    int cells;                                                           ///< cells of the terrain along a side
    double relief;                                                       ///< m from the lowest to the highest ground
    int villages, houses, gardens, forests, trees, cars, rocks, fences;  ///< fences: panels
};

constexpr Amounts whole = {500, 512, 75, 7, 160, 20, 14, 780, 150, 310, 600};
constexpr Amounts small = {125, 128, 18.75, 1, 10, 1, 2, 49, 9, 19, 38};

// ---- Land ----

/// Heights of one tile. Beyond its rim they repeat.
class Land {
public:
    Land(Random& random, const Amounts& amounts);

    double side() const { return side_; }
    double height(const Vec2& p) const;
    double slope(const Vec2& p) const { return std::acos(normal(p).z()); }  ///< rad
    Vec3 normal(const Vec2& p) const;
    bool is_dry(const Vec2& p) const { return height(p) > water_ + 0.4; }

    double water() const { return water_; }
    const Bounds& lake() const { return lake_; }  ///< bounds in x and y; z is 0

private:
    int wrapped(int i) const { return (i % cells_ + cells_) % cells_; }
    std::size_t slot(int row, int col) const { return std::size_t(wrapped(row)) * cells_ + wrapped(col); }
    double& corner(int row, int col) { return heights_[slot(row, col)]; }
    double corner(int row, int col) const { return heights_[slot(row, col)]; }
    void add_waves(Random& random);
    void scale_to(double relief);
    void add_hill(Random& random, double height, double spread);
    void move_lowest_to(int row, int col);
    void fill_lake(std::size_t cells);

    double side_;
    int cells_;
    std::vector<double> heights_;
    double water_ = 0;
    Bounds lake_;
};

Land::Land(Random& random, const Amounts& amounts)
    : side_(amounts.side), cells_(amounts.cells), heights_(std::size_t(cells_) * cells_)
{
    add_waves(random);
    scale_to(0.3 * amounts.relief);
    add_hill(random, 0.6 * amounts.relief, 0.11);
    add_hill(random, 0.3 * amounts.relief, 0.08);
    scale_to(amounts.relief);
    move_lowest_to(cells_ * 2 / 5, cells_ / 3);
    fill_lake(heights_.size() / 25);
}

/// Adds octaves of plane waves. Each wave fits a whole number of times into the tile, so that tiles join without a
/// step.
void Land::add_waves(Random& random)
{
    constexpr int octaves = 6, waves = 6;
    std::vector<double> sines;  // one period
    for (int i = 0; i < cells_; ++i) sines.push_back(std::sin(2 * std::numbers::pi * i / cells_));
    for (int octave = 0; octave < octaves; ++octave)
        for (int wave = 0; wave < waves; ++wave) {
            const double count = (1 << octave) * random.between(1, 2), turn = random.between(0, 2 * std::numbers::pi);
            const int across = int(std::lround(count * std::cos(turn))), up = int(std::lround(count * std::sin(turn)));
            const int phase = random.below(cells_);
            const double height = std::pow(count, -1.8);
            for (int row = 0; row < cells_; ++row)
                for (int col = 0; col < cells_; ++col)
                    corner(row, col) += height * sines[wrapped(across * col + up * row + phase)];
        }
}

void Land::scale_to(double relief)
{
    const auto [low, high] = std::minmax_element(heights_.begin(), heights_.end());
    const double bottom = *low, scale = relief / (*high - *low);
    for (double& height : heights_) height = (height - bottom) * scale;
}

/// Adds a round hill. Its shape is a Gaussian with `spread` as its standard deviation, in tiles.
void Land::add_hill(Random& random, double height, double spread)
{
    const int top_row = random.below(cells_), top_col = random.below(cells_);
    const auto distance = [this](int i, int j) { return std::min(wrapped(i - j), wrapped(j - i)) / double(cells_); };
    for (int row = 0; row < cells_; ++row)
        for (int col = 0; col < cells_; ++col)
            corner(row, col) +=
                height * std::exp(-0.5 * (Vec2(distance(row, top_row), distance(col, top_col)) / spread).squaredNorm());
}

void Land::move_lowest_to(int row, int col)
{
    const int lowest = int(std::min_element(heights_.begin(), heights_.end()) - heights_.begin());
    const Land before = *this;
    for (int r = 0; r < cells_; ++r)
        for (int c = 0; c < cells_; ++c)
            corner(r + row, c + col) = before.corner(r + lowest / cells_, c + lowest % cells_);
}

/// Floods the land from its lowest point until the lake has at least `cells` cells and no shore cell below its water.
/// Source: Barnes, Lehman, Mulla, Priority-flood, 2014.
void Land::fill_lake(std::size_t cells)
{
    using Place = std::pair<double, std::pair<int, int>>;
    std::priority_queue<Place, std::vector<Place>, std::greater<>> shore;
    std::vector<char> seen(heights_.size(), 0);
    const auto reach = [&](int row, int col) {
        if (row < 0 || col < 0 || row >= cells_ || col >= cells_ || seen[slot(row, col)]) return;
        seen[slot(row, col)] = 1;
        shore.push({corner(row, col), {row, col}});
    };
    const int lowest = int(std::min_element(heights_.begin(), heights_.end()) - heights_.begin());
    reach(lowest / cells_, lowest % cells_);
    const double cell = side_ / cells_;
    for (std::size_t wet = 0; wet < cells || shore.top().first <= water_; ++wet) {
        const auto [height, place] = shore.top();
        const auto [row, col] = place;
        shore.pop();
        water_ = std::max(water_, height);
        lake_.extend({std::max(0, col - 1) * cell, std::max(0, row - 1) * cell, 0});
        lake_.extend({(col + 1) * cell, (row + 1) * cell, 0});
        for (const int step : {-1, 1}) {
            reach(row + step, col);
            reach(row, col + step);
        }
    }
}

double Land::height(const Vec2& p) const
{
    const double x = p.x() / side_ * cells_, y = p.y() / side_ * cells_;
    const int col = int(std::floor(x)), row = int(std::floor(y));
    const double u = x - col, v = y - row;
    return (1 - v) * ((1 - u) * corner(row, col) + u * corner(row, col + 1)) +
           v * ((1 - u) * corner(row + 1, col) + u * corner(row + 1, col + 1));
}

Vec3 Land::normal(const Vec2& p) const
{
    const Vec2 dx(1.5, 0), dy(0, 1.5);
    return Vec3(height(p - dx) - height(p + dx), height(p - dy) - height(p + dy), 3).normalized();
}

// ---- Obstacles ----

/// Adds the obstacles of one tile, with its corner at `corner`, to a scene.
class Settler {
public:
    Settler(Random random, const Land& land, const Vec2& corner, Scene& scene)
        : random_(random), land_(land), corner_(corner), scene_(scene)
    {
    }

    void settle(const Amounts& amounts);

private:
    struct Site {
        Vec2 place;
        double radius;  ///< m, kept free around it
    };
    struct Wish {
        Vec2 near;
        double spread;    ///< m around `near`
        double radius;    ///< m, to keep free
        double steepest;  ///< rad
    };

    Vec2 anywhere(double margin = 12);
    Vec2 gentlest_of(int count);
    Vec2 find_site(const Wish& wish);
    bool is_clear(const Site& site) const;
    double yaw() { return random_.between(-std::numbers::pi, std::numbers::pi); }
    Vec3 on_ground(const Vec2& p, double lift = 0) const { return {p.x(), p.y(), land_.height(p) + lift}; }
    Mat3 along_ground(const Vec2& p, double turn) const;

    void add(const char* name, const Pieces& pieces, const Pose& pose);
    void add_house(const Vec2& village, bool garden);
    void add_garden(const Vec2& place, double turn);
    void add_tree(const Vec2& forest);
    void add_car(const Vec2& village);
    void add_rock();
    void add_field_fence(int longest);
    bool add_panel(const Vec2& from, const Vec2& to);

    Random random_;
    const Land& land_;
    const Vec2 corner_;
    Scene& scene_;
    std::vector<Site> sites_;
    int fences_left_ = 0;
};

void Settler::settle(const Amounts& amounts)
{
    fences_left_ = amounts.fences;
    std::vector<Vec2> villages, forests;
    for (int i = 0; i < amounts.villages; ++i) villages.push_back(gentlest_of(30));
    for (int i = 0; i < amounts.forests; ++i) forests.push_back(anywhere());
    const auto one_of = [this](const std::vector<Vec2>& places) { return places[random_.below(int(places.size()))]; };
    for (int i = 0; i < amounts.houses; ++i) add_house(one_of(villages), i < amounts.gardens);
    for (int i = 0; i < amounts.cars; ++i) add_car(one_of(villages));
    for (int i = 0; i < amounts.trees; ++i) add_tree(i % 5 == 0 ? anywhere() : one_of(forests));
    for (int i = 0; i < amounts.rocks; ++i) add_rock();
    while (fences_left_ > 0) add_field_fence(20);
}

Vec2 Settler::anywhere(double margin)
{
    const double x = random_.between(margin, land_.side() - margin), y = random_.between(margin, land_.side() - margin);
    return {x, y};
}

Vec2 Settler::gentlest_of(int count)
{
    Vec2 best = anywhere(40);
    const auto rating = [&](const Vec2& p) {
        return land_.slope(p) + (land_.is_dry(p) ? 0 : 1) + (is_clear({p, 60}) ? 0 : 0.5);
    };
    for (int i = 1; i < count; ++i) {
        const Vec2 other = anywhere(40);
        if (rating(other) < rating(best)) best = other;
    }
    sites_.push_back({best, 0});
    return best;
}

bool Settler::is_clear(const Site& site) const
{
    return std::none_of(sites_.begin(), sites_.end(), [&](const Site& other) {
        return (other.place - site.place).norm() < other.radius + site.radius;
    });
}

/// Returns a dry, gentle and free place. With every attempt the place may be further from `near` and steeper.
Vec2 Settler::find_site(const Wish& wish)
{
    Vec2 place = wish.near;
    for (int attempt = 0; attempt < 5000; ++attempt) {
        const double slack = 1 + attempt / 100.0;
        const double reach = slack * wish.spread * std::sqrt(random_.between(0, 1)), turn = yaw();
        place = wish.near + reach * Vec2(std::cos(turn), std::sin(turn));
        place = place.cwiseMax(12).cwiseMin(land_.side() - 12);
        if (land_.is_dry(place) && land_.slope(place) <= slack * wish.steepest && is_clear({place, wish.radius})) break;
    }
    sites_.push_back({place, wish.radius});
    return place;
}

Mat3 Settler::along_ground(const Vec2& p, double turn) const
{
    return rotation_from_z_to(land_.normal(p)) * rotation_from_rpy(0, 0, turn);
}

void Settler::add(const char* name, const Pieces& pieces, const Pose& pose)
{
    add_thing(scene_, name, Label::Obstacle, pieces, Pose{{corner_.x(), corner_.y(), 0}, Mat3::Identity()} * pose);
}

/// Adds a house. Its floor is at the highest ground around it, and its foundation reaches below the lowest.
void Settler::add_house(const Vec2& village, bool garden)
{
    const Vec2 place = find_site({village, 45, garden ? 12.5 : 8.0, 0.2});
    const double turn = yaw();
    double low = land_.height(place), high = low;
    for (int i = 0; i < 16; ++i) {
        const Vec2 around = place + 6 * Vec2(std::cos(i * std::numbers::pi / 8), std::sin(i * std::numbers::pi / 8));
        low = std::min(low, land_.height(around));
        high = std::max(high, land_.height(around));
    }
    add("house", house(random_, high - low + 0.5), {{place.x(), place.y(), high}, rotation_from_rpy(0, 0, turn)});
    if (garden) add_garden(place, turn);
}

/// Adds a fence of 3 m panels on a rectangle around a house, with a gate.
void Settler::add_garden(const Vec2& place, double turn)
{
    const Eigen::Rotation2Dd rotation(turn);
    const auto corner = [&](double x, double y) -> Vec2 { return place + rotation * Vec2(x, y); };
    const std::vector<Vec2> corners = {corner(-9, -7.5), corner(9, -7.5), corner(9, 7.5), corner(-9, 7.5)};
    for (std::size_t i = 0; i < 4; ++i) {
        const Vec2 from = corners[i], to = corners[(i + 1) % 4];
        const int panels = i % 2 == 0 ? 6 : 5;
        for (int k = i == 0 ? 1 : 0; k < panels; ++k)
            add_panel(from + double(k) / panels * (to - from), from + double(k + 1) / panels * (to - from));
    }
}

void Settler::add_tree(const Vec2& forest)
{
    const Vec2 place = find_site({forest, 28, 1.2, 0.6});
    const double turn = yaw();
    add("tree", tree(random_), {on_ground(place), rotation_from_rpy(0, 0, turn)});
}

void Settler::add_car(const Vec2& village)
{
    const Vec2 place = find_site({village, 55, 2.5, 0.25});
    const double turn = yaw();
    add("car", car(random_), {on_ground(place, -0.03), along_ground(place, turn)});
}

void Settler::add_rock()
{
    Vec2 near = anywhere();
    for (int i = 0; i < 3; ++i)
        if (const Vec2 other = anywhere(); land_.slope(other) > land_.slope(near)) near = other;
    const Vec2 place = find_site({near, 5, 1, 1});
    const double turn = yaw();
    add("rock", rock(random_), {on_ground(place), along_ground(place, turn)});
}

/// Adds a fence over the fields, in a gentle bend, which ends at water, at the rim of the tile or after `longest`
/// panels.
void Settler::add_field_fence(int longest)
{
    Vec2 from = anywhere();
    double turn = yaw();
    const double bend = random_.between(-0.06, 0.06);
    for (int i = 0; i < longest; ++i, turn += bend) {
        const Vec2 to = from + 3 * Vec2(std::cos(turn), std::sin(turn));
        if (!add_panel(from, to)) return;
        from = to;
    }
}

bool Settler::add_panel(const Vec2& from, const Vec2& to)
{
    const bool inside = from.minCoeff() > 2 && to.minCoeff() > 2 && from.maxCoeff() < land_.side() - 2 &&
                        to.maxCoeff() < land_.side() - 2;
    if (fences_left_ == 0 || !inside || !land_.is_dry(from) || !land_.is_dry(to)) return false;
    --fences_left_;
    add("fence", fence_panel(random_, on_ground(from), on_ground(to)), {});
    return true;
}

// ---- The scene ----

void add_lake(const Land& land, const Vec2& corner, Scene& scene)
{
    const Vec3 size = land.lake().max - land.lake().min, centre = (land.lake().max + land.lake().min) / 2;
    const Pose pose = {{corner.x() + centre.x(), corner.y() + centre.y(), land.water()}, Mat3::Identity()};
    hand::add_mesh(scene, Label::Water, hand::moved(hand::rectangle(size.x(), size.y()), pose), {.kind = "plane"});
    scene.parts.back().name = "lake-" + std::to_string(scene.parts.size() - 1);
}

Scene landscape(std::uint64_t seed, int tiles, const Amounts& amounts)
{
    Random random(seed);
    const Land land(random, amounts);
    Scene scene;
    scene.name = "hills";
    const double size = tiles * amounts.side;
    const auto height = [&](double x, double y) { return land.height({x + size / 2, y + size / 2}); };
    const Pose pose = {{size / 2, size / 2, 0}, Mat3::Identity()};
    hand::add_mesh(scene, Label::Terrain, hand::moved(hand::relief(tiles * amounts.cells, size, height), pose),
                   {.kind = "heightmap"});
    scene.parts.back().name = "terrain";
    for (int row = 0; row < tiles; ++row)
        for (int col = 0; col < tiles; ++col) {
            const Vec2 corner = amounts.side * Vec2(col, row);
            add_lake(land, corner, scene);
            Settler(random, land, corner, scene).settle(amounts);
        }
    return scene;
}

}  // namespace

Scene hills_scene(std::uint64_t seed, int tiles) { return landscape(seed, tiles, whole); }

Scene small_hills_scene(std::uint64_t seed, int tiles) { return landscape(seed, tiles, small); }

}  // namespace bench
