#include "arena.h"
#include "junit_cases.h"

#include <spawnfield/map.h>
#include <spawnfield/poses.h>

#include <nlohmann/json.hpp>

namespace {

const std::string header = "name,x,y,z,yaw\n", start = "start,0,3,0.1,0\n", wall = "wall,-6.5,-5,0.1,0\n",
                  lake = "lake,7,-7,0.1,0\n", sky = "sky,0,3,2.5,0\n", cube = "cube,6.5,0,3,0\n",
                  away = "away,99,0,0,0\n";

/// Returns whether a strict XML reader (Python's expat) accepts the file.
bool is_strict_xml(const std::filesystem::path& file)
{
    const std::string script = "import sys, xml.etree.ElementTree as tree; tree.parse(sys.argv[1])";
    return std::system(("'" + python_file() + "' -c '" + script + "' '" + file.string() + "'").c_str()) == 0;
}

}  // namespace

TEST_CASE("check --require-valid ends with status 3 if a pose is not valid, and writes all rows")
{
    const Arena arena;
    const std::string command = "check map --poses poses.csv" + husky_option;
    arena.write("poses.csv", header + start + wall + lake);
    const ProgramRun plain = arena(command);
    CHECK(plain.status == 0);
    const ProgramRun required = arena(command + "--require-valid -o out.csv");
    CHECK(required.status == 3);
    CHECK(required.out.empty());
    CHECK(bytes_of(arena / "out.csv") == plain.out);
    CHECK(
        required.err.ends_with("spawnfield: --require-valid: 2 of 3 poses are not valid:\n"
                               "  wall: collision with thin_wall\n  lake: submerged\n"));
    const ProgramRun quiet = arena(command + "--require-valid -q");
    CHECK(quiet.status == 3);
    CHECK(quiet.out == plain.out);
    CHECK(quiet.err.starts_with("spawnfield: --require-valid: 2 of 3"));

    for (const char* const format : {"json", "junit"}) {
        const std::string option = std::string("--format ") + format;
        CHECK(arena(command + option).status == 0);
        const ProgramRun run = arena(command + option + " --require-valid -o out." + format);
        CHECK(run.status == 3);
        CHECK(bytes_of(arena / (std::string("out.") + format)) == arena(command + option).out);
    }

    arena.write("poses.csv", header + start + start);
    const ProgramRun all = arena(command + "--require-valid");
    CHECK(all.status == 0);
    CHECK(all.out == arena(command).out);
    CHECK(all.err.find("--require-valid") == std::string::npos);
}

TEST_CASE("check --require-valid prints why each of the first five poses is not valid, and how many follow")
{
    const Arena arena;
    arena.write("poses.csv", header + start + away + sky + cube + wall + ",7,-7,0.1,0\n" + wall + lake);
    const ProgramRun run = arena("check map --poses poses.csv --require-valid -q --max-height 2" + husky_option);
    CHECK(run.status == 3);
    CHECK(run.err ==
          "spawnfield: --require-valid: 7 of 8 poses are not valid:\n"
          "  away: outside the map's bounds\n"
          "  sky: aerial: 2.55 m above the ground, the limit is 2 m (--max-height)\n"
          "  cube: off_terrain: the ground is cube_east\n"
          "  wall (pose 5): collision with thin_wall\n"
          "  pose 6: submerged\n"
          "  and 2 more\n");
    arena.write("poses.csv", "x,y,z\n0,0,-3\n");
    CHECK(arena("check map --poses poses.csv --require-valid -q --robot box:0.5,0.5,1").err ==
          "spawnfield: --require-valid: 1 of 1 pose is not valid:\n"
          "  pose 1: aerial: no ground below the origin; the next ground is 2.95 m above the origin\n");
}

TEST_CASE("check --require-valid does not change the exit status of other failures")
{
    const Arena arena;
    arena.write("poses.csv", header + wall);
    arena.write("bad.csv", "x,y\n0,0\n");
    CHECK(arena("check map --poses bad.csv --require-valid" + husky_option).status == 4);
    CHECK(arena("check map --poses poses.csv --require-valid -o none/out.csv" + husky_option).status == 1);
    const ProgramRun format = arena("check map --poses poses.csv --format xml" + husky_option);
    CHECK(format.status == 2);
    CHECK_THAT(format.err, Contains("junit"));
}

TEST_CASE("check --format junit has a test case for each pose, with its verdict and what it hit")
{
    const Arena arena;
    arena.write("poses.csv", header + start + wall + lake + sky + cube + away);
    const std::string command = "check map --poses poses.csv --format junit --max-height 2" + husky_option;
    const ProgramRun run = arena(command + "--threads 1");
    CHECK(run.status == 0);
    const std::vector<JunitTestCase> cases = cases_of(run.out);
    REQUIRE(cases.size() == 6);
    const std::vector<std::string> names = {"start", "wall", "lake", "sky", "cube", "away"},
                                   types = {"", "collision", "submerged", "aerial", "off_terrain", "outside"};
    for (std::size_t i = 0; i < cases.size(); ++i) {
        CHECK(cases[i].class_name == "training.husky");
        CHECK(cases[i].name == names[i]);
        CHECK(cases[i].type == types[i]);
    }
    CHECK(cases[1].message == "collision with thin_wall");
    CHECK(cases[1].text ==
          "row 2: wall,-6.5,-5,0.1,0\nposition -6.5, -5, 0.1 m; roll, pitch, yaw 0, 0, 0 rad\n"
          "ground at -0.05 m, 0.15 m below the origin\nhit thin_wall\n");
    CHECK(cases[3].message == "aerial: 2.55 m above the ground, the limit is 2 m (--max-height)");
    CHECK_THAT(cases[5].text, Contains("no ground below the origin"));
    CHECK_THAT(run.out, Contains("<property name=\"max_height\" value=\"2.0\"/>"));
    CHECK(arena(command + "--threads 3").out == run.out);
    CHECK_THAT(arena(command + "--collision octree").out, Contains("message=\"collision with occupancy\""));
}

TEST_CASE("JUnit names are unique: from the column name, or else the number of the pose")
{
    const Arena arena;
    arena.write("poses.csv", "name,x,y,z\na,0,3,0.1\n,0,3,0.1\na,0,3,0.1\nb,0,3,0.1\n");
    const std::string command = "check map --format junit --poses poses.csv" + husky_option;
    std::vector<JunitTestCase> cases = cases_of(arena(command).out);
    REQUIRE(cases.size() == 4);
    CHECK(cases[0].name == "a (pose 1)");
    CHECK(cases[1].name == "pose 2");
    CHECK(cases[2].name == "a (pose 3)");
    CHECK(cases[3].name == "b");
    arena.write("poses.csv", "x,y,z\n0,3,0.1\n0,3,0.1\n");
    cases = cases_of(arena(command).out);
    REQUIRE(cases.size() == 2);
    CHECK(cases[1].name == "pose 2");
}

TEST_CASE("reports with hostile names are valid XML and JSON")
{
    const TempFolder folder;
    folder.write("scene.yaml",
                 "format: spawnfield-scene/1\nname: \"a<&\\\">'\\x01 world\"\nparts:\n"
                 "- {name: floor, label: terrain, box: [9, 9, 1]}\n"
                 "- {name: \"]]><failure type=\\\"x\\\"/>\\n\\x07\\uFFFE&amp;\", label: obstacle, "
                 "box: [1, 1, 3]}\n");
    REQUIRE(run_program(folder, "bake scene.yaml -o map -q").status == 0);
    folder.write("poses.csv",
                 "name,x,y,z\n\"<&\"\"'>\",0,0,0.6\n\"]]>\x01\x1b[31m\",0,0,0.6\n\xff\xc0\xaf,0,0,0.6\n"
                 "\xef\xbf\xbf,0,0,0.6\n\xc3\xa9\xe2\x98\x83,3,3,0.6\n");
    const std::string command = "check map --robot box:0.5,0.5,1 -p poses.csv --require-valid -q --format ";
    CHECK(run_program(folder, command + "junit -o a.xml").status == 3);
    CHECK(is_strict_xml(folder / "a.xml"));
    const std::string junit = bytes_of(folder / "a.xml");
    CHECK(std::none_of(junit.begin(), junit.end(), [](unsigned char c) { return c < ' ' && c != '\n'; }));
    CHECK_NOTHROW(nlohmann::json(junit).dump());  // throws if it is not UTF-8
    const std::vector<JunitTestCase> cases = cases_of(junit);
    REQUIRE(cases.size() == 5);
    CHECK(cases[0].name == "<&\"'>");
    CHECK(cases[1].name == "]]>  [31m");
    CHECK_THAT(cases[2].name, Contains("\xEF\xBF\xBD"));
    CHECK(cases[3].name == "\xEF\xBF\xBD");
    CHECK(cases[4].name == "\xc3\xa9\xe2\x98\x83");
    CHECK(cases[0].message == "collision with ]]><failure type=\"x\"/>  \xEF\xBF\xBD&amp;");
    CHECK_THAT(cases[0].text, Contains("row 1: \"<&\"\"'>\",0,0,0.6\n"));
    CHECK(cases[4].type.empty());

    CHECK(run_program(folder, command + "json -o a.json").status == 3);
    const auto json = nlohmann::json::parse(bytes_of(folder / "a.json"));
    CHECK(json["poses"][0]["name"] == "<&\"'>");
    CHECK(json["poses"][0]["hit"] == "]]><failure type=\"x\"/>\n\x07\xEF\xBF\xBE&amp;");
    CHECK(json["map"]["name"] == "a<&\">'\x01 world");
}

TEST_CASE("check --format json has each pose with its verdict, ground, hit and the fields of its row")
{
    const Arena arena;
    arena.write("poses.csv",
                "id,name,x,y,z,yaw,verdict\n1,start,0,3,0.1,0.5,aerial\n02,\"a, b\",-6.5,-5,0.1,0,\n"
                "3,,99,0,0,0,\n");
    const std::string command = "check map --poses poses.csv --format json -q" + husky_option;
    const std::string text = arena(command).out;
    const auto json = nlohmann::json::parse(text);
    CHECK(json["format"] == "spawnfield-verdicts/1");
    CHECK(json["command"] == "check");
    CHECK(json["map"]["hash"] == spawnfield::read_map(arena / "map").hash);
    CHECK(json["robot"] == "husky");
    CHECK(json["settings"] == nlohmann::json{{"max_height", 1.0}, {"collision", "geometry"}});
    CHECK(json["counts"]["valid"] == 1);
    CHECK(json["counts"]["collision"] == 1);
    REQUIRE(json["poses"].size() == 3);
    const auto& first = json["poses"][0];
    CHECK(first["row"] == 1);
    CHECK(first["name"] == "start");
    CHECK(first["position"] == std::vector<double>{0, 3, 0.1});
    CHECK(first["rpy"] == std::vector<double>{0, 0, 0.5});
    CHECK(first["verdict"] == "valid");
    CHECK(first["ground"] == -0.05);
    CHECK(first["height_above"] == 0.1 - -0.05);
    CHECK(first["hit"].is_null());
    CHECK(first["columns"] ==
          nlohmann::json{{"id", "1"}, {"name", "start"}, {"x", "0"}, {"y", "3"}, {"z", "0.1"}, {"yaw", "0.5"}});
    CHECK(json["poses"][1]["hit"] == "thin_wall");
    CHECK(json["poses"][1]["columns"]["id"] == "02");
    CHECK(json["poses"][1]["name"] == "a, b");
    CHECK((json["poses"][2]["ground"].is_null() && json["poses"][2]["height_above"].is_null()));
    CHECK_FALSE(json["poses"][2].contains("name"));

    const auto more = nlohmann::json::parse(
        arena(command + "--max-slope 45 --max-water-depth 2 --collision octree").out);
    CHECK(more["settings"]["max_slope"].get<double>() == Approx(0.785398163));
    CHECK(more["settings"]["max_water_depth"] == 2.0);
    CHECK(more["settings"]["collision"] == "octree");
}

TEST_CASE("reports of many poses, which are written in several pieces, are complete")
{
    const Arena arena;
    std::string text = header;
    for (int i = 0; i < 6000; ++i) text += i % 3 == 0 ? start : wall;
    arena.write("poses.csv", text);
    const std::string command = "check map --poses poses.csv -q --format ";
    const std::string junit = arena(command + "junit" + husky_option).out;
    const std::string json = arena(command + "json" + husky_option).out;
    CHECK((junit.size() > 1100000 && json.size() > 1100000));  // a piece is 1 MB
    const std::vector<JunitTestCase> cases = cases_of(junit);
    REQUIRE(cases.size() == 6000);
    CHECK(std::count_if(cases.begin(), cases.end(), [](const JunitTestCase& test) { return test.type.empty(); }) ==
          2000);
    CHECK(cases[5999].name == "wall (pose 6000)");
    CHECK(nlohmann::json::parse(json)["poses"][5999]["row"] == 6000);
}

TEST_CASE("check --settle writes how the robot rests at each pose")
{
    const Arena arena;
    arena.write("poses.csv",
                "name,x,y,z,yaw,margin,reason\nstart,0,3,0.1,0.5,old,old\nwall,-6.5,-5,0.1,0,,\nsky,0,3,2.5,0,,\n");
    const ProgramRun run = arena("check map --poses poses.csv --settle" + husky_option);
    INFO(run.err);
    CHECK(run.status == 0);
    CHECK_THAT(run.err, Contains("poses.csv: new columns replace the old ones: margin, reason\n"));
    CHECK_THAT(run.err, Contains("husky has no centre of mass; that of its parts' volume is used"));
    CHECK_THAT(run.err, Contains("3 poses: 1 valid, 1 collision, 1 aerial"));
    std::istringstream lines(run.out);
    std::string line;
    std::getline(lines, line);
    CHECK(line ==
          "name,x,y,z,yaw,verdict,ground,height_above,hit,settled_z,settled_roll,settled_pitch,tilt,margin,"
          "contacts,tip_over,belly,reason");
    std::getline(lines, line);
    CHECK(line.starts_with("start,0,3,0.1,0.5,valid,-0.05,0,,-0.05,0,0,0,0.335,"));
    CHECK_THAT(line, Contains(" on floor; "));
    CHECK(line.ends_with(",0,"));
    std::getline(lines, line);
    CHECK(line ==
          "wall,-6.5,-5,0.1,0,collision,-0.05,,thin_wall,,,,,,,,,"
          "\"collision: it has no room to settle, because of thin_wall\"");
    std::getline(lines, line);
    CHECK(line ==
          "sky,0,3,2.5,0,aerial,-0.05,,,,,,,,,,,\"aerial: 2.55 m above the ground, the limit is 1 m (--max-height)\"");

    const ProgramRun json = arena("check map --poses poses.csv --stance settled --drop 2 --format json -q" +
                                  husky_option);
    CHECK(json.status == 0);
    const nlohmann::json report = nlohmann::json::parse(json.out);
    CHECK(report.at("settings").at("stance") == "settled");
    CHECK(report.at("settings").at("drop") == 2);
    CHECK(report.at("counts").at("obstructed") == 0);
    const nlohmann::json& rest = report.at("poses")[0].at("settled");
    CHECK(rest.at("position")[2] == -0.05);
    CHECK(rest.at("contacts").size() == 4);
    CHECK(rest.at("contacts")[0].at("ground") == "floor");
    CHECK(std::abs(rest.at("margin").get<double>() - 0.335) <= 1e-9);
    CHECK(report.at("poses")[0].at("reason").is_null());
    CHECK(report.at("poses")[1].at("settled").is_null());
    CHECK(report.at("poses")[1].at("reason") == "collision: it has no room to settle, because of thin_wall");

    const ProgramRun junit = arena("check map --poses poses.csv --settle --format junit -q" + husky_option);
    const std::vector<JunitTestCase> cases = cases_of(junit.out);
    REQUIRE(cases.size() == 3);
    CHECK(cases[1].message == "collision: it has no room to settle, because of thin_wall");
}

TEST_CASE("options of settled poses are refused or reported if they cannot have an effect")
{
    const Arena arena;
    arena.write("poses.csv", header + start);
    arena.write("tilted.csv", "x,y,z,roll\n0,3,0.1,0.2\n");
    const std::string command = "check map --poses poses.csv" + husky_option;
    CHECK_THAT(arena(command + "--lift 0.1").err,
               Contains("--lift has no effect: it is only for settled poses (--stance settled)"));
    CHECK_THAT(arena("check map --poses tilted.csv --settle" + husky_option).err,
               Contains("tilted.csv: roll and pitch of 1 pose are not used, because the robot is let down level"));
    const auto refused = [&](const std::string& options, const std::string& message) {
        const ProgramRun run = arena(command + options);
        INFO(run.err);
        CHECK(run.status == 2);
        CHECK_THAT(run.err, Contains(message));
    };
    refused("--settle --collision octree", "--collision is octree, but settled poses need geometry");
    refused("--settle --lift=-1", "--lift is -1, needs >= 0 m");
    refused("--settle --max-tilt 90", "--max-tilt is 90, needs > 0 and < 90 degrees");
    refused("--settle --min-stability=-1", "--min-stability is -1, needs >= 0 m");
    refused("--settle --drop 0", "--drop is 0, needs > 0 m");
    refused("--settle --stance level", "--settle");
}

TEST_CASE("the valid rows of raster --settle are valid poses as they are written")
{
    const Arena arena;
    const ProgramRun run = arena("raster map --dims 2 --step 0.5 --settle --yaw 20deg -o raster.csv" + husky_option);
    INFO(run.err);
    CHECK(run.status == 0);
    CHECK_THAT(run.err, Contains("raster: settled; 1700 poses: "));
    std::istringstream lines(bytes_of(arena / "raster.csv"));
    std::string line, valid;
    std::getline(lines, line);
    CHECK(line == "x,y,z,roll,pitch,yaw,layer,verdict,tilt,margin,tip_over,belly,ground");
    const std::string names = line + "\n";
    int rows = 0, tilted = 0;
    for (; std::getline(lines, line); ++rows) {
        if (line.find(",valid,") == std::string::npos) continue;
        valid += line + "\n";
        double x, y, z, roll, pitch;
        REQUIRE(std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf,%lf", &x, &y, &z, &roll, &pitch) == 5);
        tilted += std::abs(pitch) > 0.1;
    }
    CHECK(rows == 1700);
    arena.write("valid.csv", names + valid);
    const ProgramRun check = arena("check map --poses valid.csv --require-valid" + husky_option);
    INFO(check.err);
    CHECK(check.status == 0);
    CHECK(std::count(valid.begin(), valid.end(), '\n') > 900);
    CHECK(tilted > 20);  // on the ramp
}

TEST_CASE("what rounding leaves of an angle of 0 is not written")
{
    using namespace spawnfield;
    const Arena arena;
    REQUIRE(arena("raster map --dims 2 --step 0.5 --settle -q -o raster.csv" + husky_option).status == 0);
    const PoseTable raster = read_poses(arena / "raster.csv");
    int tilted = 0;
    for (const char* const column : {"roll", "pitch"})
        for (const std::string& text : column_of(raster, column)) {
            CAPTURE(column, text);
            CHECK((text == "0" || std::abs(std::stod(text)) > 1e-12));
            tilted += text != "0";
        }
    CHECK(tilted > 20);
}

TEST_CASE("rows of raster --settle with their ground as z have the same verdicts from check --settle, valid or not")
{
    const Arena arena;
    REQUIRE(arena("raster map --dims 2 --step 0.4 --settle --yaw 20deg -q -o raster.csv" + husky_option).status == 0);
    using namespace spawnfield;
    const PoseTable raster = read_poses(arena / "raster.csv");
    const std::vector<std::string> x = column_of(raster, "x"), y = column_of(raster, "y"),
                                   yaw = column_of(raster, "yaw"), ground = column_of(raster, "ground");
    std::string places = "x,y,z,yaw\n";
    for (std::size_t i = 0; i < x.size(); ++i) places += x[i] + "," + y[i] + "," + ground[i] + "," + yaw[i] + "\n";
    arena.write("places.csv", places);
    REQUIRE(arena("check map --settle --poses places.csv -q -o checked.csv" + husky_option).status == 0);
    const PoseTable checked = read_poses(arena / "checked.csv");
    CHECK(column_of(checked, "verdict") == column_of(raster, "verdict"));
    CHECK(column_of(checked, "margin") == column_of(raster, "margin"));
    CHECK(column_of(checked, "ground") == ground);
}

TEST_CASE("raster and heatmap refuse what they cannot do with settled poses")
{
    const Arena arena;
    const auto refused = [&](const std::string& command, const std::string& message) {
        const ProgramRun run = arena(command + husky_option);
        INFO(run.err);
        CHECK(run.status == 2);
        CHECK_THAT(run.err, Contains(message));
    };
    refused("raster map --dims 3 --step 1 --settle", "--stance settled (--settle) is only for --dims 2");
    refused("heatmap map -o x.png --quantity margin --stance level",
            "--quantity margin is about the robot at rest; leave --stance level out, or choose another quantity");
    refused("heatmap map -o x.png --quantity tilt --settle --yaw random", "--quantity tilt needs one heading");
    refused("raster map --dims 2 --step 1 --settle --collision octree", "settled poses need geometry");
    refused("raster map --dims 2 --step 1 --settle --offset 0.5",
            "--offset is 0.5, but it is the height of a level robot, and settled robots stand on the ground; give "
            "--stance level in place of --settle, or leave --offset out");
}

TEST_CASE("a robot stops at its first rest, whatever the largest tilt, and the other side of a ramp mirrors it")
{
    const Arena arena;
    arena.write("poses.csv", "x,y,z,yaw\n4,9.4,0.6,1.5707963267948966\n4,4.6,0.6,-1.5707963267948966\n");
    const auto checked = [&](const std::string& max_tilt) {
        return arena("check map --poses poses.csv --settle -q --max-tilt " + max_tilt + husky_option).out;
    };
    const std::string text = checked("45");
    CHECK(checked("20") == text);
    CHECK(checked("70") == text);
    std::istringstream lines(text);
    std::string line;
    std::getline(lines, line);
    std::vector<std::vector<double>> rows;
    while (std::getline(lines, line)) {
        double z, roll, pitch, tilt, margin;
        const std::size_t at = line.find(",valid,");
        REQUIRE(at != std::string::npos);
        REQUIRE(std::sscanf(line.c_str() + at, ",valid,%*f,%*f,,%lf,%lf,%lf,%lf,%lf", &z, &roll, &pitch, &tilt,
                            &margin) == 5);
        rows.push_back({z, -roll, pitch, tilt, margin});
    }
    REQUIRE(rows.size() == 2);
    rows[0][1] = -rows[0][1];
    for (std::size_t k = 0; k < 5; ++k) CHECK(std::abs(rows[0][k] - rows[1][k]) <= 1e-9);
}
