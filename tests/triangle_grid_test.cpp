#include "geometry/triangle_grid.h"
#include "catch.h"
#include "column/columns.h"
#include "scene/elements.h"
#include "worlds/hand_scene.h"
#include "worlds/random.h"

#include <spawnfield/column.h>

#include <cstddef>

using namespace spawnfield;

namespace {

using Place = std::array<double, 2>;

/// A heightmap from above: cells of any size at any place, two triangles for each, in random order.
struct Relief {
    int cols, rows;
    Place low, cell;  ///< m
    bool is_rising;
    std::vector<TriangleFromAbove> triangles;
};

/// Returns a relief of at most 64 triangles. Each corner is moved by up to `shift` cells.
Relief random_relief(Random& random, double shift)
{
    Relief out;
    out.cols = 3 + random.below(4);
    out.rows = 3 + random.below(3);
    const double far = std::pow(10, random.between(0, 6.5));
    out.low = {random.between(-far, far), random.between(-far, far)};
    out.cell = {std::pow(10, random.between(-1, 2)), std::pow(10, random.between(-1, 2))};
    out.is_rising = random.chance(0.5);
    const auto corner = [&](int col, int row) -> Place {
        return {out.low[0] + (col + random.between(-shift, shift)) * out.cell[0],
                out.low[1] + (row + random.between(-shift, shift)) * out.cell[1]};
    };
    for (int row = 0; row < out.rows; ++row)
        for (int col = 0; col < out.cols; ++col) {
            const Place a = corner(col, row), b = corner(col + 1, row), c = corner(col + 1, row + 1),
                        d = corner(col, row + 1);
            if (out.is_rising)
                out.triangles.insert(out.triangles.end(), {{a, b, c}, {a, c, d}});
            else
                out.triangles.insert(out.triangles.end(), {{a, b, d}, {b, c, d}});
        }
    for (std::size_t k = out.triangles.size(); k > 1; --k)
        std::swap(out.triangles[k - 1], out.triangles[std::size_t(random.below(int(k)))]);
    for (TriangleFromAbove& corners : out.triangles)
        std::rotate(corners.begin(), corners.begin() + random.below(3), corners.end());
    return out;
}

TriangleGrid view(const GridBytes& grid) { return {grid.size, grid.bytes.data()}; }

std::uint32_t found_at(const TriangleGrid& grid, const Place& at)
{
    return grid.find(grid.along_x(at[0]), grid.along_y(at[1]));
}

/// Returns whether a place is in a triangle, exact but for the rounding of long doubles.
bool is_in(const TriangleFromAbove& corners, const Place& at)
{
    int left = 0, right = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const Place &p = corners[k], &q = corners[(k + 1) % 3];
        const auto from = [](double a, double b) { return static_cast<long double>(a) - b; };
        const long double cross = from(q[0], p[0]) * from(at[1], p[1]) - from(q[1], p[1]) * from(at[0], p[0]);
        (cross > 0 ? left : right) += 1;
    }
    return left == 3 || right == 3;
}

struct Answers {
    int wrong = 0, rim = 0, none = 0, inside = 0;
};

/// Compares what a grid answers at random places, some of them on edges, with a look at each of its triangles.
Answers answers_of(const GridBytes& grid, const Relief& relief, Random& random, double on_edge)
{
    Answers out;
    for (int k = 0; k < 500; ++k) {
        Place at{relief.low[0] + random.between(-0.5, relief.cols + 0.5) * relief.cell[0],
                 relief.low[1] + random.between(-0.5, relief.rows + 0.5) * relief.cell[1]};
        if (random.chance(on_edge)) {
            const TriangleFromAbove& corners =
                relief.triangles[std::size_t(random.below(int(relief.triangles.size())))];
            const double share = random.between(0, 1);
            for (std::size_t axis = 0; axis < 2; ++axis)
                at[axis] = corners[0][axis] + share * (corners[1][axis] - corners[0][axis]);
        }
        const std::uint32_t found = found_at(view(grid), at);
        out.rim += found == TriangleGrid::rim;
        out.none += found == TriangleGrid::none;
        out.inside += found < TriangleGrid::none;
        if (found == TriangleGrid::rim) continue;
        for (std::uint32_t t = 0; t < relief.triangles.size(); ++t)
            if ((view(grid).members() >> t & 1) != 0) out.wrong += is_in(relief.triangles[t], at) != (t == found);
    }
    return out;
}

Answers operator+(const Answers& a, const Answers& b)
{
    return {a.wrong + b.wrong, a.rim + b.rim, a.none + b.none, a.inside + b.inside};
}

int members(const GridBytes& grid) { return grid.size.exists() ? std::popcount(view(grid).members()) : 0; }

/// Returns how many columns of a block, and at a list of places, differ from those that are computed one by one.
int different_columns(const Scene& scene, double step, double shift, Surfaces surfaces = Surfaces::All)
{
    const Geometry geometry(scene);
    ColumnGrid grid{.x0 = scene.bounds().min.x() + shift, .y0 = scene.bounds().min.y() + shift, .step = step};
    grid.cols = grid.rows = int((scene.bounds().max.x() - scene.bounds().min.x()) / step) + 1;
    const Columns block(geometry, grid, surfaces);
    CHECK(block.are_dense());
    std::vector<Vec2> places;
    for (int j = 0; j < grid.rows; ++j)
        for (int i = 0; i < grid.cols; ++i) places.emplace_back(grid.x_of(i), grid.y_of(j));
    Columns listed;
    listed.set(geometry, places);
    std::vector<SurfaceHit> hits;
    int out = 0;
    for (int j = 0; j < grid.rows; ++j)
        for (int i = 0; i < grid.cols; ++i) {
            const auto differs = [](const ColumnView& a, const Column& b) {
                return !std::ranges::equal(a.layers, b.layers) || !std::ranges::equal(a.water, b.water) ||
                       !std::ranges::equal(a.spans, b.spans);
            };
            const double x = grid.x_of(i), y = grid.y_of(j);
            const Column alone = column_at(geometry, x, y);
            if (surfaces == Surfaces::All) out += differs(block.at(i, j), alone);
            find_hits(geometry, x, y, surfaces, hits);
            if (surfaces == Surfaces::Filled) out += hits.empty() != block.at(i, j).spans.empty();
            out += differs(listed.at(j * grid.cols + i, 0), alone);
        }
    return out;
}

/// A hilly ground of cells of 1 m, with boxes, a sheet of water and a second ground above a part of the first.
Scene hilly_scene(std::uint64_t seed)
{
    Random random(seed);
    Scene scene;
    const double a = random.between(0.2, 1), b = random.between(0.2, 1);
    const auto height = [&](double x, double y) { return std::sin(a * x) * std::cos(b * y); };
    hand::add_mesh(scene, Label::Terrain, hand::relief(24, 24, height));
    hand::add_mesh(scene, Label::Terrain,
                   hand::moved(hand::relief(8, 8, height), {{0, 0, random.between(0.5, 2)}, Mat3::Identity()}));
    hand::add_mesh(scene, Label::Water, hand::rectangle(30, 30));
    for (int k = random.below(30); k > 0; --k) {
        const Pose at{{random.between(-10, 10), random.between(-10, 10), random.between(-1, 1)}, Mat3::Identity()};
        hand::add_mesh(scene, random.chance(0.5) ? Label::Terrain : Label::Obstacle,
                       hand::moved(hand::box({random.between(0.2, 2), random.between(0.2, 2), 1}), at));
    }
    return scene;
}

int tiles_with_grids(const Geometry& geometry)
{
    int out = 0;
    geometry.impl().visit_tiles(Rect{-1e6, -1e6, 1e6, 1e6},
                                [&](const Tile& tile, const ElementBox&) { out += tile.has_grid(); });
    return out;
}

}  // namespace

TEST_CASE("a grid finds the triangle of a relief that contains a place, or says that the place is near an edge")
{
    Random random(1);
    Answers all, on_edges;
    for (int round = 0; round < 300; ++round) {
        const Relief relief = random_relief(random, 0);
        const GridBytes grid = triangle_grid_of(relief.triangles);
        REQUIRE(grid.size.exists());
        CHECK(grid.size.cols == relief.cols);
        CHECK(grid.size.rows == relief.rows);
        CHECK(grid.bytes.size() == grid.size.bytes());
        CHECK(members(grid) == int(relief.triangles.size()));
        all = all + answers_of(grid, relief, random, 0);
        on_edges = on_edges + answers_of(grid, relief, random, 1);
    }
    CHECK(all.wrong == 0);
    CHECK(all.inside > 90000);
    CHECK(all.none > 30000);
    CHECK(all.rim < 4500);  // 2 % to each edge and diagonal of a cell within 0.4 %
    CHECK(on_edges.wrong == 0);
    CHECK(on_edges.rim == 150000);
}

TEST_CASE("corners that lie nearly on the lines of a grid belong to it, others do not")
{
    Random random(2);
    Answers all;
    int moved = 0;
    for (int round = 0; round < 300; ++round) {
        const Relief relief = random_relief(random, 0.0003);  // the outermost corners give the grid its place
        const GridBytes grid = triangle_grid_of(relief.triangles);
        CHECK(members(grid) == int(relief.triangles.size()));
        all = all + answers_of(grid, relief, random, 0.5);
        const Relief rough = random_relief(random, 0.0009);
        const GridBytes some = triangle_grid_of(rough.triangles);
        moved += members(some) > 0 && members(some) < int(rough.triangles.size());
        if (some.size.exists()) all = all + answers_of(some, rough, random, 0.5);
    }
    CHECK(all.wrong == 0);
    CHECK(all.inside > 45000);
    CHECK(moved > 30);
}

TEST_CASE("triangles above others, of another size and with another diagonal are not in a grid")
{
    Random random(3);
    for (int round = 0; round < 50; ++round) {
        Relief relief = random_relief(random, 0);
        while (relief.triangles.size() < 20) relief = random_relief(random, 0);
        auto& triangles = relief.triangles;
        triangles.resize(20);
        const std::array<Place, 3> first = triangles[0];
        triangles.push_back(triangles[3]);
        triangles.push_back({{first[0], first[1], {first[2][0] + 0.3 * relief.cell[0], first[2][1]}}});
        Place missing;  // the fourth corner of the first triangle's cell
        for (std::size_t axis = 0; axis < 2; ++axis) {
            const double low = std::min({first[0][axis], first[1][axis], first[2][axis]}),
                         high = std::max({first[0][axis], first[1][axis], first[2][axis]});
            const auto count = std::count_if(first.begin(), first.end(),
                                             [&](const Place& p) { return p[axis] == low; });
            missing[axis] = count == 1 ? low : high;
        }
        // One of the two corners beside the diagonal is left out, so this is a half with the other diagonal.
        std::array<Place, 3> other = first;
        const auto is_beside = [&](const Place& p) { return p[0] == missing[0] || p[1] == missing[1]; };
        *std::ranges::find_if(other, is_beside) = missing;
        triangles.push_back(other);
        const GridBytes grid = triangle_grid_of(triangles);
        REQUIRE(grid.size.exists());
        CHECK(view(grid).members() == bits_between(0, 19));
    }
}

TEST_CASE("few triangles, large grids and cells of less than a millimetre make no grid")
{
    const auto row_of = [](int cells, double size) {
        std::vector<TriangleFromAbove> out;
        for (int k = 0; k < cells; ++k) {
            const double low = k * size, high = low + size;
            out.push_back({{{low, 0}, {high, 0}, {low, size}}});
            out.push_back({{{high, 0}, {high, size}, {low, size}}});
        }
        return out;
    };
    const auto exists = [](const std::vector<TriangleFromAbove>& triangles) {
        return triangle_grid_of(triangles).size.exists();
    };
    CHECK(exists(row_of(8, 1)));
    CHECK_FALSE(exists(row_of(7, 1)));
    CHECK(exists(row_of(16, 1)));
    CHECK_FALSE(exists(row_of(17, 1)));
    CHECK(exists(row_of(8, 0.00101)));
    CHECK_FALSE(exists(row_of(8, 0.00099)));
    CHECK_FALSE(exists({}));
    CHECK_FALSE(exists(std::vector<TriangleFromAbove>(64, TriangleFromAbove{})));
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    CHECK_FALSE(exists(std::vector<TriangleFromAbove>(64, {{{nan, nan}, {nan, 0}, {0, nan}}})));
}

TEST_CASE("columns of a hilly ground are those that are computed one by one, also on the lines of its grid")
{
    int different = 0;
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        const Scene scene = hilly_scene(seed);
        CHECK(tiles_with_grids(Geometry(scene)) >= 18);
        for (const double step : {2.0, 1.0, 0.5, 0.37, 0.2})
            for (const double shift : {0.0, 0.25, 0.5, 1e-9, 0.003}) different += different_columns(scene, step, shift);
    }
    CHECK(different == 0);
}

TEST_CASE("columns of a filled ground that are asked for without sheets have its triangles and no others")
{
    Scene scene;
    const auto height = [](double x, double y) { return 1 + 0.1 * x * y; };
    hand::add_mesh(scene, Label::Terrain, hand::relief(16, 8, height));
    CHECK(tiles_with_grids(Geometry(scene)) >= 4);
    CHECK(different_columns(scene, 0.31, 0.1, Surfaces::Filled) == 0);
    hand::add_mesh(scene, Label::Terrain, hand::relief(16, 8, height));
    scene.pieces[1].solid = true;
    CHECK(different_columns(scene, 0.31, 0.1, Surfaces::Filled) == 0);
    CHECK(different_columns(scene, 0.31, 0.1) == 0);
}

TEST_CASE("a grid whose numbers do not fit its tile is refused")
{
    const GridBytes good = [] {
        Random random(4);
        return triangle_grid_of(random_relief(random, 0).triangles);
    }();
    const auto triangles = std::uint32_t(members(good));
    const auto is_accepted = [&](const auto& change) {
        GridBytes grid = good;
        change(grid);
        return is_consistent_grid(grid.size, view(grid), triangles);
    };
    const std::size_t first = sizeof(TriangleGridHead), last = first + good.size.halves() - 1;
    CHECK(is_accepted([](GridBytes&) {}));
    CHECK(is_accepted([&](GridBytes& grid) { grid.bytes[last] = char(TriangleGrid::none); }));
    CHECK_FALSE(is_accepted([&](GridBytes& grid) { grid.bytes[first] = char(triangles); }));
    CHECK_FALSE(is_accepted([&](GridBytes& grid) { grid.bytes[last] = char(TriangleGrid::rim); }));
    CHECK_FALSE(is_accepted([&](GridBytes& grid) { grid.bytes[first - 1] = char(0xff); }));
    CHECK_FALSE(is_accepted([&](GridBytes& grid) {
        grid.size.cols = TriangleGridSize::most + 1;
        grid.bytes.resize(grid.size.bytes(), char(TriangleGrid::none));
    }));
}

TEST_CASE("a tile with a damaged grid is refused")
{
    Scene scene;
    hand::add_mesh(scene, Label::Terrain, hand::relief(5, 5, [](double, double) { return 0.0; }));
    std::vector<ElementBox> boxes;
    std::vector<std::uint32_t> elements(element_count(scene));
    for (std::uint32_t e = 0; e < elements.size(); ++e) {
        elements[e] = e;
        boxes.push_back(widened(element_bounds(scene, e)));
    }
    const std::string good = tile_of(scene, boxes, elements, {});
    REQUIRE(Tile(good).has_grid());
    const std::size_t first = sizeof(TileHead) + sizeof(TileBoxes) + sizeof(TriangleGridHead);
    const TileLimits limits{scene.parts.size(), scene.face_groups.size()};
    const auto is_accepted = [&](std::size_t place, char value) {
        std::string bytes = good;
        bytes[place] = value;
        return is_consistent_tile(bytes, limits);
    };
    const std::size_t cols = offsetof(TileHead, grid);
    CHECK(is_accepted(first, 49));
    CHECK_FALSE(is_accepted(first, 50));  // there are 50 triangles
    CHECK(is_accepted(cols, 5));
    CHECK_FALSE(is_accepted(cols, 0));  // the tile's bytes are more than its head says
    CHECK_FALSE(is_accepted(cols, 17));
}
