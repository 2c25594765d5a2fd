#include "city.h"

#include "worlds/things.h"

#include <Eigen/Geometry>

#include <numbers>

using namespace spawnfield;
using namespace worlds;

namespace bench {
namespace {

using Vec2 = Eigen::Vector2d;

struct Extents {
    double plane;    ///< m, side of the plane
    int cols, rows;  ///< blocks of the built-up area
    int bodies;      ///< without the plane and the sheet
};

// Lengths in m. A block reaches to the middle of the streets around it.
constexpr double block_x = 55, block_y = 54, street = 8, pavement = 2.5, kerb = 0.15;
constexpr int kerb_stones = 14;    // along each side of a pavement
constexpr double sheet = 0.06;     // height of the second ground above the plane
constexpr double sheet_cell = 2;   // side of the squares of which the sheet consists
constexpr double middle_y = 14.5;  // distance of the houses' middle from that of the block

class City {
public:
    City(std::uint64_t seed, const Extents& extents)
        : random_(seed), extents_(extents),
          corner_((extents.plane - extents.cols * block_x) / 2, (extents.plane - extents.rows * block_y) / 2)
    {
        scene_.name = "city";
    }

    Scene build();

private:
    void add_ground();
    void add_block(const Vec2& centre);
    void add_pavement(const Vec2& centre);
    void add_house(const Vec2& centre, int place);
    void add_trees(const Vec2& centre);
    void add_cars(const Vec2& centre);
    void add_car_park(const Vec2& centre);
    void add_bridge(const Vec2& centre);
    void add_lamp(int number);

    Vec2 centre_of(int col, int row) const { return corner_ + Vec2((col + 0.5) * block_x, (row + 0.5) * block_y); }
    void add(const char* name, const Pieces& pieces, const Vec2& place, double z, double turn = 0)
    {
        add_thing(scene_, name, Label::Obstacle, pieces, {{place.x(), place.y(), z}, rotation_from_rpy(0, 0, turn)});
    }

    Random random_;
    const Extents extents_;
    const Vec2 corner_;  ///< of the built-up area
    Scene scene_;
};

hand::Mesh box_from(const Vec3& low, const Vec3& high)
{
    return hand::moved(hand::box(high - low), {(low + high) / 2, Mat3::Identity()});
}

/// Returns a level sheet of cols x rows squares, with a corner at the origin.
hand::Mesh squares(int cols, int rows, double side)
{
    hand::Mesh mesh;
    for (int row = 0; row <= rows; ++row)
        for (int col = 0; col <= cols; ++col) mesh.vertices.emplace_back(col * side, row * side, 0);
    const auto corner = [cols](int row, int col) { return std::uint32_t(row * (cols + 1) + col); };
    for (int row = 0; row < rows; ++row)
        for (int col = 0; col < cols; ++col) {
            mesh.triangles.push_back({corner(row, col), corner(row, col + 1), corner(row + 1, col + 1)});
            mesh.triangles.push_back({corner(row, col), corner(row + 1, col + 1), corner(row + 1, col)});
        }
    return mesh;
}

/// Returns a house of several storeys along x as one closed block. Windows are recesses in its front and its back.
hand::Mesh apartments(Random& random)
{
    constexpr int windows = 6;
    const double length = random.between(12.5, 14.5), depth = random.between(8, 10);
    const double storey = random.between(2.8, 3.2), front = random.between(0.15, 0.6);
    const int storeys = 4 + random.below(5);
    BlockGrid grid;
    grid.x = window_borders(length, windows, 0.5);
    grid.y = {-depth / 2, -depth / 2 + front, depth / 2 - 0.2, depth / 2};
    grid.z = {-1};
    for (int i = 0; i < storeys; ++i)
        grid.z.insert(grid.z.end(), {i * storey + (i == 0 ? 0.1 : 0), i * storey + 0.9, i * storey + 2.2});
    grid.z.push_back(storeys * storey);
    grid.filled = [](int i, int j, int k) {
        const bool is_window = i % 2 == 1 && k % 3 == 2;
        return j == 1 || !is_window;
    };
    return blocks(grid);
}

void City::add_ground()
{
    const Pose middle = {{extents_.plane / 2, extents_.plane / 2, 0}, Mat3::Identity()};
    hand::add_mesh(scene_, Label::Terrain, hand::moved(hand::rectangle(extents_.plane, extents_.plane), middle),
                   {.kind = "plane"});
    scene_.parts.back().name = "plane";
    const int cols = int(extents_.cols * block_x / sheet_cell), rows = int(extents_.rows * block_y / sheet_cell);
    hand::add_mesh(scene_, Label::Terrain,
                   hand::moved(squares(cols, rows, sheet_cell), {{corner_.x(), corner_.y(), sheet}, Mat3::Identity()}));
    scene_.parts.back().name = "sheet";
}

/// Returns the edges of a pavement along one axis: the pavement on both sides, and between them kerb stones.
std::vector<double> kerb_lines(double length)
{
    const double inner = length / 2 - pavement;
    std::vector<double> lines = {-length / 2};
    for (int i = 0; i <= kerb_stones; ++i) lines.push_back(inner * (2.0 * i / kerb_stones - 1));
    lines.push_back(length / 2);
    return lines;
}

void City::add_pavement(const Vec2& centre)
{
    const auto is_edge = [](int i) { return i == 0 || i == kerb_stones + 1; };
    const BlockGrid ring = {
        kerb_lines(block_x - street), kerb_lines(block_y - street), {-1, sheet + kerb}, [is_edge](int i, int j, int) {
            return is_edge(i) || is_edge(j);
        }};
    add_thing(scene_, "pavement", Label::Terrain, {blocks(ring)}, {{centre.x(), centre.y(), 0}, Mat3::Identity()});
}

/// Adds a house at one of six places along the streets to -y and +y. The first one is a plain box.
void City::add_house(const Vec2& centre, int place)
{
    const Vec2 at = centre + Vec2((place % 3 - 1) * 15.5, place < 3 ? -middle_y : middle_y);
    if (place > 0) {
        const hand::Mesh house = apartments(random_);
        add("house", {house}, at, sheet, place < 3 ? 0 : std::numbers::pi);
        return;
    }
    const double length = random_.between(10, 14), depth = random_.between(8, 10), height = random_.between(5, 12);
    hand::add_shape(scene_, Label::Obstacle,
                    {.kind = ShapeKind::Box,
                     .size = {length, depth, height + 1},
                     .pose = {{at.x(), at.y(), (height - 1) / 2}, Mat3::Identity()}});
    scene_.parts.back().name = "house-" + std::to_string(scene_.parts.size() - 1);
}

/// Adds trees to the yard and along the pavement. The middle of the yard stays free for bridges.
void City::add_trees(const Vec2& centre)
{
    for (int i = 0; i < 4; ++i) {
        const double x = -18 + 12 * i + random_.between(-4, 4), y = random_.between(3.5, 6.5);
        const double turn = random_.between(-3, 3);
        const Pieces pieces = tree(random_);
        add("tree", pieces, centre + Vec2(x, i % 2 == 0 ? y : -y), sheet, turn);
    }
    for (int i = 0; i < 4; ++i) {
        const Pieces pieces = tree(random_);
        add("tree", pieces, centre + Vec2(-18.0 + 12 * i, -(block_y - street) / 2 + 0.7), sheet + kerb);
    }
}

void City::add_cars(const Vec2& centre)
{
    for (int i = 0; i < 4; ++i) {
        const double x = -18 + 12 * i + random_.between(-3, 3);
        const Pieces pieces = car(random_);
        add("car", pieces, centre + Vec2(x, -(block_y - street) / 2 - 1.2), sheet, i % 2 == 0 ? 0 : std::numbers::pi);
    }
}

void City::add_block(const Vec2& centre)
{
    add_pavement(centre);
    for (int place = 0; place < 6; ++place) add_house(centre, place);
    add_trees(centre);
    add_cars(centre);
}

/// Adds two decks on pillars with a ramp between them, and cars below and on them.
void City::add_car_park(const Vec2& centre)
{
    constexpr double deck = 3, thickness = 0.3, half = 16, depth = 12;
    const Pieces decks = {box_from({-half, -depth, deck - thickness}, {half, depth, deck}),
                          box_from({-half, -depth, 2 * deck - thickness}, {0, depth, 2 * deck}),
                          profile_along_y({{half, -0.5}, {half + 6.5, -0.5}, {half, deck}}, -3, 3),
                          profile_along_y({{0, deck - thickness}, {12, deck - thickness}, {0, 2 * deck}}, -3, 3)};
    add_thing(scene_, "car-park", Label::Terrain, decks, {{centre.x(), centre.y(), sheet}, Mat3::Identity()});
    for (const double x : {-15.0, -5.0, 5.0, 15.0})
        for (const double y : {-11.0, 0.0, 11.0})
            add("pillar", {box_from({-0.25, -0.25, -0.5}, {0.25, 0.25, deck - 0.1})}, centre + Vec2(x, y), sheet);
    for (int i = 0; i < 8; ++i) {
        const Pieces pieces = car(random_);
        const Vec2 place(-10.0 + 5 * (i / 2), i % 2 == 0 ? -6.0 : 6.0);
        add("car", pieces, centre + place, sheet + (i < 4 ? 0 : deck), std::numbers::pi / 2);
    }
}

/// Adds a foot bridge from the yard of a block over the street to that of the next block in x.
void City::add_bridge(const Vec2& centre)
{
    constexpr double deck = 4.5, thickness = 0.4, half = 6, ramp = 15, width = 1.5;
    const double low = deck - thickness;
    const Vec2 at = centre + Vec2(block_x / 2, 0);
    const Pieces ways = {
        profile_along_y({{-half - ramp, -0.5}, {-half, low}, {-half, deck}, {-half - ramp, 0}}, -width, width),
        box_from({-half, -width, low}, {half, width, deck}),
        profile_along_y({{half, low}, {half + ramp, -0.5}, {half + ramp, 0}, {half, deck}}, -width, width)};
    add_thing(scene_, "bridge", Label::Terrain, ways, {{at.x(), at.y(), sheet}, Mat3::Identity()});
    for (const double y : {-width, width - 0.1})
        add("railing", {box_from({-half, y, deck - 0.1}, {half, y + 0.1, deck + 1})}, at, sheet);
    for (const double x : {-half + 0.5, half - 0.5})
        add("pier", {box_from({x - 0.3, -0.6, -1}, {x + 0.3, 0.6, low + 0.1})}, at, sheet);
}

/// Adds a lamp at a corner of a block. Lamps of higher numbers are at other corners.
void City::add_lamp(int number)
{
    const int block = number % (extents_.cols * extents_.rows), side = number / (extents_.cols * extents_.rows);
    const double x = (block_x - street) / 2 - 0.5, y = (block_y - street) / 2 - 0.5;
    const Pieces lamp = {box_from({-0.06, -0.06, -0.5}, {0.06, 0.06, 6}), box_from({-0.1, -0.1, 5.9}, {1.4, 0.1, 6.1})};
    add("lamp", lamp,
        centre_of(block % extents_.cols, block / extents_.cols) +
            Vec2(side % 2 == 0 ? x : -x, side / 2 % 2 == 0 ? -y : y),
        sheet + kerb, side % 2 == 0 ? 0 : std::numbers::pi);
}

Scene City::build()
{
    add_ground();
    const std::size_t ground_parts = scene_.parts.size();
    const int park_col = extents_.cols / 2, park_row = extents_.rows / 2;
    for (int row = 0; row < extents_.rows; ++row)
        for (int col = 0; col < extents_.cols; ++col) {
            if (col == park_col && row == park_row)
                add_car_park(centre_of(col, row));
            else
                add_block(centre_of(col, row));
        }
    for (int row = 0; row < extents_.rows; row += 3) add_bridge(centre_of(0, row));
    for (int number = 0; scene_.parts.size() - ground_parts < std::size_t(extents_.bodies); ++number) add_lamp(number);
    return std::move(scene_);
}

}  // namespace

Scene city_scene(std::uint64_t seed) { return City(seed, {500, 6, 5, 600}).build(); }

Scene small_city_scene(std::uint64_t seed) { return City(seed, {160, 2, 2, 85}).build(); }

}  // namespace bench
