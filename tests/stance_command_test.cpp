#include "arena.h"

#include <spawnfield/poses.h>

#include <nlohmann/json.hpp>

#include <algorithm>

using namespace spawnfield;

namespace {

/// Where the training arena has a ramp that rises by 10 degrees.
const std::string on_ramp = " --region 4,5.5,7,8.5 ";

std::string value_of(const std::string& text, const std::string& key)
{
    const std::size_t at = text.find(key + ": ");
    if (at == std::string::npos) return "";
    const std::size_t begin = at + key.size() + 2;
    return text.substr(begin, text.find('\n', begin) - begin);
}

}  // namespace

TEST_CASE("sample answers for settled robots: the same as with --settle, tilted on a slope, valid as written")
{
    const Arena arena;
    const std::string query = "sample map -n 20 --yaw random -o ";
    const ProgramRun run = arena(query + "spawns.csv" + on_ramp + husky_option);
    CHECK(run.status == 0);
    CHECK_THAT(run.err, Contains("20 of 20 spawns; settled; "));
    for (const std::string same : {"--settle", "--stance settled"}) {
        CHECK(arena(query + "same.csv " + same + on_ramp + husky_option).status == 0);
        CHECK(bytes_of(arena / "same.csv") == bytes_of(arena / "spawns.csv"));
    }
    const std::vector<Pose> poses = read_poses(arena / "spawns.csv").poses;
    REQUIRE(poses.size() == 20);
    const auto tilted = std::count_if(poses.begin(), poses.end(),
                                      [](const Pose& pose) { return pose.rotation(2, 2) < std::cos(0.1); });
    CHECK(tilted > 5);
    CHECK(arena("check map --poses spawns.csv --require-valid" + husky_option).status == 0);

    CHECK(arena(query + "level.csv --stance level --offset 0.3" + on_ramp + husky_option).status == 0);
    for (const Pose& pose : read_poses(arena / "level.csv").poses) CHECK(pose.rotation(2, 2) == 1);
}

TEST_CASE("search answers for level robots, and with --settle for settled ones, valid as written")
{
    const Arena arena;
    const std::string query = "search map -n 10 --min-distance 0.5 --yaw random -o ", ramp = " --region 4,5.5,7,8.5";
    const ProgramRun run = arena(query + "spawns.csv --settle" + ramp + husky_option);
    CHECK(run.status == 0);
    CHECK_THAT(run.err, Contains("10 of 10 spawns; settled; "));
    CHECK(arena(query + "same.csv --stance settled --threads 1" + ramp + husky_option).status == 0);
    CHECK(bytes_of(arena / "same.csv") == bytes_of(arena / "spawns.csv"));
    const std::vector<Pose> poses = read_poses(arena / "spawns.csv").poses;
    REQUIRE(poses.size() == 10);
    const auto tilted = std::count_if(poses.begin(), poses.end(),
                                      [](const Pose& pose) { return pose.rotation(2, 2) < std::cos(0.1); });
    CHECK(tilted > 0);
    CHECK(arena("check map --poses spawns.csv --require-valid" + husky_option).status == 0);
    CHECK(arena(query + "lifted.csv --settle --lift 0.05" + ramp + husky_option).status == 0);
    CHECK(std::abs(read_poses(arena / "lifted.csv").poses[0].position.z() - poses[0].position.z() - 0.03) <= 1e-9);
    CHECK(
        arena("search map -n 5 --min-distance 0.5 -o gentle.csv --settle --max-slope 5" + ramp + husky_option).status ==
        0);
    for (const Pose& pose : read_poses(arena / "gentle.csv").poses) CHECK(pose.rotation(2, 2) >= std::cos(0.0873));

    CHECK(arena(query + "standard.csv" + husky_option).status == 0);
    CHECK(arena(query + "level.csv --stance level" + husky_option).status == 0);
    CHECK(bytes_of(arena / "standard.csv") == bytes_of(arena / "level.csv"));
    for (const Pose& pose : read_poses(arena / "level.csv").poses) CHECK(pose.rotation(2, 2) == 1);

    const ProgramRun rule = arena("search map -n 3 --settle --yaw facing:0,0 --format json" + husky_option);
    CHECK(rule.status == 0);
    CHECK_THAT(rule.out, Contains("\"yaw\": \"facing:0,0\"") && Contains("\"lift\": 0.02"));
    const ProgramRun few = arena("search map -n 3 --settle --min-distance 100 --max-failures 50" + husky_option);
    CHECK(few.status == 3);
    CHECK_THAT(few.err, Contains("a smaller --min-distance") && Contains("more --max-failures or wider --bounds may"));
}

TEST_CASE("settled spawns have their tilt and margin in CSV and JSON, and what their rule measured")
{
    const Arena arena;
    const std::string query = "sample map -n 5 -q --yaw best:4:clearance" + on_ramp + husky_option;
    REQUIRE(arena(query + "-o spawns.csv").status == 0);
    REQUIRE(arena(query + "-o named.csv --name 'r{i}'").status == 0);
    const PoseTable spawns = read_poses(arena / "spawns.csv"), named = read_poses(arena / "named.csv");
    CHECK(spawns.header == "x,y,z,roll,pitch,yaw,tilt,margin,clearance");
    CHECK(named.header == "name," + spawns.header);
    CHECK(named.rows[0] == "r1," + spawns.rows[0]);
    REQUIRE(arena("check map --settle --poses spawns.csv -q -o checked.csv" + husky_option).status == 0);
    const nlohmann::json json = nlohmann::json::parse(arena(query + "--format json").out);
    const PoseTable checked = read_poses(arena / "checked.csv");
    for (std::size_t i = 0; i < 5; ++i)
        for (const std::string column : {"tilt", "margin"}) {
            const double value = std::stod(column_of(spawns, column)[i]);
            // `check --settle` starts from a yaw that was turned into a rotation and back.
            CHECK(value == Approx(std::stod(column_of(checked, column)[i])).margin(1e-9));
            CHECK(json["poses"][i][column] == value);
            CHECK(json["poses"][i]["clearance"] == std::stod(column_of(spawns, "clearance")[i]));
        }
    CHECK_THAT(arena("sample map -n 1 -q --yaw along" + husky_option).out, Contains(",tilt,margin,way\n"));
    const std::string level = "sample map -n 1 -q --stance level" + husky_option;
    CHECK(arena(level).out.starts_with("x,y,z,roll,pitch,yaw\n"));
    CHECK_FALSE(nlohmann::json::parse(arena(level + "--format json").out)["poses"][0].contains("tilt"));
}

TEST_CASE("if too few spawns are found, the advice names the options that the verdicts point to")
{
    const Arena arena;
    const auto advice = [&](const std::string& command) {
        const ProgramRun run = arena(command + husky_option);
        CAPTURE(command);
        CHECK(run.status == 3);
        const std::size_t at = std::min(run.err.find("notice: only"), run.err.find("notice: none"));
        return at == std::string::npos ? "" : run.err.substr(at, run.err.find('\n', at) - at);
    };
    const std::string sample = "sample map -n 100000 --min-distance 0.3 --region 1.2,5.4,1.9,6.2";  // on the ramp
    CHECK_THAT(advice(sample + " --max-slope 5"), Contains("a larger --max-slope") && !Contains("--friction"));
    CHECK_THAT(advice(sample + " --friction 0.1"),
               Contains("a smaller --min-stability, a larger --friction, a larger --max-tilt or a wider --region may"));
    CHECK_THAT(advice(sample), !Contains("--friction") && !Contains("--max-slope") && !Contains("--z"));
    CHECK_THAT(advice(sample + " --z 0:1"), Contains("a wider --z"));
    CHECK_THAT(advice("sample map -n 10000 --min-distance 0.3 --region 5.5,2,6.5,3 --drop 5"),  // below the block
               Contains("a smaller --drop or --lift") && !Contains("--friction"));
    const std::string air = "draws nearer to the ground with --z LOW:HIGH (",
                      search = "search map -n 50 --max-failures 50 ";
    for (const std::string stance : {"", "--settle "}) {
        CHECK_THAT(advice(search + stance + "--bounds -9,-9,2,9,9,9"),
                   Contains(air) && Contains(" positions were aerial), more"));
        CHECK_THAT(advice(search + stance + "--min-distance 9 --z=0:0.3"), !Contains(air));
    }
}

TEST_CASE("draws above ground beyond the heights of the box are not called off the region without a region")
{
    const Arena arena;
    const std::string search = "search map -n 3 --settle --z 0.2:1.5" + husky_option;
    CHECK_THAT(arena(search).err,
               Contains(" above ground beyond the heights of --z or --bounds;") && !Contains("off the region"));
    CHECK_THAT(arena(search + on_ramp).err, Contains(" off the region;"));
}

TEST_CASE("heatmap and export answer for settled robots unless they are asked for level ones")
{
    const Arena arena;
    const std::string robot = husky_option + "--yaw 30deg --quiet ";
    for (const std::string command :
         {"heatmap map --step 1 -o ", "export map --format nav2 --resolution 1 -o ",
          "export map --format geotiff --resolution 1 -o ", "export map --format ply --step 1 -o "}) {
        CAPTURE(command);
        const std::string ending = command.starts_with("heatmap") ? ".svg" : ".yaml";
        const auto written = [&](const std::string& name, const std::string& options) {
            CHECK(arena(command + name + ending + " " + options + robot).status == 0);
            const std::string image = name + (command.find("nav2") == std::string::npos ? ending : ".pgm");
            return bytes_of(arena / image);
        };
        const std::string standard = written("a", "");
        CHECK(written("b", "--settle ") == standard);
        CHECK(written("c", "--stance level ") != standard);
    }
    const auto comment = [&](const std::string& options) {
        CHECK(arena("export map --format nav2 --resolution 1 -o x.yaml " + options + robot).status == 0);
        const std::string text = bytes_of(arena / "x.yaml");
        return text.substr(0, text.find('\n'));
    };
    CHECK_THAT(comment(""), Contains("): where husky can stand, let down onto its layer (top), yaw 0.52") &&
                                Contains(" rad, raised by 0.02 m"));
    CHECK_THAT(comment("--stance level "),
               Contains("): where the origin of husky can be, 0.1 m above its layer (top), yaw 0.52"));
}

TEST_CASE("export --poses --settle writes where the robot rests, and refuses poses that are not valid there")
{
    const Arena arena;
    arena.write("poses.csv", "name,x,y,z,yaw\na,0,3,0.5,0.3\nb,5.5,7,0.8,0.3\n");  // on the ground, and on the ramp
    const std::string poses = "--poses poses.csv" + husky_option;
    REQUIRE(arena("check map --settle -o judged.csv " + poses).status == 0);
    const std::vector<Pose> given = read_poses(arena / "poses.csv").poses;
    REQUIRE(arena("export map --format csv --settle --lift 0.05 -o rest.csv " + poses).status == 0);
    const PoseTable rest = read_poses(arena / "rest.csv");
    REQUIRE(rest.poses.size() == 2);
    CHECK(rest.rows[1].starts_with("b,5.5,7,"));
    for (std::size_t i = 0; i < 2; ++i) {
        const std::vector<std::string> z = column_of(read_poses(arena / "judged.csv"), "settled_z");
        CHECK(std::abs(rest.poses[i].position.z() - std::stod(z[i]) - 0.05) <= 1e-9);
        CHECK((rest.poses[i].rotation(2, 2) < std::cos(0.1)) == (i == 1));
    }
    CHECK(arena("check map --require-valid --poses rest.csv" + husky_option).status == 0);

    const ProgramRun given_run = arena("export map --format csv --lift 0.05 -o given.csv " + poses);
    CHECK_THAT(given_run.err,
               Contains("notice: --lift has no effect: the poses are written as they are given; --settle"));
    CHECK(read_poses(arena / "given.csv").poses[1].position == given[1].position);
    CHECK_THAT(arena("export map --format csv --poses judged.csv -o given.csv" + husky_option).err,
               Contains("notice: judged.csv: the columns x, y, z, roll, pitch and yaw are written, and not where"));

    arena.write("bad.csv", "name,x,y,z\ngood,0,3,0.5\nbad,50,3,0.5\n");
    const ProgramRun bad = arena("export map --format sdf --robot-uri model://husky --settle --poses bad.csv -o x.sdf" +
                                 husky_option);
    CHECK(bad.status == 4);
    CHECK_THAT(bad.err, Contains("bad.csv: with --settle, 1 of 2 poses is not valid:\n  bad: outside") &&
                            Contains("Leave these out; `check --settle` has the verdict of each pose"));
    CHECK(arena("export map --format csv --settle --poses poses.csv").status == 2);  // needs --robot
    CHECK(arena("export map --format glb --settle -o a.glb " + poses).status == 0);
    CHECK(arena("export map --format glb -o b.glb " + poses).status == 0);
    CHECK(bytes_of(arena / "a.glb") != bytes_of(arena / "b.glb"));
}

TEST_CASE("options that do not suit the stance are refused, or get a notice")
{
    const Arena arena;
    const std::string offset =
        "--offset is 0.3, but it is the height of a level robot, and settled robots stand on the "
        "ground; ";
    const auto refused = [&](const std::string& command, const std::string& message) {
        const ProgramRun run = arena(command + husky_option);
        CAPTURE(command);
        CHECK(run.status == 2);
        CHECK_THAT(run.err, Contains(message));
    };
    for (const std::string command :
         {"sample map -n 1", "heatmap map -o x.png", "export map --format nav2 -o x.yaml"}) {
        refused(command + " --offset 0.3",
                offset + "add --stance level, or leave --offset out (before version 0.2.0, level was the default)\n");
        refused(command + " --offset 0.3 --settle", offset + "give --stance level in place of --settle");
        refused(command + " --collision octree", "not on its voxels; add --stance level\n");
        refused(command + " --lift 2", "--lift is 2 m, which raises the origin of a robot on level ground to 2");
    }
    refused("sample map -n 1 --max-slope 0.3rad", "--max-slope: is \"0.3rad\", needs degrees, for example 20 or 20deg");
    const ProgramRun info = arena("info map --settle");
    CHECK(info.status == 2);
    CHECK_THAT(info.err, Contains("--settle is not an option of info; settled robots are only for check, raster, "
                                  "search, sample, heatmap, review, export and experiment\n"));
    const std::string steps = "experiment map -o x --settle --steps 4 --dims ";
    refused(steps + "2 --offset 0.3", offset + "give --stance level in place of --settle, or leave --offset out\n");
    refused(steps + "3",
            "--stance settled (--settle) is only for --dims 2: the robot is let down onto the layers of "
            "each column; give --dims 2");
    refused("raster map --dims 3 --step 4 --settle", "--stance settled (--settle) is only for --dims 2");
    refused("experiment map -o x --settle --search -n 1 --offset 0.3",
            "--offset is only for rasters, not for --search");
    refused("search map -n 1 --settle --offset 0.3", "--offset is not an option of search");
    for (const std::string command : {"search map -n 1 --settle", "experiment map -o x --search -n 1 --settle"}) {
        refused(command + " --collision octree", "give --stance level in place of --settle");
        refused(command + " --lift 2", "--lift is 2 m, which raises the origin of a robot on level ground to 2");
    }

    const auto said = [&](const std::string& options) {
        const ProgramRun run = arena("sample map -n 1 " + options + husky_option);
        CHECK(run.status == 0);
        return run.err;
    };
    CHECK_THAT(said("--max-slope 50"), Contains("notice: --max-slope 50 is above --max-tilt, 45 degrees"));
    CHECK_THAT(said("--lift 0"), Contains("notice: --lift 0 m leaves the robots in contact with the ground"));
    CHECK_THAT(said("--drop 0.01"), Contains("notice: --drop 0.01 is below --lift, 0.02 m"));
    CHECK_THAT(said("--stance level --lift 0.1"),
               Contains("notice: --lift has no effect: it is only for settled poses"));
    CHECK_THAT(said("--max-slope 20deg --max-tilt 30deg"), !Contains("--max"));
    CHECK(arena("sample map -n 3 --max-slope 20deg" + husky_option).out ==
          arena("sample map -n 3 --max-slope 20" + husky_option).out);
}

TEST_CASE("a thesis result of settled robots lists how they stand")
{
    const Arena arena;
    REQUIRE(arena("sample map -n 3 --drop 0.5 --max-slope 20 --format thesis -o drawn" + husky_option).status == 0);
    REQUIRE(arena("raster map --dims 2 --step 2 --settle --drop 0.5 --max-slope 20 --format thesis -o raster" +
                  husky_option)
                .status == 0);
    REQUIRE(
        arena("search map -n 3 --settle --drop 0.5 --max-slope 20 --format thesis -o searched" + husky_option).status ==
        0);
    for (const char* const folder : {"drawn", "raster", "searched"}) {
        const std::string stats = bytes_of(arena / folder / "Stats.txt");
        CHECK(value_of(stats, "Stance") == "settled");
        CHECK(value_of(stats, "Lift (m)") == "0.02");
        CHECK(std::stod(value_of(stats, "Max slope (rad)")) == Approx(20 * M_PI / 180));
        CHECK(std::stod(value_of(stats, "Max tilt (rad)")) == Approx(45 * M_PI / 180));
        CHECK(std::stod(value_of(stats, "Min stability (m)")) > 0);
        CHECK(value_of(stats, "Drop (m)") == "0.5");
    }
    REQUIRE(arena("sample map -n 3 --stance level --format thesis -o level" + husky_option).status == 0);
    CHECK(value_of(bytes_of(arena / "level/Stats.txt"), "Stance").empty());
}
