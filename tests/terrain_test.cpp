#include "catch.h"
#include "hand_scene.h"
#include "slow.h"
#include "test_map.h"

#include <spawnfield/error.h>

using namespace spawnfield;

namespace {

TerrainMap rasterized(const Map& map, double cell, int threads = 0)
{
    return rasterize_terrain(map.geometry, frame_around(map.bounds, cell), threads);
}

/// Whether z lies in one of a cell's intervals.
bool in_bounds(const std::vector<HeightImage>& tops, const std::vector<HeightImage>& bottoms, int row, int col, double z)
{
    for (std::size_t k = 0; k < tops.size(); ++k)
        if (z <= double(tops[k](row, col)) + 1e-12 && z >= double(bottoms[k](row, col)) - 1e-12) return true;
    return false;
}

std::vector<HeightImage> images(const TerrainMap& terrain, const std::string& name)
{
    std::vector<HeightImage> out;
    while (terrain.find(name + "." + std::to_string(out.size()))) out.push_back(page_image(terrain, name + "." + std::to_string(out.size())));
    return out;
}

}  // namespace

TEST_CASE("pages hold the layers and the water of the column at each cell's centre, row 0 the largest y")
{
    const TestMap map = training_map();
    const TerrainMap terrain = rasterized(map, 0.25);
    const auto heights = images(terrain, "height");
    const HeightImage water = page_image(terrain, "water");
    REQUIRE(heights.size() == 2);
    for (int row = 0; row < terrain.frame.rows; ++row)
        for (int col = 0; col < terrain.frame.cols; ++col) {
            const Column column = column_at(map.geometry, terrain.frame.x_of(col), terrain.frame.y_of(row));
            for (std::size_t k = 0; k < heights.size(); ++k) {
                if (k < column.layers.size()) CHECK(heights[k](row, col) == float(column.layers[k]));
                else CHECK(std::isnan(heights[k](row, col)));
            }
            CHECK(std::isnan(water(row, col)) == column.water.empty());
        }
    CHECK(terrain.frame.y_of(0) > terrain.frame.y_of(1));
    CHECK(std::isnan(page_image(terrain, "no such page")(0, 0)));
}

TEST_CASE("a ball is as high as its equation says")
{
    Scene scene;
    Shape ball;
    ball.kind = ShapeKind::Sphere;
    ball.size[0] = 3;
    hand::add_shape(scene, Label::Terrain, ball);
    const TestMap map = map_of(scene);
    const TerrainMap terrain = rasterized(map, 0.1);
    const HeightImage top = page_image(terrain, "height.0"), bound = page_image(terrain, "bound_top.0");
    for (int row = 0; row < terrain.frame.rows; ++row)
        for (int col = 0; col < terrain.frame.cols; ++col) {
            const double x = terrain.frame.x_of(col), y = terrain.frame.y_of(row), rest = 9 - x * x - y * y;
            if (rest > 0) CHECK(top(row, col) == Approx(std::sqrt(rest)).margin(1e-6));
            else CHECK(std::isnan(top(row, col)));
            const double nx = std::max(0.0, std::abs(x) - 0.05), ny = std::max(0.0, std::abs(y) - 0.05), nearest = 9 - nx * nx - ny * ny;
            if (nearest > 1e-3) CHECK(bound(row, col) == Approx(std::sqrt(nearest)).margin(1e-5));
        }
}

TEST_CASE("bounds hold all that is solid anywhere in a cell, and solid pages only what is solid at its centre")
{
    std::size_t solid_points = 0;
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
        const TestMap map = map_of(random_scene(seed));
        Random random(seed + 100);
        const TerrainMap terrain = rasterized(map, random.between(0.05, 0.6));
        const auto tops = images(terrain, "bound_top"), bottoms = images(terrain, "bound_bottom");
        const auto solid_tops = images(terrain, "solid_top");
        for (int i = 0; i < 400; ++i) {
            const int row = random.below(terrain.frame.rows), col = random.below(terrain.frame.cols);
            const double x = terrain.frame.x_of(col) + random.between(-0.5, 0.5) * terrain.frame.cell;
            const double y = terrain.frame.y_of(row) + random.between(-0.5, 0.5) * terrain.frame.cell;
            for (const slow::Span& span : slow::column(map.scene, x, y).spans) {
                CAPTURE(seed, row, col, x, y, span.bottom, span.top);
                CHECK(in_bounds(tops, bottoms, row, col, span.top));
                CHECK(in_bounds(tops, bottoms, row, col, (span.bottom + span.top) / 2));
                ++solid_points;
            }
            if (!solid_tops.empty() && !std::isnan(solid_tops[0](row, col))) {
                double highest = -1e9;
                for (const Span& span : column_at(map.geometry, terrain.frame.x_of(col), terrain.frame.y_of(row)).spans)
                    highest = std::max(highest, span.top);
                CHECK(solid_tops[0](row, col) == float(highest));
            }
        }
    }
    CHECK(solid_points > 10000);
}

TEST_CASE("bounds say nothing of cells that hold nothing")
{
    Scene scene;
    hand::add_mesh(scene, Label::Terrain, hand::rectangle(4, 4));
    TestMap map = map_of(scene);
    map.bounds = {Vec3(-4, -4, 0), Vec3(4, 4, 1)};
    const TerrainMap terrain = rasterized(map, 0.5);
    const HeightImage bound = page_image(terrain, "bound_top.0");
    for (int row = 0; row < 16; ++row)
        for (int col = 0; col < 16; ++col) {
            const bool near = std::abs(terrain.frame.x_of(col)) < 2.3 && std::abs(terrain.frame.y_of(row)) < 2.3;  // a touching cell holds the edge
            CHECK(std::isnan(bound(row, col)) == !near);
        }
}

TEST_CASE("terrain pages are the same bytes at any thread count")
{
    const TestMap map = map_of(random_scene(9));
    const TerrainMap one = rasterized(map, 0.02, 1);
    for (const int threads : {2, 8}) {
        const TerrainMap other = rasterized(map, 0.02, threads);
        REQUIRE(other.pages.size() == one.pages.size());
        for (std::size_t p = 0; p < one.pages.size(); ++p) {
            CHECK(other.pages[p].name == one.pages[p].name);
            CHECK(other.pages[p].tiles == one.pages[p].tiles);
        }
    }
}

TEST_CASE("a frame refuses cells of no size and too many columns")
{
    const Bounds bounds{Vec3(0, 0, 0), Vec3(2000, 2000, 1)};
    CHECK_THROWS_WITH(frame_around(bounds, 0), "frame_around: cell is 0, needs > 0 m");
    CHECK_THROWS_WITH(frame_around(bounds, 0.1), Contains("columns at a cell of 0.1 m is 4e+08, needs at most 1e+08"));
    const GridFrame frame = frame_around({Vec3(1, 2, 0), Vec3(4.05, 3, 0)}, 0.1);
    CHECK(frame.cols == 31);
    CHECK(frame.rows == 10);
    CHECK(frame.x_of(0) == Approx(1.05));
    CHECK(frame.y_of(9) == Approx(2.05));
}
