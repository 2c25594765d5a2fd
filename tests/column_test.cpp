#include "catch.h"
#include "column/columns.h"
#include "hard_scene.h"
#include "query/draw.h"
#include "test_map.h"
#include "worlds/hand_scene.h"
#include "worlds/random.h"

#include <numbers>

using namespace spawnfield;

namespace {

using Heights = std::vector<double>;

Shape box_at(const Vec3& size, const Vec3& centre)
{
    Shape shape;
    shape.size = size;
    shape.pose.position = centre;
    return shape;
}

Column column(const Scene& scene, double x, double y) { return column_at(Geometry(scene), x, y); }

std::optional<Ground> ground(const Scene& scene, const Vec3& p)
{
    return ground_below(column(scene, p.x(), p.y()), p.z());
}

bool is_same(const ColumnView& l, const ColumnView& r)
{
    return std::ranges::equal(l.layers, r.layers) && std::ranges::equal(l.water, r.water) &&
           std::ranges::equal(l.spans, r.spans);
}

/// Returns how many columns of a grid over the scene, computed as one block, differ from those of column_at.
int different_columns(const Scene& scene, int cols)
{
    const Geometry geometry(scene);
    const Bounds bounds = scene.bounds();
    const Vec3 size = bounds.max - bounds.min;
    ColumnGrid grid;
    grid.x0 = bounds.min.x() - 0.1;
    grid.y0 = bounds.min.y();
    grid.step = std::max(size.x(), size.y()) / (cols - 1);
    grid.cols = cols + 1;
    grid.rows = cols;
    const Columns block(geometry, grid);
    int out = 0;
    for (int j = 0; j < grid.rows; ++j)
        for (int i = 0; i < grid.cols; ++i)
            out += !is_same(block.at(i, j), column_at(geometry, grid.x_of(i), grid.y_of(j)));
    return out;
}

/// The same for random places, row by row, and for corners of triangles and places near them.
int different_columns_at_places(const Scene& scene, std::uint64_t seed)
{
    const Geometry geometry(scene);
    const Bounds bounds = scene.bounds();
    Draw draw(seed, 0);
    std::vector<Vec2> places;
    for (int row = 0; row < 20; ++row) {
        const double y = draw.uniform(bounds.min.y(), bounds.max.y());
        for (int k = 0; k < 40; ++k)
            places.emplace_back(draw.uniform(bounds.min.x() - 0.1, bounds.max.x()), y + draw.uniform(0, 0.1));
    }
    for (const Vec3& vertex : scene.vertices) {
        if (draw.unit() < 0.1) places.push_back(vertex.head<2>());
        places.emplace_back(vertex.x() + draw.uniform(-0.3, 0.3), vertex.y() + draw.uniform(-0.3, 0.3));
    }
    Columns columns;
    columns.set(geometry, std::span<const Vec2>());
    columns.set(geometry, places);
    int out = 0;
    for (std::size_t k = 0; k < places.size(); ++k)
        out += !is_same(columns.at(int(k), 0), column_at(geometry, places[k].x(), places[k].y()));
    return out;
}

/// Returns the scene in UTM coordinates, on a plane of two triangles with sides of 3 km. Their tile has small
/// triangles, too.
Scene far_away(Scene scene)
{
    hand::add_mesh(scene, Label::Terrain, hand::moved(hand::rectangle(3000, 3000), {{0, 0, -1}, Mat3::Identity()}));
    const Vec3 shift(512345.678, 4123456.789, 0);
    for (Vec3& vertex : scene.vertices) vertex += shift;
    for (Primitive& primitive : scene.primitives) primitive.shape.pose.position += shift;
    return scene;
}

/// Returns the scene with all lengths multiplied: few triangles in several square kilometres.
Scene enlarged(Scene scene)
{
    constexpr double factor = 300;
    for (Vec3& vertex : scene.vertices) vertex *= factor;
    for (Primitive& primitive : scene.primitives) {
        primitive.shape.pose.position *= factor;
        primitive.shape.size *= factor;
    }
    return scene;
}

}  // namespace

TEST_CASE("four lines and triangles that are compared at once: what is not at the rim is true")
{
    constexpr int rounds = 100000;
    constexpr std::size_t width = FourPairs::width;
    int wrong = 0, at_rim = 0;
    for (int round = 0; round < rounds; ++round) {
        Draw draw(round, 5);
        const Vec2 size(std::pow(10, draw.uniform(-2, 4)), std::pow(10, draw.uniform(-2, 4)));
        const double far = std::pow(10, draw.uniform(0, 7)), share = std::pow(10, draw.uniform(-3, 0));
        const Vec2 corner(draw.uniform(-far, far), draw.uniform(-far, far));
        const auto in_box = [&](double part) {  // near the first corner of the box if `part` is small
            return Vec2(corner + part * Vec2(draw.unit() * size.x(), draw.unit() * size.y()));
        };
        std::array<std::array<Vec3, 3>, width> triangles;
        std::array<Vec2, width> lines;
        FourPairs four;
        for (std::size_t k = 0; k < width; ++k) {
            for (Vec3& vertex : triangles[k]) vertex << in_box(share), 0;
            const Vec3 on_edge = triangles[k][0] + draw.unit() * (triangles[k][1] - triangles[k][0]);
            lines[k] = draw.unit() < 0.5 ? in_box(share) : Vec2(on_edge.head<2>());
            four.lines[k] = lines[k].data();
            four.corners[k] = {&triangles[k][0], &triangles[k][1], &triangles[k][2]};
        }
        const auto [inside, rim] = four.sides(FourPairs::rim_in(size.x(), size.y()));
        for (std::size_t k = 0; k < width; ++k) {
            std::array<long double, 3> cross;
            for (std::size_t c = 0; c < 3; ++c) {
                const Vec3 &a = triangles[k][c], &b = triangles[k][(c + 1) % 3];
                const auto from_line = [&](const Vec3& vertex, int axis) {
                    return static_cast<long double>(vertex[axis]) - lines[k][axis];
                };
                cross[c] = from_line(a, 0) * from_line(b, 1) - from_line(a, 1) * from_line(b, 0);
            }
            const auto [low, high] = std::ranges::minmax(cross);
            const bool is_inside = low > 0 || high < 0, is_outside = low < 0 && high > 0;
            const bool says_inside = (inside >> k & 1) != 0, says_rim = (rim >> k & 1) != 0;
            wrong += (says_inside && (says_rim || !is_inside)) || (!says_inside && !says_rim && !is_outside);
            at_rim += says_rim;
        }
    }
    CHECK(wrong == 0);
    CHECK(at_rim > rounds);  // about half of the lines are on an edge, and many triangles are small in their box
    CHECK(at_rim < 3 * rounds);
}

TEST_CASE("the columns at a list of places are those that are computed one by one")
{
    int different = 0;
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
        different += different_columns_at_places(random_scene(seed), seed);
        different += different_columns_at_places(hard_case(seed).scene, seed);
        different += different_columns_at_places(far_away(random_scene(seed)), seed);
        different += different_columns_at_places(enlarged(random_scene(seed)), seed);
    }
    CHECK(different == 0);
}

TEST_CASE("the columns of a block are those that are computed one by one")
{
    int different = 0;
    for (std::uint64_t seed = 0; seed < 60; ++seed)
        for (const int cols : {3, 40, 97}) {
            different += different_columns(random_scene(seed), cols);
            different += different_columns(hard_case(seed).scene, cols);
            different += different_columns(far_away(random_scene(seed)), cols);
        }
    CHECK(different == 0);

    // A sheet of water in a filled mesh, which is the first piece of the scene.
    Scene scene;
    hand::add_mesh(scene, Label::Terrain, hand::box({4, 4, 2}));
    hand::add_mesh(scene, Label::Water, hand::moved(hand::rectangle(3, 3), {{0, 0, 1.5}, Mat3::Identity()}));
    hand::add_mesh(scene, Label::Terrain, hand::moved(hand::rectangle(3, 3), {{0, 0, 0.5}, Mat3::Identity()}));
    CHECK(different_columns(scene, 20) == 0);
    CHECK(column(scene, 0.2, 0.3).water == Heights{1.5});
}

TEST_CASE("columns that all meet the box of each triangle of a full tile are those that are computed one by one")
{
    Scene scene;  // 64 triangles, which fill a tile
    for (int k = 0; k < 32; ++k)
        hand::add_mesh(scene, Label::Terrain, hand::moved(hand::rectangle(4, 4), {{0, 0, 0.5 * k}, Mat3::Identity()}));
    CHECK(column(scene, 0.3, 0.2).layers.size() == 32);
    for (const int cols : {7, 8, 9}) CHECK(different_columns(scene, cols) == 0);
    CHECK(different_columns_at_places(scene, 1) == 0);
}

TEST_CASE("neighbouring columns of level surfaces, which are often the same, are those that are computed one by one")
{
    Random random(11);
    const auto in_tenths = [&](int low, int high) { return 0.1 * (low + random.below(high - low + 1)); };
    int different = 0;
    for (int round = 0; round < 40; ++round) {
        Scene scene;
        hand::add_mesh(scene, Label::Terrain, hand::relief(4, 6, [&](double x, double) {
                           return round % 2 == 0 ? 0.05 : 0.03 * x;  // else no two columns are the same
                       }));
        for (int k = 3 + random.below(20); k > 0; --k) {
            const Pose at{{in_tenths(-25, 25), in_tenths(-25, 25), in_tenths(-5, 20)}, Mat3::Identity()};
            const double size_x = in_tenths(2, 30), size_y = in_tenths(2, 30);
            const Label label = random.chance(0.5) ? Label::Terrain : Label::Obstacle;
            if (random.chance(0.6))
                hand::add_mesh(scene, label, hand::moved(hand::box({size_x, size_y, in_tenths(1, 5)}), at));
            else
                hand::add_mesh(scene, random.chance(0.3) ? Label::Water : label,
                               hand::moved(hand::rectangle(size_x, size_y), at));
        }
        for (const int cols : {31, 61, 100}) different += different_columns(scene, cols);
    }
    CHECK(different == 0);
}

TEST_CASE("blocks in the same memory are those in fresh memory, also after 65,536 of them")
{
    const Geometry geometry(hard_case(3).scene);
    const Bounds bounds = geometry.bounds();
    Columns columns;
    ColumnGrid grid{.x0 = bounds.min.x(), .y0 = bounds.min.y(), .step = 0.1};
    int different = 0, filled = 0;
    for (int n = 0; n < 66000; ++n) {
        const bool is_compared = n < 40 || n > 65500;
        grid.cols = is_compared ? 1 + n % 13 : 1;
        grid.rows = is_compared ? 1 + n % 7 : 1;
        grid.first_col = n % 50;
        columns.set(geometry, grid);
        if (!is_compared) continue;
        for (int j = 0; j < grid.rows; ++j)
            for (int i = 0; i < grid.cols; ++i) {
                const Column alone = column_at(geometry, grid.x_of(grid.first_col + i), grid.y_of(j));
                different += !is_same(columns.at(i, j), alone);
                filled += !alone.spans.empty();
            }
    }
    CHECK(different == 0);
    CHECK(filled > 1000);
}

TEST_CASE("a bridge has a layer on it and one under it")
{
    Scene scene;
    hand::add_shape(scene, Label::Terrain, box_at({10, 10, 1}, {0, 0, -0.5}));
    hand::add_shape(scene, Label::Terrain, box_at({4, 2, 0.5}, {0, 0, 3.25}));
    CHECK(column(scene, 0, 0).layers == Heights{3.5, 0});
    CHECK(column(scene, 0, 3).layers == Heights{0});
    CHECK(column(scene, 20, 0).layers.empty());
}

TEST_CASE("a line along the edge of a box belongs to the box, both for a primitive and for a mesh")
{
    Scene primitive, mesh;
    hand::add_shape(primitive, Label::Terrain, box_at({2, 4, 1}, {0.1, 0.2, 0.3}));
    hand::add_mesh(mesh, Label::Terrain, hand::moved(hand::box({2, 4, 1}), {{0.1, 0.2, 0.3}, Mat3::Identity()}));
    for (const double x : {-0.9, -0.3, 0.1, 1.1})
        for (const double y : {-1.8, 0.0, 0.2, 2.2}) {
            CAPTURE(x, y);
            REQUIRE(column(primitive, x, y).spans.size() == 1);
            REQUIRE(column(mesh, x, y).spans.size() == 1);
            CHECK(column(primitive, x, y).spans[0].top == Approx(0.8).margin(1e-12));
            CHECK(column(mesh, x, y).spans[0].top == Approx(0.8).margin(1e-12));
            CHECK(column(mesh, x, y).spans[0].bottom == Approx(-0.2).margin(1e-12));
        }
    CHECK(column(primitive, 1.1 + 1e-6, 0).spans.empty());
    CHECK(column(mesh, 1.1 + 1e-6, 0).spans.empty());
}

TEST_CASE("a closed piece within another makes no cavity, and both have an upper end")
{
    Scene scene;
    hand::add_mesh(scene, Label::Terrain, hand::box({4, 4, 4}));
    hand::add_piece(scene, hand::flipped(hand::box({2, 2, 2})));
    const Column inside = column(scene, 0.3, 0.1);
    CHECK(inside.layers == Heights{2});
    REQUIRE(inside.spans.size() == 2);
    CHECK(inside.spans[1].top == 1);
    CHECK(ground(scene, {0.3, 0.1, 1.5})->height == 1);
}

TEST_CASE("intervals of stacked and sunken terrain are joined")
{
    Scene scene;
    hand::add_shape(scene, Label::Terrain, box_at({4, 4, 1}, {0, 0, 0.5}));
    hand::add_shape(scene, Label::Terrain, box_at({2, 2, 1}, {0, 0, 1.5}));         // stands on it
    hand::add_shape(scene, Label::Terrain, box_at({1, 1, 0.5}, {1.5, 1.5, 0.5}));   // is sunk into it
    hand::add_shape(scene, Label::Obstacle, box_at({1, 1, 1}, {-1.5, -1.5, 1.5}));  // stands on it, too
    CHECK(column(scene, 0, 0).layers == Heights{2});
    CHECK(column(scene, 1.5, 1.5).layers == Heights{1});
    CHECK(column(scene, -1.6, -1.6).layers == Heights{1});  // under the obstacle
    CHECK(ground(scene, {0, 0, 1.2})->height == 1);         // the ground belongs to a single piece
    CHECK_FALSE(ground(scene, {-1.6, -1.6, 2.5})->terrain);
    CHECK_FALSE(ground(scene, {1.5, 1.5, 0.2}));  // inside the hill there is no ground
}

TEST_CASE("the layers of random stacks of boxes are the upper ends of terrain that is joined pair by pair")
{
    Random random(3);
    constexpr std::array gaps{0.0, 0.4 * layer_tolerance, 3 * layer_tolerance};
    std::size_t joined = 0;
    for (int round = 0; round < 500; ++round) {
        CAPTURE(round);
        Scene scene;
        for (int box = random.below(6); box >= 0; --box) {
            const double bottom = random.below(9), height = 1 + random.below(4) - gaps[std::size_t(random.below(3))];
            hand::add_shape(scene, random.chance(0.25) ? Label::Obstacle : Label::Terrain,
                            box_at({1, 1, height}, {0, 0, bottom + height / 2}));
        }
        const Column found = column(scene, 0, 0);
        std::vector<Span> terrain = found.spans;
        std::erase_if(terrain, [](const Span& span) { return !span.terrain; });
        const std::size_t before = terrain.size();
        for (std::size_t i = 0; i < terrain.size();) {
            const auto is_near = [&](const Span& span) {
                return &span != &terrain[i] && span.bottom <= terrain[i].top + layer_tolerance &&
                       terrain[i].bottom <= span.top + layer_tolerance;
            };
            const auto other = std::ranges::find_if(terrain, is_near);
            if (other == terrain.end()) {
                ++i;
                continue;
            }
            terrain[i].bottom = std::min(terrain[i].bottom, other->bottom);
            terrain[i].top = std::max(terrain[i].top, other->top);
            terrain.erase(other);
            i = 0;
        }
        joined += before - terrain.size();
        Heights layers;
        for (const Span& span : terrain) layers.push_back(span.top);
        std::ranges::sort(layers, std::greater<>());
        CHECK(found.layers == layers);
    }
    CHECK(joined > 500);
}

TEST_CASE("terrain wins over an obstacle at the same height")
{
    Scene scene;
    hand::add_shape(scene, Label::Obstacle, box_at({2, 2, 1}, {0, 0, 0.5}));
    hand::add_mesh(scene, Label::Terrain, hand::moved(hand::rectangle(2, 2), {{0, 0, 1 - 5e-10}, Mat3::Identity()}));
    CHECK(ground(scene, {0, 0.1, 1})->terrain);
    CHECK(ground(scene, {0, 0.1, 1})->part == 1);
}

TEST_CASE("each crossing of a sheet is a layer, unless only its upper side counts")
{
    for (const bool up : {false, true}) {
        Scene scene;
        const hand::Mesh sheet = hand::rectangle(4, 4);
        hand::add_mesh(scene, Label::Terrain, sheet, {.fill = false, .sides_up = up});
        hand::add_mesh(scene, Label::Terrain, hand::moved(hand::flipped(sheet), {{0, 0, 2}, Mat3::Identity()}),
                       {.fill = false, .sides_up = up});
        CAPTURE(up);
        CHECK(column(scene, 0.5, 0.3).layers == (up ? Heights{0} : Heights{2, 0}));
        CHECK(ground(scene, {0.5, 0.3, 2.5})->height == 2);
        CHECK(ground(scene, {0.5, 0.3, 2.5})->terrain == !up);
    }
}

TEST_CASE("a line through a common edge or corner of a sheet gives one layer")
{
    Scene scene;
    hand::add_mesh(scene, Label::Terrain, hand::relief(8, 8, [](double x, double y) { return 0.25 * x + 0.5 * y; }));
    for (const auto& [x, y] :
         {std::pair{0.0, 0.0}, std::pair{0.5, 0.0}, std::pair{0.5, -0.5}, std::pair{-4.0, 4.0}, std::pair{0.5, 0.5}}) {
        CAPTURE(x, y);
        REQUIRE(column(scene, x, y).layers.size() == 1);
        CHECK(column(scene, x, y).layers[0] == Approx(0.25 * x + 0.5 * y).margin(1e-12));
    }
}

TEST_CASE("columns through round bodies end where the equations of the bodies end")
{
    Scene scene;
    Shape ball;
    ball.kind = ShapeKind::Sphere;
    ball.size[0] = 3;
    ball.pose.position = {1, 2, -1};
    hand::add_shape(scene, Label::Terrain, ball);
    Shape lying;  // a cylinder along y
    lying.kind = ShapeKind::Cylinder;
    lying.size = {0.5, 4, 0};
    lying.pose = {{10, 0, 0}, rotation_from_rpy(std::numbers::pi / 2, 0, 0)};
    hand::add_shape(scene, Label::Terrain, lying);
    Shape standing = lying;
    standing.kind = ShapeKind::Capsule;
    standing.pose = {{20, 0, 0}, Mat3::Identity()};
    hand::add_shape(scene, Label::Terrain, standing);
    for (const double d : {0.0, 0.7, 2.9})
        CHECK(column(scene, 1 + d, 2).layers[0] == Approx(-1 + std::sqrt(9 - d * d)));
    CHECK(column(scene, 4.01, 2).layers.empty());
    for (const double d : {0.0, 0.3, 0.49}) {
        CHECK(column(scene, 10 + d, 1.9).layers[0] == Approx(std::sqrt(0.25 - d * d)));
        CHECK(column(scene, 20 + d, 0).layers[0] == Approx(2 + std::sqrt(0.25 - d * d)));
    }
    CHECK(column(scene, 10, 2.1).layers.empty());
}

TEST_CASE("water surfaces are the crossings of a sheet and the top of a solid, and water collides with nothing")
{
    Scene scene;
    hand::add_shape(scene, Label::Terrain, box_at({10, 10, 1}, {0, 0, -0.5}));
    hand::add_mesh(scene, Label::Water, hand::moved(hand::rectangle(4, 4), {{0, 0, 0.4}, Mat3::Identity()}));
    hand::add_shape(scene, Label::Water, box_at({1, 1, 3}, {0, 0, 1.5}));
    CHECK(column(scene, 0.2, 0.2).water == Heights{3, 0.4});
    CHECK(column(scene, 1.5, 1.4).water == Heights{0.4});
    const TestMap map = map_of(scene);
    const Robot robot = load_robot("box:0.3,0.3,0.3");
    const Judge judge(map, robot);
    const Pose pose{{1.5, 1.4, 0.3}, Mat3::Identity()};
    CHECK(checker_of(map, robot).is_free(pose));
    CHECK(judge.check(pose).verdict == Verdict::Submerged);
    CHECK(Judge(map, robot, {.max_water_depth = 0.3}).check(pose).verdict == Verdict::Valid);
    CHECK(Judge(map, robot, {.max_water_depth = 0.4}).check(pose).verdict == Verdict::Submerged);
}

TEST_CASE("a mesh that is filled on request is solid below its lowest crossing")
{
    Scene scene;  // a box without its bottom
    const hand::Mesh open = hand::without(hand::box({2, 2, 2}), 8, 1);
    hand::add_mesh(scene, Label::Obstacle, open);
    scene.pieces[0].solid = true;
    for (const double x : {-0.7, 0.1, 0.6}) {
        REQUIRE(column(scene, x, 0.2).spans.size() == 1);
        CHECK(column(scene, x, 0.2).spans[0].bottom == -1);
        CHECK(column(scene, x, 0.2).spans[0].top == 1);
    }
}
