#include "this_build.h"
#include "base/cell_blocks.h"
#include "base/pgm.h"
#include "catch.h"
#include "program.h"
#include "query/draw.h"
#include "scene/nav2_map.h"
#include "test_map.h"

#include <spawnfield/column.h>
#include <spawnfield/error.h>

#include <Eigen/Geometry>
#include <opencv2/imgcodecs.hpp>

#include <cmath>

using namespace spawnfield;
using Cell = Nav2Map::Cell;

namespace {

const std::string usual = "resolution: 0.5\norigin: [1, 2, 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n";

std::filesystem::path write_yaml(const TempFolder& folder, const std::string& image, const std::string& keys = usual)
{
    return folder.write("map.yaml", "image: " + image + "\n" + keys);
}

/// Returns a drawing of the map: "#" is occupied, "." free and "?" unknown; the first row is the top row.
std::string drawn(const Nav2Map& map)
{
    std::string out;
    for (const Cell cell : map.cells) out += cell == Cell::Occupied ? '#' : cell == Cell::Free ? '.' : '?';
    return out;
}

std::string read(const TempFolder& folder, const std::string& image, const std::string& keys = usual)
{
    return drawn(read_nav2_map(write_yaml(folder, image, keys)));
}

/// Returns a PGM image with one row of bytes.
std::string pgm(const std::vector<int>& values, int cols, int largest = 255)
{
    std::string out = "P5\n# by a map saver\n" + std::to_string(cols) + " " +
                      std::to_string(values.size() / std::size_t(cols)) + "\n" + std::to_string(largest) + "\n";
    for (const int value : values) {
        if (largest > 255) out += char(value >> 8);
        out += char(value & 0xff);
    }
    return out;
}

void write_png(const TempFolder& folder, const std::string& name, const cv::Mat& image)
{
    REQUIRE(cv::imwrite((folder / name).string(), image));
}

}  // namespace

TEST_CASE("pixels are occupied, free or unknown by their thresholds, as in map_server")
{
    const TempFolder folder;
    // (255 - v) / 255 is above 0.65 up to v = 89, and below 0.196 from v = 206 on.
    folder.write("a.pgm", pgm({0, 89, 90, 205, 206, 254, 255}, 7));
    CHECK(read(folder, "a.pgm") == "##??...");
    CHECK(read(folder, "a.pgm", "mode: scale\n" + usual) == "##??...");
    // With negate, v / 255 is above 0.65 from v = 166 on, and below 0.196 up to v = 49.
    folder.write("b.pgm", pgm({0, 49, 50, 165, 166, 255}, 6));
    CHECK(read(folder, "b.pgm",
               "resolution: 0.5\norigin: [1, 2, 0]\nnegate: true\noccupied_thresh: 0.65\nfree_thresh: 0.196\n") ==
          "..??##");
    // A pixel at a threshold is unknown: 51 / 255 is 0.2.
    folder.write("c.pgm", pgm({204, 205, 51, 50}, 4));
    CHECK(read(folder, "c.pgm",
               "resolution: 0.5\norigin: [1, 2, 0]\nnegate: 0\noccupied_thresh: 0.8\nfree_thresh: 0.2\n") == "?.?#");
    // In raw mode pixels are per cent, and unknown above 100.
    folder.write("d.pgm", pgm({0, 19, 20, 65, 66, 100, 101, 255}, 8));
    CHECK(read(folder, "d.pgm", "mode: raw\n" + usual) == "..??##??");
}

TEST_CASE("PGM as text, with two bytes or with another largest value gives the same pixels")
{
    const TempFolder folder;
    folder.write("a.pgm", "P2 # text\n# and more\n4 1 # size\n255\n0 89\n# between\n90 255");
    CHECK(read(folder, "a.pgm") == "##?.");
    folder.write("b.pgm", pgm({0, 89 * 257, 90 * 257, 65535}, 4, 65535));
    CHECK(read(folder, "b.pgm") == "##?.");
    folder.write("c.pgm", pgm({0, 3, 7, 10}, 4, 10));
    CHECK(read(folder, "c.pgm") == "##?.");
    CHECK(read_pgm(folder / "b.pgm").largest == 65535);
}

TEST_CASE("colours are averaged, and transparent pixels are unknown")
{
    const TempFolder folder;
    using Bgra = cv::Vec4b;
    cv::Mat colour(1, 3, CV_8UC3);
    colour.at<cv::Vec3b>(0, 0) = {255, 0, 0};      // 85: 0.667
    colour.at<cv::Vec3b>(0, 1) = {255, 255, 0};    // 170
    colour.at<cv::Vec3b>(0, 2) = {255, 255, 250};  // 253.3
    write_png(folder, "a.png", colour);
    CHECK(read(folder, "a.png") == "#?.");
    cv::Mat alpha(1, 5, CV_8UC4);
    alpha.at<Bgra>(0, 0) = {0, 0, 0, 255};  // with alpha 63.75: 0.75
    alpha.at<Bgra>(0, 1) = {255, 255, 255, 255};
    alpha.at<Bgra>(0, 2) = {255, 255, 255, 0};  // 191.25: 0.25
    alpha.at<Bgra>(0, 3) = {0, 0, 0, 0};        // 0: 1
    alpha.at<Bgra>(0, 4) = {255, 255, 255, 254};
    write_png(folder, "b.png", alpha);
    CHECK(read(folder, "b.png") == "#.?#.");
    CHECK(read(folder, "b.png", "mode: scale\n" + usual) == "#.???");
    cv::Mat grey(1, 3, CV_8U);
    grey.at<std::uint8_t>(0, 0) = 0;
    grey.at<std::uint8_t>(0, 1) = 205;
    grey.at<std::uint8_t>(0, 2) = 254;
    write_png(folder, "c.png", grey);
    CHECK(read(folder, "c.png") == "#?.");
}

TEST_CASE("blocks cover each selected cell once and nothing else")
{
    Draw draw(5, 0);
    for (int round = 0; round < 60; ++round) {
        const int rows = 1 + int(draw.unit() * 14), cols = 1 + int(draw.unit() * 14);
        const double share = draw.unit();
        std::vector<int> wanted(std::size_t(rows * cols)), seen(wanted.size(), 0);
        for (int& cell : wanted) cell = draw.unit() < share;
        for (const CellRectangle& b :
             blocks_of(rows, cols, [&](int row, int col) { return wanted[std::size_t(row * cols + col)] == 1; }))
            for (int row = b.first_row; row < b.end_row; ++row)
                for (int col = b.first_col; col < b.end_col; ++col) ++seen[std::size_t(row * cols + col)];
        CHECK(seen == wanted);
    }
    CHECK(blocks_of(3, 4, [](int, int) { return true; }).size() == 1);
}

TEST_CASE("a 2D map becomes a floor with walls at its occupied cells, at any yaw")
{
    const TempFolder folder;
    const double yaw = GENERATE(0.0, 0.6, -2.5);
    constexpr int rows = 23, cols = 31;
    Draw draw(8, 0);
    std::vector<int> values;
    for (int i = 0; i < rows * cols; ++i) values.push_back(std::array{0, 205, 254, 254}[std::size_t(draw.unit() * 4)]);
    folder.write("a.pgm", pgm(values, cols));
    const std::filesystem::path file = write_yaml(folder, "a.pgm",
                                                  "resolution: 0.25\norigin: [-3.5, 40, " + std::to_string(yaw) +
                                                      "]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n");
    SceneOptions options{.wall_height = 1.5};
    const Scene scene = load_scene(file, options);
    REQUIRE(scene.parts.size() == 2);
    CHECK((scene.parts[0].name == "floor" && scene.parts[0].label == Label::Terrain));
    CHECK((scene.parts[1].name == "walls" && scene.parts[1].label == Label::Obstacle));
    const Geometry geometry(scene);
    double wall_area = 0, floor_area = 0;
    for (const Primitive& wall : scene.primitives) wall_area += wall.shape.size.x() * wall.shape.size.y();
    for (const Triangle& t : scene.triangles)
        floor_area +=
            (scene.vertices[t[1]] - scene.vertices[t[0]]).cross(scene.vertices[t[2]] - scene.vertices[t[0]]).z() /
            2;  // positive if counterclockwise as seen from above
    std::size_t occupied = 0, known = 0;
    for (int row = 0; row < rows; ++row)
        for (int col = 0; col < cols; ++col) {
            const int value = values[std::size_t(row * cols + col)];
            occupied += value == 0;
            known += value != 205;
            for (const auto& [du, dv] : {std::pair{0.5, 0.5}, {0.02, 0.02}, {0.98, 0.03}}) {
                const double u = (col + du) * 0.25, v = (rows - 1 - row + dv) * 0.25;
                const Column column = column_at(geometry, -3.5 + std::cos(yaw) * u - std::sin(yaw) * v,
                                                40 + std::sin(yaw) * u + std::cos(yaw) * v);
                REQUIRE(column.layers == (value == 205 ? std::vector<double>{} : std::vector<double>{0}));
                double top = 0;
                for (const Span& span : column.spans) top = std::max(top, span.top);
                REQUIRE(top == (value == 0 ? 1.5 : 0));
            }
        }
    CHECK(wall_area == Approx(double(occupied) * 0.0625));
    CHECK(floor_area == Approx(double(known) * 0.0625));
}

TEST_CASE("ambiguous settings of a map get a notice")
{
    const TempFolder folder;
    folder.write("a.pgm", pgm({0, 205, 254}, 3));
    const auto notices = [&](const std::string& keys) { return load_scene(write_yaml(folder, "a.pgm", keys)).notices; };
    const std::string file = (folder / "map.yaml").string() + ": ";
    CHECK(notices(usual) == std::vector<std::string>{file + "walls are 2 m high (--wall-height sets it)"});
    const std::vector<std::string> many = notices(
        "resolution: 1\norigin: [0, 0, 0]\nnegate: 1\nmode: raw\nfree_thresh: 0.25\nlayers: 3\n");
    CHECK(many == std::vector<std::string>{file + "the key layers is unknown and ignored",
                                           file + "occupied_thresh is missing; the default 0.65 is used",
                                           file + "negate has no effect in mode raw, as in nav2",
                                           file + "walls are 2 m high (--wall-height sets it)"});
    const std::vector<std::string> grey = notices(
        "resolution: 1\norigin: [0, 0, 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.25\n");
    const std::string free_grey = file + "1 pixels of 205, which map savers write for unknown, are free";
    CHECK(grey[0] == free_grey + " by free_thresh 0.25 (with free_thresh 0.196 or less they are unknown)");
    write_png(folder, "b.png", cv::Mat(1, 1, CV_8UC4, cv::Scalar(205, 205, 205, 255)));  // with alpha 217.5: 0.147
    const auto of_alpha = [&](const std::string& keys) {
        return load_scene(write_yaml(folder, "b.png", keys)).notices[0];
    };
    CHECK(of_alpha(usual) == free_grey +
                                 ", because mode trinary counts alpha as a fourth colour, as in nav2 (without the "
                                 "alpha channel they are not free)");
    CHECK(of_alpha("resolution: 1\norigin: [0, 0, 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.25\n") ==
          grey[0]);
}

TEST_CASE("invalid maps are refused by file, key and line")
{
    const TempFolder folder;
    folder.write("a.pgm", pgm({0, 205, 254}, 3));
    folder.write("short.pgm", pgm({0, 205}, 2).substr(0, 29));
    folder.write("bits.pgm", "P4\n8 1\n\xff");
    folder.write("giant.pgm", "P5\n99999 99999\n255\n");
    folder.write("over.pgm", "P2\n2 1\n100\n7 101\n");
    folder.write("text.pgm", "P2\n2 1\n100\n7 x\n");
    folder.write("full.pgm", pgm({0, 0, 205}, 3));
    const std::string start = (folder / "map.yaml").string() + ": ";
    const auto check_refused = [&](const std::string& image, const std::string& keys, const std::string& reason) {
        CHECK_THROWS_WITH(load_scene(write_yaml(folder, image, keys)), start + reason);
    };
    const auto used = [&](const std::string& name) {
        return "image cannot be used: " + (folder / name).string() + ": ";
    };
    check_refused("none.pgm", usual, used("none.pgm") + "does not exist; is the path right? (line 1)");
    check_refused("bits.pgm", usual,
                  used("bits.pgm") + "is not PGM (P2, P5) or PNG; convert the map's image to one of them (line 1)");
    check_refused("giant.pgm", usual, used("giant.pgm") + "has 99999 x 99999 pixels, needs at most 67108864 (line 1)");
    check_refused("over.pgm", usual,
                  used("over.pgm") + "has a pixel of 101, needs at most its largest value 100 (line 1)");
    check_refused("text.pgm", usual,
                  used("text.pgm") + "is cut short or a damaged PGM image: pixel 1 is not a whole number (line 1)");
    CHECK_THROWS_WITH(load_scene(write_yaml(folder, "short.pgm")), Contains("is cut short"));
    check_refused("full.pgm", usual, "has no free cell (3 x 1); are negate and the thresholds right?");
    check_refused("a.pgm", "origin: [0, 0, 0]\n", "resolution is missing");
    check_refused("a.pgm", "resolution: 0\norigin: [0, 0, 0]\n", "resolution is 0, needs > 0 (line 2)");
    check_refused("a.pgm", "resolution: 1e300\norigin: [0, 0, 0]\n",
                  "resolution is 1e+300, needs at most 1000 m (line 2)");
    check_refused("a.pgm", "resolution: 1\n", "origin is missing");
    check_refused("a.pgm", "resolution: 1\norigin: [0, 0]\n", "origin has 2 numbers, needs 3 (line 3)");
    check_refused("a.pgm", "resolution: 1\norigin: [0, 0, 0]\nnegate: 2\n", "negate is \"2\", needs 0 or 1 (line 4)");
    check_refused("a.pgm", "resolution: 1\norigin: [0, 0, 0]\nmode: both\n",
                  "mode is \"both\", needs one of trinary, scale, raw (line 4)");
    check_refused("a.pgm", "resolution: 1\norigin: [0, 0, 0]\nfree_thresh: 7\n",
                  "free_thresh is 7, needs 0 .. 1 (line 4)");
    check_refused("a.pgm", "resolution: 1\norigin: [0, 0, 0]\nfree_thresh: 0.7\noccupied_thresh: 0.6\n",
                  "free_thresh is 0.7, needs at most occupied_thresh (0.6) (line 4)");
    SceneOptions options{.wall_height = -1};
    CHECK_THROWS_WITH(load_scene(write_yaml(folder, "a.pgm"), options), "load_scene: wall_height is -1, needs > 0 m");
    options.wall_height = 1;
    CHECK_THROWS_WITH(load_scene(source_folder() + "/maps/training/scene.yaml", options),
                      Contains("wall_height is for a 2D map"));
}

TEST_CASE("a nav2 map can be baked directly, and robots stand where it is free")
{
    const TempFolder folder;
    std::vector<int> values(40 * 40, 254);
    for (int i = 0; i < 40; ++i)
        values[std::size_t(i)] = values[std::size_t(40 * i)] = values[std::size_t(40 * i + 39)] =
            values[std::size_t(39 * 40 + i)] = 0;
    for (int i = 0; i < 25; ++i) values[std::size_t(20 * 40 + i)] = 0;
    for (int i = 30; i < 39; ++i)
        for (int j = 30; j < 39; ++j) values[std::size_t(i * 40 + j)] = 205;
    folder.write("room.pgm", pgm(values, 40));
    write_yaml(folder, "room.pgm",
               "resolution: 0.1\norigin: [-2, -2, 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n");
    const ProgramRun baked = run_program(folder, "bake map.yaml -o map --wall-height 1 --label 'walls=obstacle'");
    CHECK(baked.status == 0);
    CHECK(baked.err.find("notice") == std::string::npos);
    CHECK_THAT(run_program(folder, "info map.yaml").out, Contains("floor: map, terrain"));
    const Map map = read_map(folder / "map");
    CHECK(map.bounds.max == Vec3(2, 2, 1));
    const Judge judge(map, load_robot("box:0.2,0.2,0.2"));
    SampleOptions options{.count = 300, .stance = Stance::Level};
    const SpawnList list = sample(judge, options);
    CHECK(list.spawns.size() == 300);
    for (const Spawn& spawn : list.spawns) {
        const int row = int((2 - spawn.position.y()) / 0.1), col = int((spawn.position.x() + 2) / 0.1);
        CHECK(values[std::size_t(row * 40 + col)] == 254);
    }
    CHECK(run_program(folder, "bake map.yaml -o map2 --wall-height 0.5 --scale 2").status == 2);
    for (const std::string height : {"0", "-1"}) {  // 0 differs from a missing option
        const ProgramRun refused = run_program(folder, "bake map.yaml -o map2 --wall-height " + height);
        CHECK(refused.status == 2);
        CHECK_THAT(refused.err, Contains("--wall-height is " + height + ", needs > 0"));
    }
    CHECK(run_program(folder, "info " + source_folder() + "/maps/training/scene.yaml --wall-height 0").status == 2);
    CHECK(run_program(folder, "bake room.pgm -o map2").status == 4);
}
