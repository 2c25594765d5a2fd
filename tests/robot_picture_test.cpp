#include "catch.h"
#include "program.h"

#include <spawnfield/error.h>
#include <spawnfield/robot_picture.h>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>

using namespace spawnfield;
using Catch::Contains;

namespace {

/// Returns the sizes of the areas in the colour of the first link, the largest first, in pixels.
std::vector<cv::Size> blue_areas(const cv::Mat& image)
{
    cv::Mat mask, labels, stats, centroids;
    cv::inRange(image, cv::Scalar(241, 212, 161), cv::Scalar(243, 214, 163),
                mask);  // blue, green and red of a lightened 56b4e9
    const int count = cv::connectedComponentsWithStats(mask, labels, stats, centroids);
    std::vector<std::pair<int, cv::Size>> areas;
    for (int k = 1; k < count; ++k)
        areas.emplace_back(-stats.at<int>(k, cv::CC_STAT_AREA),
                           cv::Size(stats.at<int>(k, cv::CC_STAT_WIDTH), stats.at<int>(k, cv::CC_STAT_HEIGHT)));
    std::stable_sort(areas.begin(), areas.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<cv::Size> out;
    for (const auto& [area, size] : areas) out.push_back(size);
    return out;
}

Robot boxes(const TempFolder& folder, const std::string& more = "")
{
    return load_robot(
        folder
            .write("robot.yaml",
                   "format: spawnfield-robot/1\nparts:\n  - {name: hull, box: [2, 1, 0.5], xyz: [0, 0, 0.4]}\n" + more)
            .string());
}

}  // namespace

TEST_CASE("a robot is drawn from three sides to one scale")
{
    const TempFolder folder;
    write_robot_picture(boxes(folder), folder / "robot.png");
    const cv::Mat image = cv::imread((folder / "robot.png").string());
    REQUIRE(image.cols == 1000);
    const auto areas = blue_areas(image);
    REQUIRE(areas.size() >= 3);
    const double metre = areas[0].width / 2.0;  // from above it is 2 x 1 m
    CHECK(areas[0].height == Approx(metre).margin(5));
    CHECK(areas[1].width == Approx(2 * metre).margin(5));  // from the right it is 2 x 0.5 m
    CHECK(areas[1].height == Approx(0.5 * metre).margin(5));
    CHECK(areas[2].width == Approx(metre).margin(5));  // from the front it is 1 x 0.5 m
    CHECK(areas[2].height == Approx(0.5 * metre).margin(5));
}

TEST_CASE("robots of any shape are drawn, in the same bytes each time")
{
    const TempFolder folder;
    for (const char* const name :
         {"box:0.001,0.001,0.001", "box:100,0.1,0.1", "box:0.1,100,0.1", "box:0.1,0.1,100", "box:1,1,1@50,50,50"}) {
        const Robot robot = load_robot(name);
        write_robot_picture(robot, folder / "a.png");
        write_robot_picture(robot, folder / "b.png");
        const std::string bytes = bytes_of(folder / "a.png");
        CHECK(bytes.size() > 1000);
        CHECK(bytes == bytes_of(folder / "b.png"));
        const cv::Mat image = cv::imread((folder / "a.png").string());
        CHECK(image.cols == 1000);
        CHECK(image.rows < 1600);
    }
    CHECK_THROWS_AS(write_robot_picture(load_robot("box:1,1,1"), folder / "none" / "a.png"), OutputError);
}

TEST_CASE("a robot's turning radius reaches its farthest corner as seen from above")
{
    const TempFolder folder;
    CHECK(turning_radius(boxes(folder)) == Approx(std::hypot(1, 0.5)));
    CHECK(turning_radius(boxes(folder, "  - {sphere: 0.5, xyz: [0, 3, 0]}\n")) == Approx(3.5).epsilon(2e-3));
    CHECK(turning_radius(boxes(folder, "  - {cylinder: {radius: 0.5, length: 4}, rpy_deg: [90, 0, 0]}\n")) ==
          Approx(std::hypot(2, 0.5)).epsilon(2e-3));
    CHECK(turning_radius(boxes(folder, "  - {capsule: {radius: 0.5, length: 4}, rpy_deg: [90, 0, 0]}\n")) ==
          Approx(2.5).epsilon(2e-3));
}

TEST_CASE("contacts come from the file, or the text states that they are derived")
{
    const TempFolder folder;
    CHECK_FALSE(robot_contacts(boxes(folder)).given);
    CHECK(robot_contacts(boxes(folder)).points.size() == 4);
    const RobotContacts given = robot_contacts(boxes(folder, "contacts: [[1, 0, 0], [0, 1, 0], [-1, 0, 0]]\n"));
    CHECK(given.given);
    CHECK(given.points.size() == 3);
}

TEST_CASE("info describes links, meshes, footprint and contacts of a robot, and draws it")
{
    const TempFolder folder;
    boxes(folder);
    const ProgramRun run = run_program(folder, "info robot.yaml --picture robot.png");
    CHECK(run.status == 0);
    CHECK_THAT(run.out, Contains("  hull: box, from -1, -0.5, 0.15 to 1, 0.5, 0.65 m\n") &&
                            Contains("turns within 1.118") && Contains("contacts\n  none given") &&
                            Contains("lowest point\n  -1, "));
    CHECK(bytes_of(folder / "robot.png").starts_with("\x89PNG"));
    CHECK(run_program(folder, "info robot.yaml --picture none/robot.png").status == 1);
}
