#include "catch.h"
#include "base/number.h"
#include "temp_folder.h"
#include "test_map.h"

#include <spawnfield/error.h>
#include <spawnfield/poses.h>

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include <limits>
#include <sstream>

using namespace spawnfield;

namespace {

PoseTable read(const std::string& text)
{
    const TempFolder folder;
    return read_poses(folder.write("poses.csv", text));
}

/// Returns the error message for a file, without its name.
std::string complaint(const std::string& text)
{
    const TempFolder folder;
    const auto file = folder.write("poses.csv", text);
    try {
        read_poses(file);
    } catch (const FileError& error) {
        const std::string what = error.what(), start = file.string() + ": ";
        return what.starts_with(start) ? what.substr(start.size()) : "does not name its file: " + what;
    }
    return "";
}

std::vector<std::string> lines_of(const std::string& text)
{
    std::vector<std::string> out;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) out.push_back(line);
    return out;
}

/// Numbers whose shortest texts have different forms.
const std::vector<double> odd_numbers = {0.1,
                                         1.0 / 3,
                                         1e-300,
                                         -123456789.123456789,
                                         5e22,
                                         std::numeric_limits<double>::denorm_min(),
                                         std::nextafter(1.0, 2.0),
                                         4503599627370497.5,
                                         0};

}  // namespace

TEST_CASE("poses are read in any column order, with angles that default to 0")
{
    const PoseTable table = read("yaw,z,x,y\n0.5,3,1,2\n-1e-1,+6,4e0,5\n");
    REQUIRE(table.poses.size() == 2);
    CHECK(table.poses[0].position == Vec3(1, 2, 3));
    CHECK(table.poses[0].rotation == rotation_from_rpy(0, 0, 0.5));
    CHECK(table.poses[1].position == Vec3(4, 5, 6));
    CHECK(table.poses[1].rotation == rotation_from_rpy(0, 0, -0.1));
    CHECK(read("x,y,z\n1,2,3\n").poses[0].rotation == Mat3::Identity());
    const Pose turned = read("x,y,z,roll,pitch,yaw\n0,0,0,0.1,0.2,0.3\n").poses[0];
    CHECK(turned.rotation == rotation_from_rpy(0.1, 0.2, 0.3));
}

TEST_CASE("quaternions are x, y, z, w and may be a little off unit length")
{
    const double half = std::sqrt(0.5);
    const std::string h = std::to_string(half);  // six digits
    const Pose pose = read("x,y,z,qx,qy,qz,qw\n1,2,3,0,0," + h + "," + h + "\n").poses[0];
    CHECK(pose.rotation.isApprox(rotation_from_rpy(0, 0, 1.5707963267948966), 1e-12));
    const Pose rolled = read("qw,qx,qz,qy,x,y,z\n" + h + "," + h + ",0,0,1,2,3\n").poses[0];
    CHECK((rolled.rotation * Vec3::UnitY()).isApprox(Vec3::UnitZ(), 1e-12));
    CHECK((rolled.rotation * rolled.rotation.transpose()).isApprox(Mat3::Identity(), 1e-14));
}

TEST_CASE("rows and header are kept unchanged, including extra columns")
{
    const PoseTable table = read("name,x,y,z,note\n\"a, b\",1, 2 ,3,\"say \"\"hi\"\"\"\nc,4,5,6,\n");
    CHECK(table.header == "name,x,y,z,note");
    REQUIRE(table.rows.size() == 2);
    CHECK(table.rows[0] == "\"a, b\",1, 2 ,3,\"say \"\"hi\"\"\"");
    CHECK(table.rows[1] == "c,4,5,6,");
    CHECK(table.poses[0].position == Vec3(1, 2, 3));
}

TEST_CASE("line ends of Windows, a byte order mark, empty lines and a missing last line end are accepted")
{
    const PoseTable table = read("\xEF\xBB\xBFx,y,z\r\n1,2,3\r\n\r\n  \n4,5,6");
    CHECK(table.header == "x,y,z");
    REQUIRE(table.poses.size() == 2);
    CHECK(table.rows[0] == "1,2,3");
    CHECK(table.poses[1].position == Vec3(4, 5, 6));
    CHECK(read("\"x\",\"y\",\"z\"\n\"1\",\"2\",\"3\"\n").poses[0].position == Vec3(1, 2, 3));
}

TEST_CASE("an invalid poses file is refused by line and column")
{
    const std::string needs =
        ", needs a header with x,y,z; roll,pitch,yaw (or roll_deg,pitch_deg,yaw_deg, or qx,qy,qz,qw) are optional";
    CHECK(complaint("") == "is empty" + needs);
    CHECK(complaint("\n \n") == "is empty" + needs);
    CHECK(complaint("x,y\n1,2\n") == "line 1: column z is missing" + needs);
    CHECK(complaint("1,2,3\n4,5,6\n") == "line 1: has numbers, needs a header before them: add the line x,y,z");
    CHECK(complaint("X,Y,Z\n4,5,6\n") == "line 1: column x is missing (there is X, but names are lower case)" + needs);
    CHECK(complaint("x,y,z,x\n1,2,3,4\n") == "line 1: column x is given twice");
    CHECK(complaint("x,y,z,qx,qw\n1,2,3,0,1\n") ==
          "line 1: has some of the columns qx,qy,qz,qw, needs all four or none");
    CHECK(complaint("x,y,z,yaw,qx,qy,qz,qw\n0,0,0,0,0,0,0,1\n") ==
          "line 1: has columns qx,qy,qz,qw beside roll,pitch,yaw, needs one of the two");
    CHECK(complaint("x,y,z\n1,2,3\n1,two,3\n") == "line 3: column y is \"two\", needs a number");
    CHECK(complaint("x,y,z\n1,,3\n") == "line 2: column y is \"\", needs a number");
    CHECK(complaint("x,y,z\n1,2,3m\n") == "line 2: column z is \"3m\", needs a number");
    CHECK(complaint("x,y,z\n1,2,+-3\n") == "line 2: column z is \"+-3\", needs a number");
    CHECK(complaint("x,y,z,yaw\n1,2,3,nan\n") == "line 2: column yaw is nan, needs a finite number");
    CHECK(complaint("x,y,z\n-inf,2,3\n") == "line 2: column x is -inf, needs a finite number");
    CHECK(complaint("x,y,z\n\n1,2\n") == "line 3: has 2 fields, the header has 3");
    CHECK(complaint("x,y,z\n1,2,3,4\n") == "line 2: has 4 fields, the header has 3");
    CHECK(complaint("x,y,z,name\n1,2,3,\"a\n") == "line 2: has a quote that is not closed");
    CHECK(complaint("x,y,z,qx,qy,qz,qw\n0,0,0,1,1,0,0\n") ==
          "line 2: the quaternion's length is 1.4142135623730951, needs 1 (to 0.001)");
    CHECK(complaint("x,y,z,qx,qy,qz,qw\n0,0,0,0,0,0,0\n") ==
          "line 2: the quaternion's length is 0, needs 1 (to 0.001)");
    CHECK_THROWS_WITH(read_poses("/none/poses.csv"), "/none/poses.csv: does not exist; is the path right?");
}

TEST_CASE("probable mistakes in a poses file get a notice")
{
    const auto notices = [](const std::string& text) {
        const TempFolder folder;
        const auto file = folder.write("poses.csv", text);
        std::string out;
        for (const std::string& notice : read_poses(file).notices) out += notice.substr(file.string().size()) + "\n";
        return out;
    };
    CHECK(notices("id,x,y,z,yaw\n1,2,3,4,5\n").empty());
    CHECK(notices("x,y,z,Yaw\n1,2,3,4\n") ==
          ": column Yaw is copied but not read, because names of columns are lower case (yaw)\n");
    const auto other_yaw = [](const std::string& name) {
        return ": column " + name +
               " is copied but not read, so yaw is 0; if it is the angle from x towards y, name it yaw (rad) or "
               "yaw_deg (degrees)\n";
    };
    for (const std::string name : {"theta", "Heading", "HEADING_DEG", "theta_rad", "heading (deg)", "yaw_radians"})
        CHECK(notices("x,y,z," + name + "\n1,2,3,4\n") == other_yaw(name));
    CHECK(notices("x,y,z,heading,roll\n1,2,3,4,5\n") == other_yaw("heading"));
    for (const std::string names : {"theta,yaw", "yaw_deg,heading", "heading_error,thetas", "roll,pitch"})
        CHECK(notices("x,y,z," + names + "\n1,2,3,4,5\n").empty());
    CHECK(notices("x,y,z,heading,qx,qy,qz,qw\n1,2,3,4,0,0,0,1\n").empty());
}

TEST_CASE("verdicts replace older verdicts")
{
    const PoseTable table = read("hit,x,\"verdict\",y,z,note\nlamp,0,\"1,2\",0,0.1,\"a, \"\"b\"\"\"\n");
    CHECK(replaced_columns(table) == std::vector<std::string>{"hit", "verdict"});
    CHECK(replaced_columns(read("x,y,z,Hit\n0,0,0,a\n")).empty());
    CHECK(verdicts_csv(table, {Judgement{}}, {}) ==
          "x,y,z,note,verdict,ground,height_above,hit\n0,0,0.1,\"a, \"\"b\"\"\",outside,,,\n");
}

TEST_CASE("spawns that were written read back to the same doubles")
{
    SpawnList list;
    for (std::size_t i = 0; i + 3 < odd_numbers.size(); ++i)
        list.spawns.push_back({{odd_numbers[i], odd_numbers[i + 1], odd_numbers[i + 2]}, 0.1 * double(i) - 0.3});
    const std::string text = spawns_csv(list);
    CHECK(lines_of(text)[0] == "x,y,z,roll,pitch,yaw");
    const PoseTable table = read(text);
    const TempFolder folder;
    const std::vector<Spawn> spawns = spawns_of(read_poses(folder.write("spawns.csv", text)));
    REQUIRE(table.poses.size() == list.spawns.size());
    REQUIRE(spawns.size() == list.spawns.size());
    for (std::size_t i = 0; i < spawns.size(); ++i) {
        CHECK(table.poses[i].position == list.spawns[i].position);
        CHECK(table.poses[i].rotation == rotation_from_rpy(0, 0, list.spawns[i].yaw));
        CHECK(spawns[i].position == list.spawns[i].position);
        CHECK(spawns[i].yaw == Approx(list.spawns[i].yaw));
    }
}

TEST_CASE("an empty list of spawns is written as a header")
{
    CHECK(spawns_csv({}) == "x,y,z,roll,pitch,yaw\n");
    SpawnList settled;
    settled.stance = Stance::Settled;
    CHECK(spawns_csv(settled) == "x,y,z,roll,pitch,yaw,tilt,margin\n");
}

TEST_CASE("settled spawns are written with their tilt and margin, and with what their rule measured")
{
    SpawnList list;
    list.spawns = {{{1, 2, 3}, 0.5, 0.1, 0.2}};
    list.rests = {{0.25, 0.125, 7.5}};
    list.stance = Stance::Settled;
    CHECK(spawns_csv(list) == "x,y,z,roll,pitch,yaw,tilt,margin\n1,2,3,0.1,0.2,0.5,0.25,0.125\n");
    list.heading = HeadingRule{.kind = HeadingRule::Kind::Along};
    CHECK(spawns_csv(list, std::vector<std::string>{"a,b"}) ==
          "name,x,y,z,roll,pitch,yaw,tilt,margin,way\n\"a,b\",1,2,3,0.1,0.2,0.5,0.25,0.125,7.5\n");
    list.heading->kind = HeadingRule::Kind::Clearest;
    CHECK_THAT(spawns_csv(list), Contains(",margin,clearance\n"));
    list.rests.clear();
    CHECK_THROWS_WITH(spawns_csv(list), Contains("size of list.rests is 0, needs as many as its spawns"));
}

TEST_CASE("verdicts follow the columns of the poses")
{
    const PoseTable table = read("id,x,y,z\n7,0,0,0.1\n8,0,0,5\n9,0,0,0.3\n10,0,0,1\n");
    Scene scene;
    scene.parts.resize(2);
    scene.parts[1].name = "wall, \"north\"";
    std::vector<Judgement> judgements(4);
    judgements[0].verdict = Verdict::Valid;
    judgements[0].ground = Ground{-0.05, true, 0};
    judgements[2].verdict = Verdict::Collision;
    judgements[2].ground = Ground{0.2, true, 0};
    judgements[2].hit = CollisionHit{1};
    judgements[3].verdict = Verdict::Collision;
    judgements[3].ground = Ground{0, true, 0};
    judgements[3].hit = CollisionHit{};
    Map map;
    map.geometry = Geometry(scene);
    CHECK(verdicts_csv(table, judgements, map) ==
          "id,x,y,z,verdict,ground,height_above,hit\n"
          "7,0,0,0.1,valid,-0.05,0.15000000000000002,\n"
          "8,0,0,5,outside,,,\n"
          "9,0,0,0.3,collision,0.2,0.09999999999999998,\"wall, \"\"north\"\"\"\n"
          "10,0,0,1,collision,0,1,occupancy\n");
}

TEST_CASE("a raster is written in its order; a pose whose ground is not a layer has no layer")
{
    RasterResult raster;
    raster.yaw = 0.5;
    raster.poses = {
        {1, 2, 0.1, 0, Verdict::Valid}, {1, 2, -3, 1, Verdict::Collision}, {1.5, 2, 1.0 / 3, -1, Verdict::OffTerrain}};
    CHECK(csv_of(raster, false) ==
          "x,y,z,yaw,layer,verdict\n1,2,0.1,0.5,0,valid\n1,2,-3,0.5,1,collision\n"
          "1.5,2,0.3333333333333333,0.5,,off_terrain\n");
}

TEST_CASE("aerial poses are written, in their places, only on request")
{
    RasterResult raster;
    raster.dims = 3;
    raster.grid = {.x0 = 0, .y0 = 10, .z0 = -1, .step = 0.5, .step_z = 0.1, .cols = 2, .rows = 1, .heights = 3};
    const double top = raster.grid.z_of(2), middle = raster.grid.z_of(1), low = raster.grid.z_of(0);
    raster.poses = {{0, 10, middle, 0, Verdict::Valid}, {0.5, 10, low, -1, Verdict::OffTerrain}};
    CHECK(lines_of(csv_of(raster, false)).size() == 3);
    const auto lines = lines_of(csv_of(raster, true));
    REQUIRE(lines.size() == 7);
    CHECK(lines[1] == "0,10,-0.8,0,,aerial");
    CHECK(lines[2] == "0,10,-0.9,0,0,valid");
    CHECK(lines[3] == "0,10,-1,0,,aerial");
    CHECK(lines[4] == "0.5,10,-0.8,0,,aerial");
    CHECK(lines[5] == "0.5,10,-0.9,0,,aerial");
    CHECK(lines[6] == "0.5,10,-1,0,,off_terrain");
    const PoseTable table = read(csv_of(raster, true));
    CHECK(table.poses[0].position.z() == top);
}

TEST_CASE("a long raster comes in pieces of whole lines")
{
    RasterResult raster;
    for (int i = 0; i < 150000; ++i) raster.poses.push_back({double(i), 0.25, -1, 0, Verdict::Valid});
    std::size_t pieces = 0, lines = 0, most = 0;
    bool whole = true;
    write_raster_csv(raster, false, [&](std::string_view text) {
        ++pieces;
        most = std::max(most, text.size());
        lines += std::size_t(std::count(text.begin(), text.end(), '\n'));
        whole = whole && (text.empty() || text.back() == '\n');
    });
    CHECK(lines == 150001);
    CHECK(pieces > 1);
    CHECK(whole);
    CHECK(most < (1 << 20) + 100);
}

TEST_CASE("a raster is written in its order, with the same bytes for any number of threads")
{
    RasterResult raster;
    raster.yaw = 0.1;
    std::string expected = "x,y,z,yaw,layer,verdict\n";
    for (int i = 0; i < 150000; ++i) {
        const int row = i / 700;
        raster.poses.push_back({i % 700 * 0.25, row * 0.5, -1.5, i % 3 - 1, i % 2 ? Verdict::Valid : Verdict::Steep});
        const std::string layer = i % 3 == 0 ? "" : std::to_string(i % 3 - 1);
        expected += number(i % 700 * 0.25) + "," + number(row * 0.5) + ",-1.5,0.1," + layer +
                    (i % 2 ? ",valid\n" : ",steep\n");
    }
    for (const int threads : {1, 2, 8}) {
        CAPTURE(threads);
        std::string text;
        write_raster_csv(
            raster, false, [&](std::string_view piece) { text += piece; }, threads);
        CHECK(text == expected);
    }
}

TEST_CASE("poses are read from the JSON files that commands write, as from their CSV files")
{
    const std::string head = "{\"format\": \"spawnfield-fleet-poses/1\", ";
    const PoseTable table = parse_poses(
        "\n " + head +
            "\"robots\": [{\"name\": \"a,\\n\", \"kind\": \"k\", \"position\": [0.1, -2, 3e-7], "
            "\"rpy\": [0.1, 0.2, 0.3]}, {\"position\": [1, 2, 3], \"rpy\": [0, 0, 7]}]}",
        "f.json");
    REQUIRE(table.poses.size() == 2);
    CHECK(table.poses[0].position == Vec3(0.1, -2, 3e-7));
    CHECK(table.poses[0].rotation == rotation_from_rpy(0.1, 0.2, 0.3));
    CHECK(column_of(table, "name") == std::vector<std::string>{"a,", ""});
    CHECK(column_of(table, "kind") == std::vector<std::string>{"k", ""});
    CHECK(table.notices.size() == 1);  // more than a turn
    const auto refuses = [&](const std::string& text, const std::string& message) {
        CAPTURE(text);
        CHECK_THROWS_WITH(parse_poses(text, "f.json"), Contains("f.json: ") && Contains(message));
    };
    refuses("{", "is not valid JSON");
    refuses(head + "\"robots\": [{\"position\": [1e999, 0, 0]}]}", "is not valid JSON");
    refuses("{\"format\": 3}",
            "format is \"\", needs one with poses: spawnfield-spawns/1, spawnfield-verdicts/1, "
            "spawnfield-fleet-poses/1");
    refuses("{\"format\": \"spawnfield-pairs/1\"}", "format is \"spawnfield-pairs/1\"");
    refuses(head + "\"poses\": []}", "robots is missing or no list");
    refuses(head + "\"robots\": [3]}", "pose 1: is not an object");
    refuses(head + "\"robots\": [{\"position\": [1, 2], \"rpy\": [0, 0, 0]}]}", "pose 1: position is missing, or");
    refuses(head + "\"robots\": [{\"position\": [1, 2, 3], \"rpy\": [0, 0, null]}]}", "pose 1: rpy is missing, or");
    refuses(head + "\"robots\": [{\"position\": [1, 2, 3], \"rpy\": [0, 0, 0], \"name\": 3}]}", "name is not a text");
    refuses(head + "\"robots\": []}", "has a header but no pose");
    CHECK(parse_poses(head + "\"robots\": []}", "f.json", true).poses.empty());
}

TEST_CASE("spawns as JSON have unit quaternions, names, their settings and their map")
{
    SpawnList list;
    list.spawns = {{{1, 2, 3}, 0.5}};
    list.counts[Verdict::Valid] = 1;
    list.undecided_area = 2.5;
    Map map;
    map.name = "arena";
    map.hash = "0123456789abcdef";
    map.bounds = {Vec3(-1, -2, -3), Vec3(4, 5, 6)};
    Robot robot = load_robot("box:1,1,1");
    robot.name = "rover";
    robot.joints = {{"arm", 0.5}};
    const SampleOptions options{.count = 4,
                                .min_distance = 0.25,
                                .random_yaw = true,
                                .seed = 42,
                                .stance = Stance::Level,
                                .offset = 0.2,
                                .layers = {LayerChoice::Kind::Index, 1}};
    const std::vector<RobotStart> robots = robot_starts(list, {"rover_1"}, {"fleet/rover_1"});
    const auto json = nlohmann::json::parse(spawns_json(robots, list, Judge(map, robot), options));
    CHECK(json["map"]["hash"] == "0123456789abcdef");
    CHECK(json["robot"] == "rover");
    CHECK(json["joints"] == nlohmann::json{{"arm", 0.5}});
    CHECK_FALSE(json.contains("mesh_parts"));
    CHECK(json["command"] == "sample");
    CHECK(json["version"] == version());
    const auto& settings = json["settings"];
    CHECK(settings["count"] == 4);
    CHECK(settings["min_distance"] == 0.25);
    CHECK(settings["seed"] == 42);
    CHECK(settings["yaw"] == "random");
    CHECK(settings["offset"] == 0.2);
    CHECK(settings["layers"] == 1);
    CHECK(settings["bounds"] == std::vector<double>{-1, -2, 4, 5});
    CHECK_FALSE(
        (settings.contains("max_slope") || settings.contains("max_water_depth") || settings.contains("max_height")));
    CHECK(json["counts"]["valid"] == 1);
    CHECK(json["full"] == false);
    CHECK(json["undecided_area"] == 2.5);
    CHECK(json["quaternion_order"] == "xyzw");
    REQUIRE(json["poses"].size() == 1);
    const auto& pose = json["poses"][0];
    CHECK(pose["name"] == "rover_1");
    CHECK(pose["namespace"] == "fleet/rover_1");
    CHECK(pose["position"] == std::vector<double>{1, 2, 3});
    const auto q = pose["quaternion"].get<std::vector<double>>();
    CHECK(Eigen::Quaterniond(q[3], q[0], q[1], q[2]).toRotationMatrix().isApprox(rotation_from_rpy(0, 0, 0.5), 1e-14));

    const Judge strict(map, robot, {.max_height = 0.5, .max_slope = 0.3});
    const SearchOptions search{.bounds = {Vec3(0, 0, 0), Vec3(1, 1, 1)}};
    const auto searched = nlohmann::json::parse(spawns_json(robots, list, strict, search));
    CHECK(searched["command"] == "search");
    CHECK(searched["settings"]["max_height"] == 0.5);
    CHECK(searched["settings"]["max_slope"] == 0.3);
    CHECK(searched["settings"]["max_failures"] == 100000);
    CHECK(searched["settings"]["bounds"] == std::vector<double>{0, 0, 0, 1, 1, 1});
    CHECK_FALSE((searched.contains("full") || searched.contains("undecided_area")));

    const auto given = nlohmann::json::parse(poses_json(robot_starts(list), map, robot));
    CHECK(given["command"] == "export");
    CHECK(given["map"]["hash"] == "0123456789abcdef");
    CHECK_FALSE((given.contains("settings") || given.contains("counts") || given["poses"][0].contains("name")));
}

TEST_CASE("names of a table are kept, and its poses keep roll and pitch")
{
    const PoseTable table = read("name,x,y,z,roll,pitch,yaw\n\"a, b\",1,2,3,0.1,-0.2,0.3\nc,4,5,6,0,0,3\n");
    CHECK(column_of(table, "name") == std::vector<std::string>{"a, b", "c"});
    CHECK(column_of(table, "label").empty());
    const std::vector<RobotStart> robots = robot_starts(table, column_of(table, "name"));
    CHECK(robots[0].rpy.roll == Approx(0.1).epsilon(1e-15));
    CHECK(robots[0].rpy.pitch == Approx(-0.2).epsilon(1e-15));
    CHECK(robots[0].rpy.yaw == Approx(0.3).epsilon(1e-15));
    const PoseTable again = read(robots_csv(robots));
    CHECK(column_of(again, "name") == column_of(table, "name"));
    for (std::size_t i = 0; i < 2; ++i) CHECK(again.poses[i].rotation.isApprox(table.poses[i].rotation, 1e-15));
}
