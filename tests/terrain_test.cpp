#include "catch.h"
#include "test_map.h"
#include "worlds/hand_scene.h"

#include <spawnfield/error.h>

using namespace spawnfield;

namespace {

TerrainMap rasterized(const Map& map, double cell, int threads = 0)
{
    return rasterize_terrain(map.geometry, frame_around(map.bounds, cell), threads);
}

std::vector<HeightImage> images(const TerrainMap& terrain, const std::string& name)
{
    std::vector<HeightImage> out;
    while (terrain.find(name + "." + std::to_string(out.size())))
        out.push_back(page_image(terrain, name + "." + std::to_string(out.size())));
    return out;
}

}  // namespace

TEST_CASE("pages have the layers and the water of the column at the centre of each cell, with row 0 at the largest y")
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
                if (k < column.layers.size())
                    CHECK(heights[k](row, col) == float(column.layers[k]));
                else
                    CHECK(std::isnan(heights[k](row, col)));
            }
            CHECK(std::isnan(water(row, col)) == column.water.empty());
        }
    CHECK(terrain.frame.y_of(0) > terrain.frame.y_of(1));
    CHECK(std::isnan(page_image(terrain, "no such page")(0, 0)));
}

TEST_CASE("a ball has the heights of its equation")
{
    Scene scene;
    Shape ball;
    ball.kind = ShapeKind::Sphere;
    ball.size[0] = 3;
    hand::add_shape(scene, Label::Terrain, ball);
    const TestMap map = map_of(scene);
    const TerrainMap terrain = rasterized(map, 0.1);
    const HeightImage top = page_image(terrain, "height.0");
    for (int row = 0; row < terrain.frame.rows; ++row)
        for (int col = 0; col < terrain.frame.cols; ++col) {
            const double x = terrain.frame.x_of(col), y = terrain.frame.y_of(row), rest = 9 - x * x - y * y;
            if (rest > 0)
                CHECK(top(row, col) == Approx(std::sqrt(rest)).margin(1e-6));
            else
                CHECK(std::isnan(top(row, col)));
        }
}

TEST_CASE("the page of obstacles has the highest solid of a column that is not terrain")
{
    std::size_t obstacles = 0;
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        const TestMap map = map_of(random_scene(seed));
        const TerrainMap terrain = rasterized(map, 0.3);
        const HeightImage obstacle = page_image(terrain, "obstacle");
        for (int row = 0; row < terrain.frame.rows; row += 3)
            for (int col = 0; col < terrain.frame.cols; col += 2) {
                const Column column = column_at(map.geometry, terrain.frame.x_of(col), terrain.frame.y_of(row));
                const bool wanted = !column.spans.empty() &&
                                    (column.layers.empty() || column.spans[0].top > column.layers[0]);
                CHECK(std::isnan(obstacle(row, col)) != wanted);
                if (wanted) CHECK(obstacle(row, col) == float(column.spans[0].top));
                obstacles += wanted;
            }
    }
    CHECK(obstacles > 100);
}

TEST_CASE("there is no empty page, except the first page of heights")
{
    const auto pages_of = [](Label label) {
        Scene scene;
        hand::add_mesh(scene, label, hand::rectangle(4, 4));
        std::vector<std::string> names;
        for (const TerrainMap::Page& page : rasterized(map_of(scene), 0.5).pages) names.push_back(page.name);
        return names;
    };
    CHECK(pages_of(Label::Terrain) == std::vector<std::string>{"height.0"});
    CHECK(pages_of(Label::Water) == std::vector<std::string>{"height.0", "water"});
    CHECK(pages_of(Label::Obstacle) == std::vector<std::string>{"height.0", "obstacle"});
}

TEST_CASE("terrain pages are the same bytes with any number of threads")
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

TEST_CASE("a frame refuses cells of size 0 and too many columns")
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
