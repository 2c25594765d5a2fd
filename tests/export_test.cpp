#include "arena.h"
#include "base/tiff.h"
#include "hard_scene.h"
#include "picture/gradient.h"
#include "shared_scenes.h"
#include "test_map.h"

#include <spawnfield/error.h>
#include <spawnfield/map_export.h>
#include <spawnfield/raster_quantities.h>
#include <spawnfield/output_file.h>

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include <iostream>
#include <map>
#include <numbers>
#include <regex>

namespace fs = std::filesystem;
using namespace spawnfield;

namespace {

/// Returns a map with a box of terrain, a deck of terrain above half of it, a block on the deck, a crate on the floor
/// and a pool. Beyond x = 3 there is no terrain.
TestMap deck_map()
{
    const TempFolder folder;
    const fs::path file = folder.write(
        "scene.yaml",
        "format: spawnfield-scene/1\nname: deck\nparts:\n"
        "- {name: floor, label: terrain, box: [8, 6, 1], xyz: [-1, 0, -0.5]}\n"
        "- {name: deck, label: terrain, box: [3, 6, 0.2], xyz: [-3, 0, 2]}\n"
        "- {name: block, label: obstacle, box: [1, 1, 1], xyz: [-3.5, 1, 2.6]}\n"
        "- {name: crate, box: [0.5, 0.5, 0.5], xyz: [1, 2, 0.2]}\n"
        "- {name: pool, label: water, plane: [1, 2], xyz: [2, -2, 0.3]}\n"
        "- {name: post, label: obstacle, cylinder: {radius: 0.2, length: 2}, xyz: [4.5, 0, 1]}\n");
    return map_of(load_scene(file));
}

const Robot small_box = load_robot("box:0.4,0.3,0.3@0,0,0.2");

struct Nav2Map {
    std::string image, mode;
    double resolution, x0, y0, yaw, occupied_thresh, free_thresh;
    int negate;
    cv::Mat_<std::uint8_t> pixels;

    /// Returns 100, 0 or -1 at a point of the ground, as map_server decides.
    int occupancy_at(double x, double y) const
    {
        const int col = int(std::floor((x - x0) / resolution)), from_below = int(std::floor((y - y0) / resolution));
        const double shade = pixels(pixels.rows - 1 - from_below, col) / 255.0, occupied = negate ? shade : 1 - shade;
        return occupied > occupied_thresh ? 100 : occupied < free_thresh ? 0 : -1;
    }
};

Nav2Map read_nav2(const fs::path& yaml)
{
    const std::string text = bytes_of(yaml);
    const auto value = [&](const std::string& key) {
        std::smatch found;
        REQUIRE(std::regex_search(text, found, std::regex("(^|\n)" + key + ": (.*)")));
        return found[2].str();
    };
    Nav2Map map{value("image"),
                value("mode"),
                std::stod(value("resolution")),
                0,
                0,
                0,
                std::stod(value("occupied_thresh")),
                std::stod(value("free_thresh")),
                std::stoi(value("negate")),
                {}};
    REQUIRE(std::sscanf(value("origin").c_str(), "[%lf, %lf, %lf]", &map.x0, &map.y0, &map.yaw) == 3);
    map.pixels = cv::imread((yaml.parent_path() / map.image).string(), cv::IMREAD_UNCHANGED);
    REQUIRE_FALSE(map.pixels.empty());
    return map;
}

/// A GeoTIFF, as libtiff reads it.
struct GeoTiff {
    std::vector<HeightImage> bands;
    std::vector<double> scale, tiepoint;
    std::vector<std::uint16_t> keys;
    std::string metadata, no_data;

    /// Returns the band with this description.
    const HeightImage& band(const std::string& name) const
    {
        std::smatch found;
        REQUIRE(
            std::regex_search(metadata, found, std::regex("sample=\"([0-9]+)\" role=\"description\">" + name + "<")));
        return bands.at(std::stoul(found[1]));
    }
    bool has(const std::string& name) const { return metadata.find(">" + name + "<") != std::string::npos; }
    /// Returns the value at a point of the ground, found by scale and tiepoint.
    float at(const std::string& name, double x, double y) const
    {
        const int col = int(std::floor((x - tiepoint[3]) / scale[0])),
                  row = int(std::floor((tiepoint[4] - y) / scale[1]));
        return band(name)(row, col);
    }
};

template <class T>
std::vector<T> tag_values(TIFF* tiff, std::uint32_t tag)
{
    std::uint32_t count = 0;
    const T* values = nullptr;
    REQUIRE(TIFFGetField(tiff, tag, &count, &values) == 1);
    return {values, values + count};
}

std::string tag_text(TIFF* tiff, std::uint32_t tag)
{
    const char* text = nullptr;
    REQUIRE(TIFFGetField(tiff, tag, &text) == 1);
    return text;
}

GeoTiff read_geotiff(const fs::path& file)
{
    const Tiff tiff = open_tiff(file, "r");
    REQUIRE(tiff);
    std::uint32_t rows = 0, cols = 0, side = 0;
    std::uint16_t bands = 0, bits = 0, format = 0;
    TIFFGetField(tiff.get(), TIFFTAG_IMAGELENGTH, &rows);
    TIFFGetField(tiff.get(), TIFFTAG_IMAGEWIDTH, &cols);
    TIFFGetField(tiff.get(), TIFFTAG_TILEWIDTH, &side);
    TIFFGetField(tiff.get(), TIFFTAG_SAMPLESPERPIXEL, &bands);
    TIFFGetField(tiff.get(), TIFFTAG_BITSPERSAMPLE, &bits);
    TIFFGetField(tiff.get(), TIFFTAG_SAMPLEFORMAT, &format);
    REQUIRE((bits == 32 && format == SAMPLEFORMAT_IEEEFP));
    GeoTiff out{{},
                tag_values<double>(tiff.get(), 33550),
                tag_values<double>(tiff.get(), 33922),
                tag_values<std::uint16_t>(tiff.get(), 34735),
                tag_text(tiff.get(), 42112),
                tag_text(tiff.get(), 42113)};
    HeightImage tile{int(side), int(side)};
    for (std::uint16_t band = 0; band < bands; ++band) {
        HeightImage& image = out.bands.emplace_back(int(rows), int(cols));
        for (std::uint32_t top = 0; top < rows; top += side)
            for (std::uint32_t left = 0; left < cols; left += side) {
                REQUIRE(TIFFReadTile(tiff.get(), tile.values.data(), left, top, 0, band) > 0);
                const int height = int(std::min(side, rows - top)), width = int(std::min(side, cols - left));
                for (int row = 0; row < height; ++row)
                    std::copy_n(&tile(row, 0), width, &image(int(top) + row, int(left)));
            }
    }
    return out;
}

bool same(float a, float b) { return a == b || (std::isnan(a) && std::isnan(b)); }
bool same(const HeightImage& a, const HeightImage& b)
{
    return a.rows == b.rows && a.cols == b.cols &&
           std::equal(a.values.begin(), a.values.end(), b.values.begin(), [](float x, float y) { return same(x, y); });
}

/// Returns a Python that reads our files back with this package. If the package is not installed, the running test is
/// skipped. Tests that call this have the tag [python] (see CMakeLists.txt).
std::optional<std::string> python_with(const std::string& package)
{
    const std::string python = "'" + python_file() + "'";
    if (std::system((python + " -c 'import " + package + "' > /dev/null 2>&1").c_str()) == 0) return python;
    skip_test(python + " has no " + package + "; tools/test-python.sh installs it");
    return std::nullopt;
}

/// Runs a script with the file as its argument. Returns false if the script ends with an exception.
bool python_accepts(const std::string& python, const TempFolder& folder, const std::string& script,
                    const fs::path& file)
{
    const fs::path program = folder.write("script.py", script);
    return std::system((python + " '" + program.string() + "' '" + file.string() + "'").c_str()) == 0;
}

std::string glb_bytes(const Map& map, const GlbMarkers& markers = {}, int threads = 0)
{
    std::string bytes;
    write_glb(
        map, markers, [&](std::string_view piece) { bytes += piece; }, threads);
    return bytes;
}

/// Returns the JSON chunk, after a check of the sizes of all chunks.
nlohmann::json glb_json(const std::string& bytes)
{
    const auto word = [&](std::size_t at) {
        std::uint32_t value = 0;
        std::memcpy(&value, bytes.data() + at, sizeof value);
        return std::size_t(value);
    };
    REQUIRE(bytes.starts_with("glTF"));
    CHECK((word(4) == 2 && word(8) == bytes.size() && word(12) % 4 == 0 && word(16) == 0x4E4F534A));
    if (20 + word(12) < bytes.size())
        CHECK((20 + word(12) + 8 + word(20 + word(12)) == bytes.size() && word(24 + word(12)) == 0x004E4942));
    return nlohmann::json::parse(bytes.substr(20, word(12)));
}

/// Loads a GLB with the project's own reader.
Scene load_glb(const TempFolder& folder, const std::string& bytes)
{
    SceneOptions options{.labels = {{"terrain", Label::Terrain},
                                    {"water", Label::Water},
                                    {"obstacle", Label::Obstacle},
                                    {"spawn*", Label::Ignore}}};
    return load_scene(folder.write("a.glb", bytes), options);
}

/// Returns triangles with their labels, independent of their order and of their first corner. Leaves out triangles
/// without area, which readers drop.
std::multiset<std::array<double, 10>> triangles_of(const Scene& scene)
{
    std::multiset<std::array<double, 10>> out;
    for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
        std::array<std::array<double, 3>, 3> corners;
        for (std::size_t c = 0; c < 3; ++c)
            Vec3::Map(corners[c].data()) = scene.vertices[scene.triangles[t][c]] + Vec3::Zero();
        std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
        if (corners[0] == corners[1] || corners[1] == corners[2] || corners[0] == corners[2]) continue;
        std::array<double, 10> flat{};
        for (std::size_t i = 0; i < 9; ++i) flat[i] = corners[i / 3][i % 3];
        flat[9] = double(scene.triangle_labels[t]);
        out.insert(flat);
    }
    return out;
}

RasterOptions on_layer(LayerChoice layers, double offset = 0.1, double yaw = 0)
{
    return {.offset = offset, .yaw = yaw, .layers = layers};
}

/// Returns the verdict at a point, computed by the test itself from the column; nothing if there is no such layer.
std::optional<Verdict> verdict_at(const Judge& judge, const RasterOptions& options, double x, double y)
{
    const Column column = column_at(judge.map().geometry, x, y);
    const int count = int(column.layers.size());
    for (int layer = 0; layer < count; ++layer)
        if (options.layers.includes(layer, count)) {
            const Vec3 position(x, y, column.layers[std::size_t(layer)] + *options.offset);
            return judge.check({position, rotation_from_rpy(0, 0, options.yaw)}).verdict;
        }
    return std::nullopt;
}

}  // namespace

TEST_CASE("an image of verdicts has the verdict at the centre of each cell, on the chosen layer")
{
    const TestMap map = deck_map();
    const Judge judge(map, small_box);
    const LayerChoice layers = GENERATE(LayerChoice{LayerChoice::Kind::Top, 0},
                                        LayerChoice{LayerChoice::Kind::Bottom, 0},
                                        LayerChoice{LayerChoice::Kind::Index, 1});
    const double cell = GENERATE(0.1, 0.23, 20.0);
    const RasterOptions options = on_layer(layers, 0.15, 0.7);
    const GridFrame frame = frame_around(map.bounds, cell);
    const VerdictImage image = verdict_image(judge, frame, options);
    REQUIRE(image.verdicts.size() == std::size_t(frame.rows) * std::size_t(frame.cols));
    VerdictCounts counts;
    for (int row = 0; row < frame.rows; ++row)
        for (int col = 0; col < frame.cols; ++col) {
            const std::optional<Verdict> expected = verdict_at(judge, options, frame.x_of(col), frame.y_of(row));
            CHECK(image.at(row, col) == (expected ? std::uint8_t(*expected) : VerdictImage::no_pose));
            if (expected) ++counts[*expected];
        }
    CHECK(image.counts == counts);
    if (cell < 1 && layers.kind != LayerChoice::Kind::Index) {
        for (const Verdict verdict : {Verdict::Valid, Verdict::Collision, Verdict::Submerged})
            CHECK(counts[verdict] > 0);
    }
}

TEST_CASE("an image of verdicts is the same in strips far from the origin, and with any number of threads")
{
    const TempFolder folder;  // the map has more rows than a strip, at coordinates where steps are rounded
    const TestMap map = map_of(
        load_scene(folder.write("scene.yaml",
                                "format: spawnfield-scene/1\nparts:\n"
                                "- {name: floor, label: terrain, box: [1, 7, 1], xyz: [500000.3, 4500000.1, 0]}\n"
                                "- {name: ball, sphere: 0.3, xyz: [500000.2, 4499999.7, 0.6]}\n")));
    const Judge judge(map, small_box);
    RasterOptions options = on_layer({LayerChoice::Kind::Top, 0});
    const GridFrame frame = frame_around(map.bounds, 0.01);
    REQUIRE(frame.rows == 700);
    options.threads = 1;
    const VerdictImage one = verdict_image(judge, frame, options);
    options.threads = 7;
    CHECK(verdict_image(judge, frame, options).verdicts == one.verdicts);
    CHECK(std::count(one.verdicts.begin(), one.verdicts.end(), VerdictImage::no_pose) ==
          0);  // rounding loses no row or column
}

TEST_CASE("an image of settled verdicts has the tilt and the margin of each settled pose")
{
    const TestMap map = training_map();
    const Judge judge(map, husky());
    RasterOptions options{
        .step = 0.5, .stance = Stance::Settled, .yaw = 0.4, .layers = {LayerChoice::Kind::Top, 0}, .threads = 1};
    GridFrame frame = frame_around(map.bounds, options.step);
    const VerdictImage image = verdict_image(judge, frame, options);
    REQUIRE(image.tilt.size() == image.verdicts.size());
    REQUIRE(image.margin.size() == image.verdicts.size());
    std::size_t tilted = 0, without_pose = 0;
    for (int row = 0; row < frame.rows; row += 3)
        for (int col = 0; col < frame.cols; ++col) {
            if (image.at(row, col) == VerdictImage::no_pose) continue;
            const double x = frame.x_of(col), y = frame.y_of(row);
            const Column column = column_at(map.geometry, x, y);
            const SettledPose pose = judge.settle({x, y, column.layers.front()}, options.yaw);
            const std::size_t cell = std::size_t(row) * std::size_t(frame.cols) + std::size_t(col);
            CHECK(image.verdicts[cell] == std::uint8_t(pose.verdict));
            CHECK(std::isnan(image.tilt[cell]) == !pose.has_pose);
            if (pose.has_pose) CHECK(std::abs(image.tilt[cell] - pose.tilt) <= 1e-6);
            if (pose.has_pose) CHECK(std::abs(image.margin[cell] - pose.margin) <= 1e-6);
            tilted += pose.has_pose && pose.tilt > 0.1;
            without_pose += !pose.has_pose;
        }
    CHECK(tilted > 10);
    CHECK(without_pose > 10);
    options.stance = Stance::Level;
    CHECK(verdict_image(judge, frame, options).tilt.empty());
}

TEST_CASE("a nav2 map has at each point the value of the verdict at the centre of the cell")
{
    const TestMap map = deck_map();
    const Judge judge(map, small_box);
    const RasterOptions options = on_layer({LayerChoice::Kind::Top, 0});
    const GridFrame frame = frame_around(map.bounds, 0.23);  // the last cells reach beyond the bounds
    const TempFolder folder;
    write_nav2_map(verdict_image(judge, frame, options), folder / "deck.yaml", {"a deck\nimage: wrong.pgm"});
    const Nav2Map read = read_nav2(folder / "deck.yaml");
    CHECK(read.image == "deck.pgm");
    CHECK(read.mode == "trinary");
    CHECK(read.yaw == 0);
    CHECK((read.pixels.rows == frame.rows && read.pixels.cols == frame.cols));
    CHECK(read.resolution == frame.cell);
    for (int row = 0; row < frame.rows; ++row)
        for (int col = 0; col < frame.cols; ++col) {
            const double x = frame.x_of(col), y = frame.y_of(row);
            const std::optional<Verdict> verdict = verdict_at(judge, options, x, y);
            const int expected = !verdict || *verdict == Verdict::Outside ? -1 : *verdict == Verdict::Valid ? 0 : 100;
            CHECK(read.occupancy_at(x, y) == expected);
        }
    CHECK(read.occupancy_at(-3.5, 1) == 100);  // the block
    CHECK(read.occupancy_at(-3.5, -1) == 0);   // the deck
    CHECK(read.occupancy_at(2, -2) == 100);    // the pool
    CHECK(read.occupancy_at(2, 2) == 0);       // the floor: x and y are not rotated or mirrored
    CHECK(read.occupancy_at(4.5, 0) == -1);    // the post, where there is no terrain
}

TEST_CASE("names of nav2 images that YAML would misread are quoted, and other extensions are refused")
{
    const TempFolder folder;
    const VerdictImage image{{0, 0, 1, 1, 1}, {std::uint8_t(Verdict::Valid)}, {}, 0};
    write_nav2_map(image, folder / "a: b #1.yml");
    CHECK_THAT(bytes_of(folder / "a: b #1.yml"), Contains("image: \"a: b #1.pgm\"\n"));
    CHECK(bytes_of(folder / "a: b #1.pgm") == "P5\n1 1\n255\n\xfe");
    CHECK_THROWS_AS(write_nav2_map(image, folder / "map.pgm"), ArgumentError);
    CHECK(names_in(folder.path()).size() == 2);
}

TEST_CASE("of files that are committed together, all appear or none")
{
    const TempFolder folder;
    folder.write("a", "old a");
    {
        OutputFile a(folder / "a"), b(folder / "b"), c(folder / "c");
        for (OutputFile* file : {&a, &b, &c}) file->write("new");
        fs::create_directories(folder / "c" / "in the way");
        OutputFile* const all[] = {&a, &b, &c};
        CHECK_THROWS_AS(OutputFile::commit_together(all), OutputError);
    }
    CHECK(bytes_of(folder / "a") == "old a");
    CHECK(names_in(folder.path()) == std::set<std::string>{"a", "c"});
    fs::remove_all(folder / "c");
    OutputFile a(folder / "a"), c(folder / "c");
    a.write("new a");
    c.write("new c");
    OutputFile* const both[] = {&a, &c};
    OutputFile::commit_together(both);
    CHECK(bytes_of(folder / "a") == "new a");
    CHECK(bytes_of(folder / "c") == "new c");
    CHECK(names_in(folder.path()) == std::set<std::string>{"a", "c"});
}

TEST_CASE("export --format nav2 writes both files, the same bytes with any number of threads")
{
    const Arena arena;
    REQUIRE(arena("export map --format nav2 --stance level --offset 0.2 --layers bottom -o one.yaml --threads 1 "
                  "--summary s.json" +
                  husky_option)
                .status == 0);
    REQUIRE(arena("export map --format nav2 --stance level --offset 0.2 --layers bottom -o two.yaml --threads 3" +
                  husky_option)
                .status == 0);
    CHECK(bytes_of(arena / "one.pgm") == bytes_of(arena / "two.pgm"));
    const Nav2Map map = read_nav2(arena / "one.yaml");
    CHECK(map.image == "one.pgm");
    CHECK(map.resolution == 0.2);
    CHECK(map.occupancy_at(0, 3) == 0);
    CHECK(map.occupancy_at(-6.5, -5) == 100);
    CHECK_THAT(bytes_of(arena / "s.json"), Contains("\"command\": \"export\"") && Contains("map_hash"));
    REQUIRE(arena("export map --format nav2 --resolution 0.5 -o coarse.yaml" + husky_option).status == 0);
    CHECK(read_nav2(arena / "coarse.yaml").resolution == 0.5);
}

TEST_CASE("the bands of a GeoTIFF have the values of the column at the centre of each cell, as libtiff reads them")
{
    const TestMap map = deck_map();
    const Judge judge(map, small_box);
    const RasterOptions options = on_layer({LayerChoice::Kind::Bottom, 0});
    const GridFrame frame = frame_around(map.bounds, 0.031);  // more than a tile along x
    REQUIRE((frame.cols > 256 && frame.rows < 256));
    const VerdictImage verdicts = verdict_image(judge, frame, options);
    const TempFolder folder;
    GeoTiffOptions choice{.layers = options.layers};
    write_geotiff(map, frame, &verdicts, choice, folder / "deck.tif");
    const GeoTiff read = read_geotiff(folder / "deck.tif");
    CHECK(read.bands.size() == 8);
    CHECK(read.no_data == "nan");
    CHECK(read.scale == std::vector<double>{frame.cell, frame.cell, 0});
    CHECK(read.tiepoint == std::vector<double>{0, 0, 0, frame.x0, frame.y0 + frame.rows * frame.cell, 0});
    const auto has_key = [&](std::uint16_t key, std::uint16_t value) {
        for (std::size_t k = 4; k < read.keys.size(); k += 4)
            if (read.keys[k] == key) return read.keys[k + 3] == value;
        return false;
    };
    CHECK((has_key(1024, 32767) && has_key(1025, 1) && has_key(3076, 9001)));
    const TerrainMap terrain = rasterize_terrain(map.geometry, frame);
    CHECK(same(read.band("elevation"), page_image(terrain, "height.0")));
    CHECK(same(read.band("elevation_1"), page_image(terrain, "height.1")));
    CHECK(same(read.band("water"), page_image(terrain, "water")));
    CHECK(same(read.band("obstacle"), page_image(terrain, "obstacle")));
    const HeightImage &counts = read.band("layers"), &codes = read.band("verdict");
    for (int row = 0; row < frame.rows; ++row)
        for (int col = 0; col < frame.cols; ++col) {
            const Column column = column_at(map.geometry, frame.x_of(col), frame.y_of(row));
            if (counts(row, col) != float(column.layers.size())) FAIL("layers at " << row << ", " << col);
            const std::uint8_t verdict = verdicts.at(row, col);
            const float expected = verdict == VerdictImage::no_pose ? NAN : float(verdict);
            if (!same(codes(row, col), expected)) FAIL("verdict at " << row << ", " << col);
        }
    CHECK(read.at("elevation", -3, -1) == float(2.1));  // x and y are not rotated or mirrored
    CHECK(std::isnan(read.at("elevation", 4.5, 0)));
    CHECK(read.at("layers", 4.5, 0) == 0);
    CHECK(read.at("free_height", -3, -1) == Approx(1.9));  // under the deck
    CHECK(std::isnan(read.at("free_height", 1, -1)));      // the open sky
    CHECK(read.at("free_height", 1, 2) == 0);              // the crate
    CHECK(read.at("slope", -3, -1) == 0);
    CHECK(read.at("verdict", 2, -2) == float(Verdict::Submerged));
    choice.layers = {LayerChoice::Kind::Top, 0};
    write_geotiff(map, frame, nullptr, choice, folder / "top.tif");
    const GeoTiff top = read_geotiff(folder / "top.tif");
    CHECK_FALSE(top.has("verdict"));
    CHECK(std::isnan(top.at("free_height", -3, -1)));  // on the deck
    CHECK(top.at("free_height", -3.5, 1) == 0);        // its block
}

TEST_CASE("a GeoTIFF has the slope of a ramp, also at the rim")
{
    const TempFolder folder;
    const TestMap map = map_of(
        load_scene(folder.write("scene.yaml",
                                "format: spawnfield-scene/1\nparts:\n"
                                "- {name: ramp, label: terrain, plane: [3, 3], rpy: [0.2, -0.3, 0]}\n")));
    write_geotiff(map, frame_around({Vec3(-1, -1, 0), Vec3(1, 1, 0)}, 0.1), nullptr, {}, folder / "ramp.tif");
    const GeoTiff read = read_geotiff(folder / "ramp.tif");
    const double expected = std::acos(rotation_from_rpy(0.2, -0.3, 0)(2, 2)) * 180 / std::numbers::pi;
    for (const float slope : read.band("slope").values) CHECK(slope == Approx(expected).epsilon(1e-4));
}

TEST_CASE("the slopes of a GeoTIFF use neighbours beyond the edge of a tile")
{
    const TestMap map = deck_map();
    const TempFolder folder;
    const GridFrame frame = frame_around(map.bounds, 3.5 / 256);  // the deck ends where the second tile begins
    write_geotiff(map, frame, nullptr, {}, folder / "deck.tif");
    const HeightImage slopes = read_geotiff(folder / "deck.tif").band("slope"),
                      heights = page_image(rasterize_terrain(map.geometry, frame), "height.0");
    std::size_t wrong = 0;
    for (int row = 0; row < frame.rows; ++row)
        for (int col = 0; col < frame.cols; ++col) {
            const double slope = std::atan(gradient(heights, row, col, frame.cell).norm()) * 180 / std::numbers::pi;
            wrong += !(std::isnan(slope) ? std::isnan(slopes(row, col)) : std::abs(slope - slopes(row, col)) < 1e-4);
        }
    CHECK(wrong == 0);
    const int row = frame.rows / 4;
    CHECK((slopes(row, 254) == 0 && slopes(row, 255) > 80 && slopes(row, 256) > 80 && slopes(row, 257) == 0));
}

TEST_CASE("a GeoTIFF is at its survey coordinates, if the survey has an EPSG code", "[python]")
{
    TestMap map = deck_map();
    map.origin = GeoOrigin{500000.25, 4100000.5, 1, "EPSG:32611"};
    const TempFolder folder;
    const GridFrame frame = frame_around(map.bounds, 0.5);
    write_geotiff(map, frame, nullptr, {}, folder / "a.tif");
    const GeoTiff survey = read_geotiff(folder / "a.tif");
    CHECK(survey.keys == std::vector<std::uint16_t>{1, 1, 0, 3, 1024, 0, 1, 1, 1025, 0, 1, 1, 3072, 0, 1, 32611});
    CHECK(survey.at("elevation", 500000.25 - 3, 4100000.5 - 1) == float(2.1));
    CHECK(survey.at("elevation", 500000.25 + 2, 4100000.5 + 2) == 0);
    if (const auto python = python_with("rasterio"))
        CHECK(python_accepts(*python, folder,
                             "import rasterio, sys\nd = rasterio.open(sys.argv[1])\nassert d.crs.to_epsg() == 32611\n"
                             "assert abs(next(d.sample([(499997.25, 4099999.5)]))[0] - 2.1) < 1e-6\n",
                             folder / "a.tif"));
    map.origin->unit = 0.3048;  // feet
    write_geotiff(map, frame, nullptr, {}, folder / "feet.tif");
    const GeoTiff feet = read_geotiff(folder / "feet.tif");
    CHECK(feet.at("elevation", 500000.25 - 3 / 0.3048, 4100000.5 - 1 / 0.3048) == float(2.1));
    GeoTiffOptions local{.survey = false};
    write_geotiff(map, frame, nullptr, local, folder / "local.tif");
    map.origin->crs = "EPSG:4326000";
    write_geotiff(map, frame, nullptr, {}, folder / "words.tif");
    for (const char* const name : {"local.tif", "words.tif"})
        CHECK(read_geotiff(folder / name).at("elevation", -3, -1) == float(2.1));
}

TEST_CASE("export --format geotiff writes the same bytes with any number of threads")
{
    const Arena arena;
    const std::string command = "export map --format geotiff --stance level --resolution 0.05" +
                                husky_option;  // 2 x 2 tiles
    REQUIRE(arena(command + "--threads 1 -o one.tif").status == 0);
    REQUIRE(arena(command + "--threads 3 -o two.tif").status == 0);
    CHECK(bytes_of(arena / "one.tif") == bytes_of(arena / "two.tif"));
    const GeoTiff read = read_geotiff(arena / "one.tif");
    CHECK(read.at("verdict", 0, 3) == float(Verdict::Valid));
    CHECK(read.at("verdict", -6.5, -5) == float(Verdict::Collision));
    CHECK(read.at("verdict", 7, -7) == float(Verdict::Submerged));
    CHECK(read.at("water", 7, -7) == float(1.45));
}

TEST_CASE("export --format geotiff has the tilt and the margin of settled robots")
{
    const Arena arena;
    REQUIRE(arena("export map --format geotiff -o a.tif --layers top" + husky_option).status == 0);
    const GeoTiff read = read_geotiff(arena / "a.tif");
    CHECK(read.at("verdict", 0, 3) == float(Verdict::Valid));
    CHECK(std::abs(read.at("tilt", 0, 3)) <= 1e-6);
    CHECK(std::abs(read.at("margin", 0, 3) - 0.335) <= 1e-6);
    CHECK(std::abs(read.at("tilt", 1, 7) - 10) <= 1e-4);  // the ramp
    CHECK(std::isnan(read.at("tilt", -6.5, -5)));         // a wall: no room
    CHECK_THAT(read.metadata, Contains("role=\"unittype\">degrees<"));
    REQUIRE(arena("export map --format geotiff -o b.tif --stance level" + husky_option).status == 0);
    CHECK_FALSE(read_geotiff(arena / "b.tif").has("tilt"));
}

TEST_CASE("the bands of places in a GeoTIFF have the quantities of the poses at the centres of its cells")
{
    const TestMap map = deck_map();
    const Judge judge(map, small_box);
    const GridFrame frame = frame_around(map.bounds, 0.2);
    const TempFolder folder;
    const PlaceMeasures measures{
        .columns = {PlaceQuantity::View, PlaceQuantity::Clearance, PlaceQuantity::HeadRoom, PlaceQuantity::Roughness},
        .view_range = 2};
    for (const Stance stance : {Stance::Level, Stance::Settled}) {
        RasterOptions options{.stance = stance, .yaw = 0.3, .layers = {LayerChoice::Kind::Bottom, 0}};
        const VerdictImage image = verdict_image(judge, frame, options, measures);
        write_geotiff(map, frame, &image, {.layers = options.layers}, folder / "deck.tif");
        const GeoTiff read = read_geotiff(folder / "deck.tif");
        options.step = frame.cell;
        options.bounds = {Vec3(frame.x_of(0), frame.y_of(frame.rows - 1), 0),
                          Vec3(frame.x_of(frame.cols - 1), frame.y_of(0), 0)};
        const RasterResult plain = raster(judge, options);
        REQUIRE(plain.grid.rows == frame.rows);
        std::size_t known = 0;
        for (const PlaceQuantity quantity : measures.columns) {
            const std::vector<double> values = raster_quantity(judge, plain, quantity, measures);
            const HeightImage& band = read.band(to_string(quantity));
            for (std::size_t p = 0; p < values.size(); ++p) {
                const int col = int(std::lround((plain.poses[p].x - frame.x_of(0)) / frame.cell)),
                          row = int(std::lround((frame.y_of(0) - plain.poses[p].y) / frame.cell));
                CHECK(std::isnan(values[p]) == std::isnan(band(row, col)));
                if (std::isnan(values[p])) continue;
                CHECK(band(row, col) == Approx(values[p]).margin(1e-5));
                ++known;
            }
        }
        CHECK(known > 400);
    }
}

TEST_CASE("export --bands adds quantities of places to a GeoTIFF, and refuses others")
{
    const Arena arena;
    REQUIRE(arena("export map --format geotiff --bands clearance,view -o a.tif" + husky_option).status == 0);
    const GeoTiff read = read_geotiff(arena / "a.tif");
    CHECK(read.at("clearance", 0, 3) > 0);
    CHECK(std::isnan(read.at("clearance", -6.5, -5)));  // a wall
    CHECK(read.at("view", 0, 3) <= 1);
    const auto message = [&](const std::string& arguments) {
        const ProgramRun run = arena("export map --format geotiff -o b.tif" + arguments);
        CHECK(run.status == 2);
        return run.err;
    };
    CHECK(message(" --bands tilt" + husky_option) ==
          "spawnfield: --bands has \"tilt\", but the file of a settled robot has this band anyway; leave it out\n");
    CHECK_THAT(message(" --bands width" + husky_option), Contains("--bands has \"width\", needs one of clearance"));
    CHECK_THAT(message(" --bands room --stance level" + husky_option), Contains("--bands room is only for settled"));
    CHECK_THAT(message(" --bands view"), Contains("--bands needs --robot"));
    CHECK_THAT(message(" --bands clearance --view-range 3" + husky_option),
               Contains("--view-range is only for --bands view"));
    CHECK(arena.names() == std::set<std::string>{"map", "a.tif"});
}

TEST_CASE("GDAL reads the bands, transform, units and no-data of a GeoTIFF", "[python]")
{
    const auto python = python_with("rasterio");
    if (!python) return;
    const Arena arena;
    REQUIRE(arena("export map --format geotiff --stance level --offset 0.2 -o a.tif" + husky_option).status == 0);
    CHECK(python_accepts(*python, arena, R"(
import math, sys
import rasterio
with rasterio.open(sys.argv[1]) as d:
    assert d.descriptions == ('elevation', 'elevation_1', 'layers', 'free_height', 'slope', 'water', 'obstacle', 'verdict'), d.descriptions
    assert d.units[0] == 'm' and d.units[4] == 'degrees', d.units
    assert math.isnan(d.nodata)
    assert all(t == 'float32' for t in d.dtypes)
    assert d.transform.almost_equals(rasterio.Affine(0.2, 0, -10.1, 0, -0.2, -10.1 + 0.2 * d.height)), d.transform
    assert d.tags()['AREA_OR_POINT'] == 'Area' and d.tags()['MAP'] == 'training'
    assert d.crs is not None and not d.crs.is_geographic
    row, col = d.index(-6.5, -5)
    assert d.read(8)[row, col] == 4
    row, col = d.index(0, 3)
    assert d.read(8)[row, col] == 7 and abs(d.read(1)[row, col] + 0.05) < 1e-6
)",
                         arena / "a.tif"));
}

TEST_CASE("a PLY has the poses of the raster as points, bit by bit, with the colours of heat maps")
{
    const TempFolder folder;  // far from the origin, where float would be wrong by half a metre
    const TestMap map = map_of(
        load_scene(folder.write("scene.yaml",
                                "format: spawnfield-scene/1\nparts:\n"
                                "- {name: floor, label: terrain, box: [5, 3, 1], xyz: [500000.3, 4500000.1, 0.001]}\n"
                                "- {name: ball, sphere: 0.6, xyz: [500000.2, 4499999.7, 0.6]}\n")));
    const Judge judge(map, small_box);
    RasterOptions options = on_layer({});
    options.step = 0.1;
    const RasterResult result = raster(judge, options);
    std::string bytes;
    write_ply(result, {"two\nlines"}, [&](std::string_view piece) { bytes += piece; });
    const std::size_t body = bytes.find("end_header\n") + 11;
    CHECK(bytes.substr(0, body) ==
          "ply\nformat binary_little_endian 1.0\ncomment two lines\n"
          "comment verdict: 0 outside, 1 aerial, 2 off_terrain, 3 submerged, 4 collision, 5 steep, 6 unstable, 7 "
          "valid, 8 obstructed, 9 unreachable\n"
          "element vertex " +
              std::to_string(result.poses.size()) +
              "\nproperty double x\nproperty double y\nproperty double z\n"
              "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty uchar verdict\nend_header\n");
    constexpr std::size_t point = 3 * sizeof(double) + 4;
    REQUIRE(bytes.size() == body + point * result.poses.size());
    REQUIRE((result.counts[Verdict::Valid] > 100 && result.counts[Verdict::Collision] > 100));
    const std::map<Verdict, std::string> colours{{Verdict::Valid, "\xbd\xd5\xa7"},
                                                 {Verdict::Collision, "\xa5\x4c\x31"},
                                                 {Verdict::OffTerrain, "\x91\x82\xff"},
                                                 {Verdict::Outside, "\x72\x6e\x77"}};
    std::size_t wrong = 0;
    for (std::size_t p = 0; p < result.poses.size(); ++p) {
        const RasterPose& pose = result.poses[p];
        const char* const at = bytes.data() + body + p * point;
        std::array<double, 3> place;
        std::memcpy(place.data(), at, sizeof place);
        wrong += place != std::array{pose.x, pose.y, pose.z} ||
                 std::string(at + sizeof place, 3) != colours.at(pose.verdict) || Verdict(at[27]) != pose.verdict;
    }
    CHECK(wrong == 0);
}

TEST_CASE("points of settled robots in a PLY have roll, pitch, tilt and margin")
{
    const TestMap map = training_map();
    const Judge judge(map, husky());
    const RasterResult result = raster(judge, {.step = 1.3, .stance = Stance::Settled});
    std::string bytes;
    write_ply(result, {}, [&](std::string_view piece) { bytes += piece; });
    const std::size_t body = bytes.find("end_header\n") + 11;
    CHECK_THAT(bytes.substr(0, body), Contains("property uchar verdict\nproperty double roll\nproperty double "
                                               "pitch\nproperty double tilt\nproperty double margin\nend_header"));
    constexpr std::size_t point = 7 * sizeof(double) + 4;
    REQUIRE(bytes.size() == body + point * result.poses.size());
    for (std::size_t p = 0; p < result.poses.size(); ++p) {
        std::array<double, 4> rest;
        std::memcpy(rest.data(), bytes.data() + body + p * point + 28, sizeof rest);
        CHECK((rest[0] == result.rests[p].roll && rest[1] == result.rests[p].pitch));
        if (result.rests[p].has_pose())
            CHECK((rest[2] == result.rests[p].tilt && rest[3] == result.rests[p].margin));
        else
            CHECK((std::isnan(rest[2]) && std::isnan(rest[3])));
    }
}

TEST_CASE("export --format ply writes to a file or to standard output, the same bytes with any number of threads",
          "[python]")
{
    const Arena arena;
    const std::string command = "export map --format ply --stance level --step 0.5 --offset 0.5" + husky_option;
    const ProgramRun printed = arena(command + "--threads 1 -q");
    CHECK(printed.status == 0);
    REQUIRE(arena(command + "--threads 3 -o a.ply").status == 0);
    CHECK(bytes_of(arena / "a.ply") == printed.out);
    const ProgramRun csv = arena("raster map --dims 2 --step 0.5 --offset 0.5 -q" + husky_option);
    CHECK_THAT(printed.out, Contains("element vertex " +
                                     std::to_string(std::count(csv.out.begin(), csv.out.end(), '\n') - 1) + "\n"));
    const auto python = python_with("plyfile");
    if (!python) return;
    CHECK(python_accepts(*python, arena, R"(
import sys
from plyfile import PlyData
v = PlyData.read(sys.argv[1])['vertex']
valid = [p for p in v if p['verdict'] == 7]
assert len(valid) > 500 and all((p['red'], p['green'], p['blue']) == (0xbd, 0xd5, 0xa7) for p in valid)
assert any(abs(p['z'] - 0.45) < 1e-12 for p in valid)
)",
                         arena / "a.ply"));
}

TEST_CASE("a GLB that is loaded again has the same triangles with the same labels, also far from the origin")
{
    const std::uint64_t seed = GENERATE(range(0, 12));
    Scene scene = random_scene(seed);
    scene.primitives.clear();
    // Rounded so that float32 stores them exactly.
    for (Vec3& vertex : scene.vertices) vertex = (1024 * vertex).array().round() / 1024;
    scene = shifted(scene, Vec3(500000, -4500000, 3000));
    const TestMap map = map_of(scene);
    const TempFolder folder;
    CHECK(triangles_of(load_glb(folder, glb_bytes(map))) == triangles_of(map.scene));
}

TEST_CASE("solids in a GLB are closed, at their place, and have nearly their volume")
{
    const TempFolder folder;
    const auto [shape, volume] = GENERATE(
        std::pair{"box: [1, 2, 3]", 6.0}, std::pair{"sphere: 2", 4.0 / 3 * std::numbers::pi * 8},
        std::pair{"cylinder: {radius: 1, length: 3}", std::numbers::pi * 3},
        std::pair{"capsule: {radius: 1, length: 3}", std::numbers::pi * (3 + 4.0 / 3)});
    const TestMap map = map_of(load_scene(folder.write(
        "scene.yaml",
        std::string("format: spawnfield-scene/1\nparts:\n- {name: it, label: obstacle, rpy: [0.3, -0.4, 2],"
                    " xyz: [7.3, -2, 1], ") +
            shape + "}\n")));
    const Scene read = load_glb(folder, glb_bytes(map));
    CAPTURE(shape);
    REQUIRE(read.pieces.size() == 1);
    CHECK((read.pieces[0].solid && !read.pieces[0].open));
    double six_volumes = 0;
    double off = 0;
    const Pose& pose = map.scene.primitives[0].shape.pose;
    for (const Triangle& t : read.triangles)
        six_volumes += read.vertices[t[0]].dot(read.vertices[t[1]].cross(read.vertices[t[2]]));
    for (const Vec3& vertex : read.vertices) {  // each vertex is on the surface
        Vec3 p = (pose.rotation.transpose() * (vertex - pose.position)).cwiseAbs();
        const std::string kind = shape;
        if (kind.starts_with("box"))
            p -= Vec3(0.5, 1, 1.5);
        else if (kind.starts_with("cylinder"))
            p = Vec3(0, 0, p.z() - 1.5);
        else
            p = Vec3(Vec3(p.x(), p.y(), std::max(0.0, p.z() - (kind.starts_with("capsule") ? 1.5 : 0))).norm() -
                         (kind.starts_with("sphere") ? 2 : 1),
                     0, 0);
        off = std::max(off, p.cwiseAbs().maxCoeff());
    }
    CHECK(off < 1e-6);
    CHECK(six_volumes / 6 <= volume + 1e-5);  // the polyhedron is inside the solid
    CHECK(six_volumes / 6 > 0.98 * volume);
    const Bounds bounds = read.bounds(), expected = map.scene.bounds();
    CHECK((bounds.min - expected.min).cwiseAbs().maxCoeff() < 0.02);
    CHECK((bounds.max - expected.max).cwiseAbs().maxCoeff() < 0.02);
}

TEST_CASE("the markers of a GLB have the positions and directions of their poses, coloured by verdict")
{
    const TestMap map = map_of(
        shifted(load_scene(training_scene.substr(1, training_scene.size() - 2)), Vec3(500000, 0, 20)));
    const Robot robot = husky();
    GlbMarkers markers;
    markers.poses = {{Vec3(500001.125, -2.5, 20.1), rotation_from_rpy(0, 0, 2)},
                     {Vec3(499999, 3, 21), rotation_from_rpy(0.3, -0.2, -3)}};
    markers.verdicts = {Verdict::Valid, Verdict::Collision};
    markers.names = {"first", "the \"second\" \xff"};  // quotes, and bytes that are not UTF-8
    const GlbMarkers bare{markers.poses, {}, {}, nullptr};
    for (const Robot* of : {&robot, static_cast<const Robot*>(nullptr)}) {
        markers.robot = of;
        const std::string bytes = glb_bytes(map, markers);
        const nlohmann::json json = glb_json(bytes);
        const auto named = [&](const std::string& name) {
            for (const auto& node : json["nodes"])
                if (node["name"] == name) return node;
            FAIL("no node " << name);
            return nlohmann::json();
        };
        const auto root = json["nodes"][json["scenes"][0]["nodes"][0].get<std::size_t>()];
        CHECK(root["translation"] == nlohmann::json({500000, 20, 0}));
        for (std::size_t m = 0; m < 2; ++m) {
            const auto node = json["nodes"][named("spawns")["children"][m].get<std::size_t>()];
            if (m == 0) CHECK(node["name"] == "first");
            const auto& t = node["translation"];
            const Vec3 place(t[0].get<double>() + 500000, -t[2].get<double>(),
                             t[1].get<double>() + 20);  // z is up again
            CHECK((place - markers.poses[m].position).norm() < 1e-9);
            const auto& r = node["rotation"];
            const Eigen::Quaterniond q(r[3].get<double>(), r[0].get<double>(), r[1].get<double>(), r[2].get<double>());
            for (const Vec3& axis : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)}) {
                const Vec3 turned = q * Vec3(axis.x(), axis.z(), -axis.y());
                CHECK((Vec3(turned.x(), -turned.z(), turned.y()) - markers.poses[m].rotation * axis).norm() < 1e-9);
            }
            CHECK(node["extras"]["verdict"] == to_string(markers.verdicts[m]));
            const auto material =
                json["materials"]
                    [json["meshes"][node["mesh"].get<std::size_t>()]["primitives"][0]["material"].get<std::size_t>()];
            CHECK(material["name"] == std::string("spawn ") + to_string(markers.verdicts[m]));
        }
        CHECK(glb_json(glb_bytes(map, bare))["nodes"].size() == json["nodes"].size());
        const TempFolder folder;
        const Scene read = load_scene(folder.write("a.glb", bytes)), without = load_glb(folder, bytes);
        CHECK(read.triangles.size() > without.triangles.size());
        CHECK(triangles_of(without) == triangles_of(load_glb(folder, glb_bytes(map))));  // the scene is the same
    }
}

TEST_CASE("a map that is baked from a GLB gives nearly the same verdicts everywhere")
{
    const TestMap map = training_map();
    const TempFolder folder;
    const TestMap again = map_of(load_glb(folder, glb_bytes(map)));
    const RasterOptions options = on_layer({LayerChoice::Kind::Top, 0}, 0.15);
    const GridFrame frame = frame_around(map.bounds, 0.2);
    const VerdictImage before = verdict_image(Judge(map, husky()), frame, options),
                       after = verdict_image(Judge(again, husky()), frame, options);
    std::size_t other = 0;
    for (std::size_t c = 0; c < before.verdicts.size(); ++c) other += before.verdicts[c] != after.verdicts[c];
    CHECK(other < before.verdicts.size() / 200);  // round solids became polyhedra, and numbers float32
    CHECK(glb_bytes(map, {}, 1) == glb_bytes(map, {}, 5));
}

TEST_CASE("real scenes are the same after export to GLB", "[real]")
{
    const auto scenes = shared_scenes();
    if (!scenes) return;
    for (const char* const name : {"inspection", "kaykit_town", "nasty", "lunar_pit", "octomap"}) {
        CAPTURE(name);
        const TestMap map = map_of(load_scene(*scenes / name / "scene.yaml"), 0.5);
        const TempFolder folder;
        const Scene read = load_glb(folder, glb_bytes(map));
        const LabelCounts before = map.scene.count_labels(), after = read.count_labels();
        for (const Label label : {Label::Terrain, Label::Obstacle, Label::Water}) {
            const auto& [triangles, primitives] = before[std::size_t(label)];  // all primitives are boxes
            const double expected = double(triangles + 12 * primitives);
            CHECK(double(after[std::size_t(label)].triangles) <= expected);
            CHECK(double(after[std::size_t(label)].triangles) >= 0.999 * expected);  // some have no area in float32
            CHECK(after[std::size_t(label)].primitives == 0);
        }
        const Bounds from = map.scene.bounds(), to = read.bounds();
        CHECK(std::max((from.min - to.min).cwiseAbs().maxCoeff(), (from.max - to.max).cwiseAbs().maxCoeff()) < 1e-4);
    }
}

TEST_CASE("export --format glb draws poses of a CSV file, and reports errors in the file", "[python]")
{
    const Arena arena;
    arena.write("poses.csv", "name,x,y,z,yaw\na,0,3,0.1,0\nb,-6.5,-5,0.1,1\n");
    REQUIRE(arena("check map --poses poses.csv -o verdicts.csv" + husky_option).status == 0);
    REQUIRE(arena("export map --format glb --poses verdicts.csv -o a.glb" + husky_option).status == 0);
    const nlohmann::json json = glb_json(bytes_of(arena / "a.glb"));
    std::map<std::string, std::string> verdicts;
    for (const auto& node : json["nodes"])
        if (node.contains("extras")) verdicts[node["name"]] = node["extras"]["verdict"];
    CHECK(verdicts == std::map<std::string, std::string>{{"a", "valid"}, {"b", "collision"}});
    CHECK(arena("export map --format glb --poses verdicts.csv -q" + husky_option).out == bytes_of(arena / "a.glb"));
    arena.write("bad.csv", "x,y,z,verdict\n0,0,0,valid\n0,0,0,good\n");
    const ProgramRun bad = arena("export map --format glb --poses bad.csv -o bad.glb");
    CHECK(bad.status == 4);
    CHECK(bad.err ==
          "spawnfield: bad.csv: pose 2: column verdict is \"good\", needs the name of a verdict, for example valid or "
          "collision\n");
    CHECK_FALSE(fs::exists(arena / "bad.glb"));
    CHECK_THAT(arena("export map --format glb -o b.glb" + husky_option).err,
               Contains("--robot has no effect: without --poses there is no place to draw it"));
    const auto python = python_with("trimesh");
    if (!python) return;
    CHECK(python_accepts(*python, arena, R"(
import sys
import trimesh
s = trimesh.load(sys.argv[1])
names = set(s.graph.nodes_geometry)
assert {'floor', 'large_ball', 'a', 'b'} <= names, names
low, high = s.bounds
assert abs(low[0] + 10.1) < 1e-5 and abs(low[1] + 3.05) < 1e-5 and abs(high[2] - 10.1) < 1e-5, s.bounds
place, geometry = s.graph['a']
assert abs(place[:3, 3] - (0, 0.1, -3)).max() < 1e-6 and s.geometry[geometry].is_watertight
)",
                         arena / "a.glb"));
}

TEST_CASE("export names the option that a format needs or refuses, and then writes nothing")
{
    const Arena arena;
    const std::set<std::string> before = arena.names();
    const auto refused = [&](const std::string& arguments, const std::string& message) {
        CAPTURE(arguments);
        const ProgramRun run = arena("export map " + arguments);
        CHECK(run.status == 2);
        CHECK(run.out.empty());
        CHECK(run.err == "spawnfield: " + message + "\n");
        CHECK(arena.names() == before);
    };
    refused("--format nav2 -o a.yaml", "--format nav2 needs --robot");
    refused("--format nav2" + husky_option, "--format nav2 needs --out");
    refused("--format nav2 -o -" + husky_option,
            "--out is \"-\": --format nav2 cannot go to standard output; give a file name");
    refused("--format nav2 -o a.png" + husky_option,
            "the file's name is \"a.png\", needs the ending .yaml or .yml; the image gets the same name with .pgm");
    refused("--format nav2 --layers all -o a.yaml" + husky_option,
            "--layers is all, needs top, bottom or a number (0 is the highest layer), because a pixel of nav2 has one "
            "value");
    refused("--format nav2 --resolution 0 -o a.yaml" + husky_option, "--resolution is 0, needs > 0");
    refused("--format ply" + husky_option, "--format ply needs --step");
    refused("--format ply --step 0" + husky_option, "--step is 0, needs > 0");
    refused("--format nav2 --step 1 -o a.yaml" + husky_option, "--step is not for --format nav2; it is for ply");
    refused("--format geotiff --offset 0.2 -o a.tif", "--offset needs --robot");
    refused("--format geotiff --settle -o a.tif", "--settle needs --robot");
    refused("--format glb --offset 1 -o a.glb" + husky_option,
            "--offset is not for --format glb; it is for nav2, geotiff, ply");
    refused("--format geotiff --layers all -o a.tif",
            "--layers is all, needs top, bottom or a number (0 is the highest layer), because a pixel of geotiff has "
            "one value");
    CHECK(arena("export map --format nav3 -o a.yaml" + husky_option).status == 2);
    CHECK(arena("export nowhere --format nav2 -o a.yaml" + husky_option).status == 4);
    CHECK(arena("export map --format nav2 -o none/a.yaml" + husky_option).status == 1);
    CHECK(arena("export map --format geotiff -o none/a.tif").status == 1);
    CHECK(arena("export map --format geotiff -o /dev/full").status == 1);
    CHECK(arena.names() == before);
}
