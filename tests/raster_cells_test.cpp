#include "arena.h"
#include "catch.h"
#include "shared_scenes.h"
#include "test_map.h"
#include "worlds/hand_scene.h"

#include <spawnfield/error.h>
#include <spawnfield/raster_cells.h>

#include <map>
#include <numeric>
#include <set>
#include <sstream>
#include <tuple>

using namespace spawnfield;

namespace {

/// What a cell says about each pose in it.
struct Said {
    std::int32_t layer;
    Verdict verdict;
    std::uint64_t valid_headings;

    bool operator==(const Said&) const = default;
};

/// What is known about the poses of each column (col, row), from the top down.
using Poses = std::map<std::pair<int, int>, std::vector<Said>>;

Said said(const RasterResult& raster, std::size_t pose)
{
    return {raster.poses[pose].layer, raster.poses[pose].verdict,
            raster.rests.empty() ? 0 : raster.rests[pose].valid_headings};
}

std::pair<int, int> place_of(const RasterResult& raster, std::size_t pose)
{
    const RasterGrid& grid = raster.grid;
    const RasterPose& at = raster.poses[pose];
    return {int(std::lround((at.x - grid.x0) / grid.step)), int(std::lround((at.y - grid.y0) / grid.step))};
}

Poses poses_of(const RasterResult& raster)
{
    Poses out;
    for (std::size_t p = 0; p < raster.poses.size(); ++p) out[place_of(raster, p)].push_back(said(raster, p));
    return out;
}

/// Expands the cells to the poses of all their columns.
Poses expanded(const RasterResult& raster, const std::vector<RasterCell>& cells)
{
    Poses out;
    for (const RasterCell& cell : cells)
        for (int row = cell.row; row < cell.row + cell.side; ++row)
            for (int col = cell.col; col < cell.col + cell.side; ++col)
                out[{col, row}].push_back(said(raster, cell.pose));
    return out;
}

/// The definition: returns the first column, first row and side of the squares into which this square is divided.
void divide(const Poses& poses, const RasterGrid& grid, int col, int row, int side,
            std::set<std::tuple<int, int, int>>& out)
{
    const auto at = [&](int c, int r) {
        const auto found = poses.find({c, r});
        return found == poses.end() ? std::vector<Said>() : found->second;
    };
    if (col >= grid.cols || row >= grid.rows) return;
    bool is_equal = col + side <= grid.cols && row + side <= grid.rows;
    for (int r = row; r < row + side && is_equal; ++r)
        for (int c = col; c < col + side && is_equal; ++c) is_equal = at(c, r) == at(col, row);
    if (is_equal) {
        if (!at(col, row).empty()) out.insert({col, row, side});
        return;
    }
    for (int j = 0; j < 2; ++j)
        for (int i = 0; i < 2; ++i) divide(poses, grid, col + i * side / 2, row + j * side / 2, side / 2, out);
}

std::set<std::tuple<int, int, int>> divided(const RasterResult& raster)
{
    int side = 1;
    while (side < std::max(raster.grid.cols, raster.grid.rows)) side *= 2;
    std::set<std::tuple<int, int, int>> out;
    divide(poses_of(raster), raster.grid, 0, 0, side, out);
    return out;
}

/// Checks all that cells promise.
void check_cells(const RasterResult& raster)
{
    const std::vector<RasterCell> cells = raster_cells(raster);
    CHECK(expanded(raster, cells) == poses_of(raster));
    std::set<std::tuple<int, int, int>> squares;
    for (std::size_t i = 0; i < cells.size(); ++i) {
        const RasterCell& cell = cells[i];
        squares.insert({cell.col, cell.row, cell.side});
        CHECK(place_of(raster, cell.pose) == std::pair(cell.col + cell.side / 2, cell.row + cell.side / 2));
        if (i > 0) CHECK(cells[i - 1].pose < cell.pose);
        double low = raster.poses[cell.pose].z, high = low;
        for (std::size_t p = 0; p < raster.poses.size(); ++p) {
            const auto [col, row] = place_of(raster, p);
            if (col < cell.col || col >= cell.col + cell.side || row < cell.row || row >= cell.row + cell.side ||
                raster.poses[p].layer != raster.poses[cell.pose].layer)
                continue;
            low = std::min(low, raster.poses[p].z);
            high = std::max(high, raster.poses[p].z);
        }
        CHECK(cell.low == low);
        CHECK(cell.high == high);
    }
    CHECK(squares == divided(raster));
}

std::size_t columns_in(const std::vector<RasterCell>& cells, const RasterResult& raster, Verdict verdict)
{
    return std::accumulate(cells.begin(), cells.end(), std::size_t{0}, [&](std::size_t sum, const RasterCell& cell) {
        return sum + (raster.poses[cell.pose].verdict == verdict ? std::size_t(cell.side) * std::size_t(cell.side) : 0);
    });
}

}  // namespace

TEST_CASE("open ground is one cell, and a post divides the squares around it down to the step")
{
    Scene scene;
    hand::add_mesh(scene, Label::Terrain, hand::rectangle(8, 8));
    const Bounds bounds{Vec3(-3.9, -3.9, -1), Vec3(3.85, 3.85, 3)};
    const Robot robot = load_robot("box:0.1,0.1,0.1");
    const RasterOptions options{.step = 0.25, .bounds = bounds};
    const RasterResult open = raster(Judge(map_of(scene), robot), options);
    REQUIRE(open.grid.cols == 32);
    REQUIRE(open.grid.rows == 32);
    const std::vector<RasterCell> one = raster_cells(open);
    REQUIRE(one.size() == 1);
    CHECK(one[0].side == 32);
    CHECK(open.poses[one[0].pose].x == open.grid.x_of(16));

    // The robot touches this post in columns 4 to 6 of rows 4 to 6, at -2.9 to -2.4 m.
    hand::add_shape(scene, Label::Obstacle, box_shape({0.5, 0.5, 1}, {{-2.65, -2.65, 0.5}}));
    const RasterResult blocked = raster(Judge(map_of(scene), robot), options);
    const std::vector<RasterCell> cells = raster_cells(blocked);
    CHECK(columns_in(cells, blocked, Verdict::Collision) == 9);
    CHECK(columns_in(cells, blocked, Verdict::Valid) == 32 * 32 - 9);
    // Three squares of 16, of 8 and of 4 columns; in the fourth one of 4, one of 2, and three that are divided.
    CHECK(cells.size() == 3 + 3 + 3 + 1 + 3 * 4);
}

TEST_CASE("adaptive rasters of level robots have the verdicts of plain ones, and divide no cell without need")
{
    for (std::uint64_t seed = 1; seed <= 16; ++seed) {
        CAPTURE(seed);
        const Judge judge(map_of(random_scene(seed)), random_robot(seed));
        const LayerChoice::Kind kind = seed % 4 == 0 ? LayerChoice::Kind::Top : LayerChoice::Kind::All;
        const RasterResult plain = raster(judge, {.step = 0.31, .yaw = 0.1 * double(seed), .layers = {kind, 0}});
        REQUIRE(plain.poses.size() > 500);
        check_cells(plain);
    }
}

TEST_CASE("adaptive rasters of settled robots have the verdicts of plain ones, also at several headings")
{
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
        CAPTURE(seed);
        const Judge judge(map_of(random_scene(seed)), random_robot(seed));
        RasterOptions options{.step = 0.6, .stance = Stance::Settled};
        if (seed % 2 == 0) options.heading = HeadingRule{.kind = HeadingRule::Kind::Any, .count = 4};
        const RasterResult plain = raster(judge, options);
        REQUIRE(plain.rests.size() == plain.poses.size());
        check_cells(plain);
    }
}

TEST_CASE("an adaptive raster leaves out columns off the region, and columns without ground")
{
    const Judge judge(training_map(), husky());
    Area area;
    area.within.push_back(box_region(-4, -3, 3, 5));
    const RasterResult plain = raster(judge, {.step = 0.25, .area = area});
    check_cells(plain);
    CHECK(raster_cells(raster(judge, {.step = 1, .z = {50, 60}})).empty());
}

TEST_CASE("cells of a 3D raster are refused")
{
    const Judge judge(training_map(), husky());
    CHECK_THROWS_WITH(raster_cells(raster(judge, {.dims = 3, .step = 5})), "raster_cells: raster.dims is 3, needs 2");
}

TEST_CASE("raster --adaptive writes the pose, size and heights of each cell, and counts all poses")
{
    const Arena arena;
    const std::string common = "raster map --dims 2 --step 0.25 --settle" + husky_option;
    const ProgramRun plain = arena(common + " -o plain.csv --summary plain.json");
    const ProgramRun run = arena(common + " --adaptive -o cells.csv --heatmap cells.png --summary cells.json");
    REQUIRE(plain.status == 0);
    REQUIRE(run.status == 0);
    const PoseTable poses = read_poses(arena / "plain.csv"), cells = read_poses(arena / "cells.csv");
    const std::vector<std::string> plain_verdicts = column_of(poses, "verdict"), verdicts = column_of(cells, "verdict"),
                                   sizes = column_of(cells, "size"), corners = column_of(cells, "x_low"),
                                   lows = column_of(cells, "z_low"), highs = column_of(cells, "z_high");
    std::map<std::string, double> columns, expected;
    std::set<std::string> plain_rows(poses.rows.begin(), poses.rows.end());
    for (const std::string& verdict : plain_verdicts) expected[verdict] += 1;
    for (std::size_t i = 0; i < cells.rows.size(); ++i) {
        const double side = std::stod(sizes[i]) / 0.25;
        columns[verdicts[i]] += side * side;
        const double z = cells.poses[i].position.z(), x = cells.poses[i].position.x();
        CHECK(std::stod(corners[i]) == Approx(x - (std::floor(side / 2) + 0.5) * 0.25));
        const bool is_between = std::stod(lows[i]) <= z && z <= std::stod(highs[i]);
        CHECK(is_between);
        const std::string& row = cells.rows[i];
        std::size_t end = row.size();
        for (int field = 0; field < 5; ++field) end = row.rfind(',', end - 1);
        CHECK(plain_rows.count(row.substr(0, end)) == 1);  // the same text as in the plain raster
    }
    CHECK(columns == expected);
    CHECK(cells.rows.size() * 2 < poses.rows.size());
    CHECK(run.err.find(" " + std::to_string(cells.rows.size()) + " cells; ") != std::string::npos);
    CHECK(bytes_of(arena / "cells.json").find("\"cells\": " + std::to_string(cells.rows.size())) != std::string::npos);
    CHECK(bytes_of(arena / "plain.json").find("\"cells\"") == std::string::npos);
}

TEST_CASE("raster --adaptive refuses what has no cells")
{
    const Arena arena;
    const auto message = [&](const std::string& arguments) {
        const ProgramRun run = arena("raster map --adaptive --step 1" + husky_option + arguments);
        CHECK(run.status == 2);
        return run.err;
    };
    CHECK(message(" --dims 3 -o x.csv") ==
          "spawnfield: --adaptive is only for --dims 2: its cells are squares of columns; give --dims 2\n");
    CHECK(message(" --dims 2 --format thesis -o x") ==
          "spawnfield: --adaptive and --format thesis do not go together: the thesis's files list single poses\n");
    CHECK(message(" --dims 2 --heatmap x.png") ==
          "spawnfield: --adaptive needs -o FILE if --heatmap is given: a picture shows all poses, not cells\n");
    CHECK(arena.names() == std::set<std::string>{"map"});
}

TEST_CASE("adaptive rasters of real scenes have the verdicts of plain ones, with fewer rows", "[real]")
{
    const auto folder = shared_scenes();
    if (!folder) return;
    for (const std::string file : {"dungeon/scene.yaml", "parking_garage/scene.yaml", "kaykit_town/scene.yaml"}) {
        CAPTURE(file);
        const Judge judge(map_of(load_scene((*folder / file).string()), 0.5), husky());
        const RasterResult level = raster(judge, {.step = 0.25});
        const std::vector<RasterCell> cells = raster_cells(level);
        CHECK(expanded(level, cells) == poses_of(level));
        CHECK(cells.size() * 2 < level.poses.size());
        const RasterResult settled = raster(judge, {.step = 2, .stance = Stance::Settled});
        CHECK(expanded(settled, raster_cells(settled)) == poses_of(settled));
    }
}
