#include "catch.h"
#include "scene_text.h"
#include "shared_scenes.h"

#include <spawnfield/column.h>
#include <spawnfield/error.h>

#include <Eigen/Geometry>
#include <opencv2/imgcodecs.hpp>

#include <fstream>
#include <limits>

using namespace spawnfield;

namespace {

constexpr double hole = std::numeric_limits<double>::quiet_NaN();

using Pixels = std::vector<std::vector<double>>;

/// Writes the rows as an image with the given OpenCV depth (type of pixels).
void write_image(const TempFolder& folder, const std::string& name, const Pixels& rows, int depth)
{
    cv::Mat image(int(rows.size()), int(rows[0].size()), CV_64F);
    for (int row = 0; row < image.rows; ++row)
        for (int col = 0; col < image.cols; ++col)
            image.at<double>(row, col) = rows[std::size_t(row)][std::size_t(col)];
    cv::Mat converted;
    image.convertTo(converted, depth);
    REQUIRE(cv::imwrite((folder / name).string(), converted));
}

/// Loads a terrain part with a heightmap file in the folder.
Scene load(const TempFolder& folder, const std::string& keys, const std::string& more = "")
{
    return load_parts(folder, "  - {name: ground, label: terrain, heightmap: {" + keys + "}" + more + "}\n");
}

double height(const Scene& scene, double x, double y)
{
    const Column column = column_at(Geometry(scene), x, y);
    REQUIRE(column.layers.size() == 1);
    return column.layers[0];
}

bool has_ground(const Scene& scene, double x, double y) { return !column_at(Geometry(scene), x, y).layers.empty(); }

}  // namespace

TEST_CASE("an 8-bit image spans z from pixel 0 to pixel 255, and size from first to last pixel centre")
{
    const TempFolder folder;
    write_image(folder, "a.png", {{0, 51, 255}, {102, 153, 204}}, CV_8U);
    const Scene scene = load(folder, "file: a.png, size: [4, 2], z: [-10, 41]");
    CHECK(scene.triangles.size() == 4);
    CHECK(scene.vertices.size() == 6);
    CHECK(scene.parts[0].sheet_pieces == 1);
    const double step = 51.0 / 255;
    // Row 0 is the largest y, column 0 the smallest x.
    CHECK(height(scene, -2, 1) == Approx(-10));
    CHECK(height(scene, 0, 1) == Approx(-10 + 51 * step));
    CHECK(height(scene, 2, 1) == Approx(41));
    CHECK(height(scene, -2, -1) == Approx(-10 + 102 * step));
    CHECK(height(scene, 2, -1) == Approx(-10 + 204 * step));
    CHECK(height(scene, -1, 1) == Approx(-10 + 25.5 * step));
    CHECK_FALSE(has_ground(scene, 2.001, 0));
    CHECK_FALSE(has_ground(scene, 0, -1.001));
}

TEST_CASE("a 16-bit image spans z to pixel 65535")
{
    const TempFolder folder;
    write_image(folder, "a.png", {{0, 65535}, {1, 32768}}, CV_16U);
    const Scene scene = load(folder, "file: a.png, size: [1, 1], z: [100, 165.535]");
    CHECK(height(scene, -0.5, 0.5) == Approx(100));
    CHECK(height(scene, 0.5, 0.5) == Approx(165.535));
    CHECK(height(scene, -0.5, -0.5) == Approx(100.001).epsilon(1e-12));
    CHECK(height(scene, 0.5, -0.5) == Approx(132.768).epsilon(1e-12));
}

TEST_CASE("z may be reversed, and then dark is high")
{
    const TempFolder folder;
    write_image(folder, "a.png", {{0, 0}, {255, 255}}, CV_8U);
    const Scene scene = load(folder, "file: a.png, size: [2, 2], z: [5, 1]");
    CHECK(height(scene, 0, 1) == Approx(5));
    CHECK(height(scene, 0, -1) == Approx(1));
}

TEST_CASE("the diagonal that splits a cell starts at the smaller column and row")
{
    const TempFolder folder;
    // Along that diagonal all heights are 0. The other diagonal would give height 1 in the middle.
    write_image(folder, "a.tiff", {{0, 1}, {1, 0}}, CV_32F);
    const Scene valley = load(folder, "file: a.tiff, size: [2, 2]");
    CHECK(height(valley, 0, 0) == Approx(0).margin(1e-12));
    CHECK(height(valley, 0.5, -0.5) == Approx(0).margin(1e-12));
    CHECK(height(valley, 0.5, 0.5) == Approx(0.5));
    CHECK(height(valley, 0.25, 0) == Approx(0.125));
}

TEST_CASE("a float image is metres, and has no ground where a corner is NaN")
{
    const TempFolder folder;
    write_image(folder, "a.tiff", {{1.5, 2.5, 3.5}, {1.25, 2.25, 3.25}, {hole, 2, 3}}, CV_32F);
    const Scene scene = load(folder, "file: a.tiff, size: [2, 2]");
    CHECK(height(scene, -1, 1) == 1.5);
    CHECK(height(scene, 1, 1) == 3.5);
    CHECK(height(scene, 0, 0) == 2.25);
    CHECK(scene.triangles.size() == 7);
    CHECK_FALSE(has_ground(scene, -0.9, -0.9));  // the half of the cell beside the hole
    CHECK(has_ground(scene, -0.4, -0.1));        // its other half
}

TEST_CASE("a single height among holes is not ground and does not widen the bounds")
{
    const TempFolder folder;
    write_image(folder, "a.tiff", {{hole, hole, hole, hole}, {99, hole, 2, 3}, {hole, hole, 2, 3}}, CV_32F);
    const Scene scene = load(folder, "file: a.tiff, size: [3, 2]");
    CHECK(scene.triangles.size() == 2);
    CHECK(scene.vertices.size() == 4);
    CHECK(scene.bounds().max.z() == 3);
    CHECK(scene.bounds().min.x() == 0.5);
}

TEST_CASE("images of doubles are read like images of floats")
{
    const TempFolder folder;
    write_image(folder, "a.tiff", {{1, 2}, {3, 4}}, CV_64F);
    CHECK(height(load(folder, "file: a.tiff, size: [2, 2]"), 1, -1) == 4);
}

TEST_CASE("a heightmap has the pose and the sides of its part")
{
    const TempFolder folder;
    write_image(folder, "a.tiff", {{1, 2}, {3, 4}}, CV_32F);
    const Scene scene = load(folder, "file: a.tiff, size: [2, 2]",
                             ", xyz: [10, 20, 30], rpy_deg: [0, 0, 90], sides: up");
    CHECK(scene.pieces[0].sides_up);
    CHECK(scene.pieces[0].bottom == Approx(31));
    CHECK(height(scene, 9, 19) == Approx(31));   // column 0, row 0: (-1, 1) turns to (-1, -1)
    CHECK(height(scene, 11, 21) == Approx(34));  // the last pixel: (1, -1) turns to (1, 1)
    for (const Triangle& t : scene.triangles) {
        const Vec3 &a = scene.vertices[t[0]], &b = scene.vertices[t[1]], &c = scene.vertices[t[2]];
        CHECK((b - a).cross(c - a).z() > 0);
    }
}

TEST_CASE("invalid heightmaps are refused by name")
{
    const TempFolder folder;
    write_image(folder, "grey.png", {{0, 255}, {0, 255}}, CV_8U);
    write_image(folder, "float.tiff", {{0, 1}, {0, 1}}, CV_32F);
    write_image(folder, "thin.png", {{0, 255}}, CV_8U);
    write_image(folder, "hole.tiff", {{hole, hole}, {hole, hole}}, CV_32F);
    write_image(folder, "inf.tiff", {{0, 1}, {std::numeric_limits<double>::infinity(), 1}}, CV_32F);
    cv::imwrite((folder / "colour.png").string(), cv::Mat(4, 4, CV_8UC3, cv::Scalar(1, 2, 3)));
    folder.write("text.png", "no picture");
    cv::imwrite((folder / "photo.jpg").string(), cv::Mat(4, 4, CV_8U, cv::Scalar(7)));
    const std::string start = (folder / "scene.yaml").string() + ": part \"ground\": heightmap.";
    const auto used = [&](const char* file) {
        return start + "file cannot be used: " + (folder / file).string() + ": ";
    };
    CHECK_THROWS_WITH(load(folder, "file: none.png, size: [1, 1], z: [0, 1]"),
                      used("none.png") + "does not exist; is the path right? (line 4)");
    CHECK_THROWS_WITH(load(folder, "file: text.png, size: [1, 1], z: [0, 1]"),
                      used("text.png") +
                          "is not PNG, TIFF or an ESRI ASCII grid; convert it to one of them, or give its layout with "
                          "the key raw (line 4)");
    CHECK_THROWS_WITH(load(folder, "file: photo.jpg, size: [1, 1], z: [0, 1]"),
                      used("photo.jpg") +
                          "is not PNG, TIFF or an ESRI ASCII grid; convert it to one of them, or give its layout with "
                          "the key raw (line 4)");
    CHECK_THROWS_WITH(
        load(folder, "file: colour.png, size: [1, 1], z: [0, 1]"),
        used("colour.png") + "has a pixel that is coloured (column 0, row 0), needs only grey, opaque pixels (line 4)");
    CHECK_THROWS_WITH(load(folder, "file: thin.png, size: [1, 1], z: [0, 1]"),
                      used("thin.png") + "has 2 x 1 pixels, needs at least 2 x 2 (line 4)");
    CHECK_THROWS_WITH(
        load(folder, "file: grey.png, size: [1, 1]"),
        used("grey.png") +
            "is an integer image; give heightmap.z (heights in m of the value 0 and of the largest value) (line 4)");
    CHECK_THROWS_WITH(load(folder, "file: float.tiff, size: [1, 1], z: [0, 1]"),
                      used("float.tiff") + "has heights in metres already; remove heightmap.z (line 4)");
    CHECK_THROWS_WITH(
        load(folder, "file: inf.tiff, size: [1, 1]"),
        used("inf.tiff") + "row 1, column 0 is infinite, needs a finite height or NaN (no ground) (line 4)");
    CHECK_THROWS_WITH(load(folder, "file: hole.tiff, size: [1, 1]"),
                      used("hole.tiff") + "has no heights: every pixel is NaN or no-data (line 4)");
    CHECK_THROWS_WITH(load(folder, "file: grey.png, size: [0, 1], z: [0, 1]"),
                      start + "size has 0, needs > 0 (line 4)");
    CHECK_THROWS_WITH(load(folder, "size: [1, 1], z: [0, 1]"), start + "file is missing");
    CHECK_THROWS_WITH(load(folder, "file: grey.png, size: [1, 1], zed: [0, 1]"),
                      start + "zed is not a known key; known keys: file, size, cell, z, origin, nodata, raw (line 4)");
}

TEST_CASE("real heightmaps have the heights that their sources document", "[real]")
{
    const auto shared = shared_scenes();
    if (!shared) return;
    const Scene pit = load_scene(*shared / "lunar_pit/scene.yaml");
    CHECK(pit.triangles.size() == 2 * 256 * 256);
    CHECK((pit.bounds().max - pit.bounds().min).x() == Approx(514));
    CHECK(pit.bounds().min.z() == Approx(-110));
    CHECK(pit.bounds().max.z() == Approx(-110 + 254 * 119.0 / 255));

    const TempFolder folder;
    std::filesystem::copy_file(*shared / "dem/moon_tif/dem_moon.tif", folder / "moon.tif");
    const Scene moon = load(folder, "file: moon.tif, size: [77.65, 77.65]");
    CHECK(moon.triangles.size() == 2 * 32 * 32);
    CHECK(moon.bounds().min.z() == Approx(-212.30).margin(0.01));
    CHECK(moon.bounds().max.z() == Approx(-205.44).margin(0.01));

    // The image of the river was made from an ESRI grid of 50 x 37 heights, the northernmost row first, after six
    // header lines.
    const Scene river = load_scene(*shared / "dem/river/scene.yaml");
    const Geometry geometry(river);
    std::ifstream grid(*shared / "dem/river/DEM-kootenai_37x50_1x1.asc");
    std::string line;
    for (int header = 0; header < 6; ++header) std::getline(grid, line);
    double largest = 0;
    for (int row = 0; row < 37; ++row)
        for (int col = 0; col < 50; ++col) {
            double wanted = 0;
            REQUIRE(grid >> wanted);
            const Column column = column_at(geometry, col - 24.5, 18 - row);
            REQUIRE(column.layers.size() == 1);
            largest = std::max(largest, std::abs(column.layers[0] - wanted));
        }
    CHECK(largest < 1e-4);
    CHECK(column_at(geometry, 0.3, 0.1).water == std::vector<double>{538.8});
}
