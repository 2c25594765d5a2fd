#include "this_build.h"
#include "catch.h"
#include "geometry/geometry_impl.h"
#include "temp_folder.h"
#include "test_map.h"
#include "worlds/hand_scene.h"

#include <spawnfield/error.h>
#include <spawnfield/poses.h>

#include <opencv2/imgcodecs.hpp>

using namespace spawnfield;
namespace fs = std::filesystem;

namespace {

const fs::path training = source_folder() + "/maps/training/scene.yaml";

BakeReport bake_training(const fs::path& folder, int threads = 0)
{
    BakeOptions options{.resolution = 0.2, .threads = threads};
    return bake(load_scene(training), training, folder, options);
}

std::vector<std::string> names_in(const fs::path& folder)
{
    std::vector<std::string> out;
    for (const auto& entry : fs::directory_iterator(folder)) out.push_back(entry.path().filename().string());
    std::sort(out.begin(), out.end());
    return out;
}

}  // namespace

TEST_CASE("a map that is read back has the geometry and the answers of the one that was baked")
{
    const TempFolder temp;
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
        const Scene scene = random_scene(seed);
        const fs::path file = temp.write("scene.txt", "stands for the scene's file");
        BakeOptions options{.resolution = 0.5};
        const BakeReport report = bake(scene, file, temp / "map", options);
        const Map map = read_map(temp / "map");
        CHECK(map.hash == report.hash);
        CHECK(map.bounds.min == scene.bounds().min);
        CHECK(map.bounds.max == scene.bounds().max);
        const TestMap fresh = map_of(scene);
        CHECK(map.geometry.impl().forests[0]->tiles.bytes() == fresh.geometry.impl().forests[0]->tiles.bytes());
        CHECK(map.geometry.parts().size() == scene.parts.size());
        for (std::size_t part = 0; part < map.geometry.parts().size(); ++part)
            CHECK(map.geometry.parts()[part].name == scene.parts[part].name);
        const Robot robot = random_robot(seed);
        const Judge judge(map, robot), fresh_judge(fresh, robot);
        const auto poses = random_poses(scene, seed, 500);
        const auto here = judge.check(poses), there = fresh_judge.check(poses);
        for (std::size_t i = 0; i < poses.size(); ++i) {
            CHECK(here[i].verdict == there[i].verdict);
            CHECK(here[i].ground.has_value() == there[i].ground.has_value());
            if (here[i].ground && there[i].ground) CHECK(here[i].ground->height == there[i].ground->height);
        }
    }
}

TEST_CASE("a map folder has its files, and other programs can open them")
{
    const TempFolder temp;
    const BakeReport report = bake_training(temp / "map");
    CHECK(names_in(temp / "map") == std::vector<std::string>{"bounds.bin", "geometry.bin", "heightmap.png", "map.yaml",
                                                             "occupancy.bt", "preview.png", "terrain.tiff"});
    CHECK(report.layers == 2);
    const Map map = read_map(temp / "map");
    const TerrainMap terrain = read_terrain(map);
    CHECK(terrain.frame.rows == 101);
    std::vector<cv::Mat> pages;
    REQUIRE(cv::imreadmulti((temp / "map/terrain.tiff").string(), pages, cv::IMREAD_UNCHANGED));
    REQUIRE(pages.size() == terrain.pages.size());
    for (std::size_t p = 0; p < pages.size(); ++p) {
        REQUIRE(pages[p].type() == CV_32F);
        const HeightImage image = page_image(terrain, terrain.pages[p].name);
        REQUIRE(pages[p].rows == image.rows);
        for (int row = 0; row < image.rows; row += 7)
            for (int col = 0; col < image.cols; col += 3) {
                const float theirs = pages[p].at<float>(row, col);
                CHECK((theirs == image(row, col) || (std::isnan(theirs) && std::isnan(image(row, col)))));
            }
    }
}

TEST_CASE("heightmap.png has the top layer, with the range that map.yaml states")
{
    const TempFolder temp;
    Scene scene;
    hand::add_mesh(scene, Label::Terrain,
                   hand::moved(hand::rectangle(4, 4), {{0, 0, 3}, rotation_from_rpy(0, 0.4, 0)}));
    const fs::path file = temp.write("scene.txt", "");
    BakeOptions options{.resolution = 0.1, .bounds = {Vec3(-3, -2, 0), Vec3(3, 2, 5)}};
    bake(scene, file, temp / "map", options);
    const cv::Mat image = cv::imread((temp / "map/heightmap.png").string(), cv::IMREAD_UNCHANGED);
    REQUIRE(image.type() == CV_16U);
    const std::string yaml = bytes_of(temp / "map/map.yaml");
    double low = 0, high = 0;
    REQUIRE(std::sscanf(yaml.c_str() + yaml.find("heightmap: "), "heightmap: {z: [%lf, %lf]", &low, &high) == 2);
    const HeightImage top = page_image(read_terrain(read_map(temp / "map")), "height.0");
    for (int row = 0; row < image.rows; ++row)
        for (int col = 0; col < image.cols; ++col) {
            const std::uint16_t pixel = image.at<std::uint16_t>(row, col);
            CHECK((pixel == 0) == std::isnan(top(row, col)));
            if (pixel > 0) CHECK(low + pixel / 65535.0 * (high - low) == Approx(top(row, col)).margin(1e-4));
        }
}

TEST_CASE("a bake is the same bytes with any number of threads")
{
    const TempFolder temp;
    bake_training(temp / "1", 1);
    for (const int threads : {2, 8}) {
        const std::string name = std::to_string(threads);
        bake_training(temp / name, threads);
        for (const std::string& file : names_in(temp / "1")) {
            CAPTURE(threads, file);
            CHECK(bytes_of(temp / ("1/" + file)) == bytes_of(temp / (name + "/" + file)));
        }
    }
}

TEST_CASE("a bake that fails or is stopped leaves the old map as it was and nothing beside it")
{
    const TempFolder temp;
    bake_training(temp / "map");
    const std::string before = bytes_of(temp / "map/map.yaml");
    const BakeOptions options{.resolution = 0.2, .progress = [](double share) {
                                  if (share > 0.3) throw std::runtime_error("stopped");
                              }};
    CHECK_THROWS_WITH(bake(load_scene(training), training, temp / "map", options), "stopped");
    Scene no_terrain;
    hand::add_mesh(no_terrain, Label::Obstacle, hand::rectangle(1, 1));
    CHECK_THROWS_WITH(bake(no_terrain, training, temp / "map", {}), Contains("has no terrain"));
    CHECK(bytes_of(temp / "map/map.yaml") == before);
    CHECK(names_in(temp.path()) == std::vector<std::string>{"map"});
    verify_map(temp / "map");
}

TEST_CASE("a folder that is not a map is not replaced")
{
    const TempFolder temp;
    temp.write("precious/work.txt", "years");
    CHECK_THROWS_AS(bake_training(temp / "precious"), OutputError);
    CHECK(bytes_of(temp / "precious/work.txt") == "years");
    fs::create_directory(temp / "empty");
    bake_training(temp / "empty");
    verify_map(temp / "empty");
}

TEST_CASE("every altered byte is detected: by queries in what they read, by verify everywhere")
{
    const TempFolder temp;
    bake_training(temp / "map");
    for (const std::string& name : names_in(temp / "map")) {
        const fs::path file = temp / ("map/" + name);
        const std::string good = bytes_of(file);
        for (const std::size_t at : {std::size_t(9), good.size() / 3, good.size() / 2, good.size() - 5}) {
            std::string bad = good;
            bad[at] = char(bad[at] ^ 0x10);
            temp.write("map/" + name, bad);
            CAPTURE(name, at);
            CHECK_THROWS_WITH(verify_map(temp / "map"), Contains(name));
            if (name == "map.yaml") CHECK_THROWS_WITH(read_map(temp / "map"), Contains(name));
            if (name == "geometry.bin") {
                const auto read_all = [&] {
                    read_map(temp / "map")
                        .geometry.impl()
                        .visit_in({-1e9, -1e9, 1e9, 1e9}, [](const Tile&, std::uint32_t) {});
                };
                CHECK_THROWS_WITH(read_all(), Contains(name));
            }
        }
        temp.write("map/" + name, good.substr(0, good.size() - 1));
        CHECK_THROWS_AS(read_map(temp / "map"), FileError);  // the sizes of all files are checked
        temp.write("map/" + name, good);
        CHECK_NOTHROW(verify_map(temp / "map"));
    }
}

TEST_CASE("the default occupancy resolution is coarser, with a notice, if a map would have too many voxels")
{
    const TempFolder temp;
    const fs::path file = temp.write("scene.txt", "");
    Scene far;
    hand::add_mesh(far, Label::Terrain, hand::moved(hand::rectangle(2, 2), {{9000, 0, 0}, Mat3::Identity()}));
    CHECK(bake(far, file, temp / "map", {}).notices.empty());
    CHECK(read_map(temp / "map").occupancy_resolution == 0.25);
    hand::add_mesh(far, Label::Terrain, hand::moved(hand::rectangle(2, 2), {{-9000, 0, 0}, Mat3::Identity()}));
    const BakeReport report = bake(far, file, temp / "map", {});
    REQUIRE(report.notices.size() == 1);
    CHECK_THAT(report.notices[0], Contains("occupancy resolution is 0.5 m"));
    CHECK(read_map(temp / "map").occupancy_resolution == 0.5);
    CHECK(read_map(temp / "map").resolution == 0.1);
}
