#include "arena.h"
#include "fcl_robots.h"

#include <spawnfield/column.h>
#include <spawnfield/poses.h>

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>
#include <tinyxml2.h>

using namespace spawnfield;
using Json = nlohmann::json;

// Tests of `sample --fleet` and `sample --fill`.

namespace {

const std::string head = "format: spawnfield-fleet/1\n";
const std::string robots_folder = source_folder() + "/maps/robots/";

/// Three kinds of robots in the training arena.
std::string three_kinds()
{
    return head +
           "min_distance: 0.5\nbetween: [{kinds: [husky, cart], distance: 2}]\nrobots:\n- {name: husky, robot: '" +
           robots_folder + "husky.yaml', count: 3, min_distance: 2.5, yaw: random, model: 'model://husky'}\n" +
           "- {name: cart, robot: '" + robots_folder + "cart.urdf', count: 4, region: [-9, -9, 9, 9]}\n" +
           "- {name: marker, robot: 'box:0.3,0.3,0.4', count: 1, yaw: 'any:4', model: marker.sdf}\n";
}

/// The arena with a fleet file and a model of the markers.
class FleetArena : public Arena {
public:
    explicit FleetArena(const std::string& text = three_kinds())
    {
        write("fleet.yaml", text);
        write("marker.sdf",
              "<sdf version='1.7'><model name='m'><link name='l'><collision name='c'><geometry><box>"
              "<size>0.3 0.3 0.4</size></box></geometry><pose>0 0 0.2 0 0 0</pose></collision></link>"
              "</model></sdf>");
    }
    ProgramRun fleet(const std::string& options = "") const
    {
        return (*this)("sample map --fleet fleet.yaml " + options);
    }
};

Robot robot_of(const std::string& kind)
{
    return load_robot(kind == "husky"  ? robots_folder + "husky.yaml"
                      : kind == "cart" ? robots_folder + "cart.urdf"
                                       : "box:0.3,0.3,0.4");
}

}  // namespace

TEST_CASE("sample --fleet writes named robots that check calls valid, at any number of threads")
{
    const FleetArena arena;
    const ProgramRun run = arena.fleet("--seed 3 --threads 1");
    REQUIRE(run.status == 0);
    CHECK_THAT(run.err, Contains("8 of 8 robots"));
    CHECK(run.out.starts_with("name,kind,x,y,z,roll,pitch,yaw\nhusky_1,husky,"));
    CHECK_THAT(run.out, Contains("cart_4,cart,") && Contains("marker,marker,"));
    for (const char* const threads : {"2", "8"})
        CHECK(arena.fleet("--seed 3 --threads " + std::string(threads)).out == run.out);
    CHECK(arena.fleet("--seed 4").out != run.out);
    const PoseTable table = parse_poses(run.out, "fleet");
    const std::vector<std::string> kinds = column_of(table, "kind");
    for (std::size_t i = 0; i < kinds.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) {
            const double apart = (table.poses[i].position - table.poses[j].position).norm();
            CHECK(apart >= (kinds[i] == "husky" && kinds[j] == "husky"  ? 2.5
                            : kinds[i] == "cart" && kinds[j] == "husky" ? 2
                                                                        : 0.5));
            CHECK_FALSE(fcl_robots_meet(robot_of(kinds[i]), table.poses[i], robot_of(kinds[j]), table.poses[j]));
        }
    // `check` agrees with each kind, one after the other.
    for (const char* const kind : {"husky", "cart"}) {
        std::string rows = table.header + "\n";
        for (std::size_t i = 0; i < kinds.size(); ++i)
            if (kinds[i] == kind) rows += table.rows[i] + "\n";
        arena.write("kind.csv", rows);
        const std::string file = std::string(kind) == "husky" ? "husky.yaml" : "cart.urdf";
        CHECK(arena("check map --settle --require-valid --poses kind.csv --robot '" + robots_folder + file + "'")
                  .status == 0);
    }
}

TEST_CASE("files of a fleet for simulators have each robot with its own name and model")
{
    const FleetArena arena;
    const std::string csv = arena.fleet().out;
    const PoseTable table = parse_poses(csv, "fleet");
    const Json json = Json::parse(arena.fleet("--format json").out);
    CHECK(json["format"] == "spawnfield-fleet-poses/1");
    REQUIRE(json["robots"].size() == 8);
    CHECK(json["robots"][3]["name"] == "cart_1");
    CHECK(json["robots"][3]["kind"] == "cart");
    CHECK(json["robots"][3]["namespace"] == "cart_1");
    CHECK(json["robots"][3]["position"][0] == table.poses[3].position.x());
    CHECK(json["kinds"][0]["wanted"] == 3);
    CHECK(json["kinds"][0]["found"] == 3);
    CHECK(json["settings"]["between"][0]["distance"] == 2);

    REQUIRE(arena.fleet("--format sdf -o world.sdf").status == 0);
    tinyxml2::XMLDocument world;
    REQUIRE(world.LoadFile((arena / "world.sdf").c_str()) == tinyxml2::XML_SUCCESS);
    std::vector<std::string> names, uris;
    for (const auto* include = world.RootElement()->FirstChildElement("world")->FirstChildElement("include");
         include != nullptr; include = include->NextSiblingElement("include")) {
        names.push_back(include->FirstChildElement("name")->GetText());
        uris.push_back(include->FirstChildElement("uri")->GetText());
    }
    CHECK(names == column_of(table, "name"));
    REQUIRE(uris.size() == 8);
    CHECK(uris[0] == "model://husky");
    CHECK(uris[3] == robots_folder + "cart.urdf");
    CHECK(uris[7] == (arena / "marker.sdf").string());

    for (const char* const format : {"ros2-launch-py", "ros2-launch-xml", "ros1-launch"}) {
        const ProgramRun refused = arena.fleet("--format " + std::string(format));
        CHECK(refused.status != 0);  // model://husky is no file
    }
    std::string text = three_kinds();
    text.replace(text.find("model://husky"), 13, "marker.sdf");
    arena.write("fleet.yaml", text);
    const std::string launch = arena.fleet("--format ros2-launch-xml").out;
    CHECK_THAT(launch, Contains("cart.urdf -name cart_4 ") && Contains("marker.sdf -name husky_1 "));
    CHECK_THAT(arena.fleet("--format ros2-launch-py").out, Contains("marker.sdf'], 'marker', 'marker', "));
    CHECK_THAT(arena.fleet("--format ros1-launch").out, Contains("-sdf -file") && Contains("textfile="));
    CHECK_THAT(arena.fleet("--format carla").out, Contains("\"cart_4\""));

    const std::string bodies = arena.fleet("--format mujoco").out;
    tinyxml2::XMLDocument mujoco;
    REQUIRE(mujoco.Parse(bodies.c_str()) == tinyxml2::XML_SUCCESS);
    CHECK_THAT(bodies, Contains("<body name=\"husky_3\"") && Contains("<key name=\"spawns\""));
    // Only the carts have a mass in their file.
    std::size_t with_mass = 0;
    for (std::size_t at = 0; (at = bodies.find("<inertial pos", at)) != std::string::npos; ++at) ++with_mass;
    CHECK(with_mass == 4);
    CHECK_THAT(bodies, Contains("<inertial pos=\"0 0 0.2\" mass=\"20\" fullinertia=\"0.6 1 1.4 0 0 0\"/>"));
    CHECK_THAT(arena.fleet("--format mujoco").err,
               Contains("notice: husky has no mass and inertia of a rigid body in its file"));
    CHECK_THAT(arena.fleet("--format mujoco --keys together").out,
               !Contains("<body") && Contains("<key name=\"spawns\""));
    CHECK_THAT(arena.fleet("--format mujoco --keys each").err, Contains("--keys is each"));
}

TEST_CASE("a fleet of which a part has no room is written, with status 3 and what is missing")
{
    const FleetArena arena(head + "robots:\n- {name: a, robot: 'box:1,1,1', count: 2, region: '-1,-6,4,-2'}\n" +
                           "- {name: b, robot: 'box:1,1,1', count: 50, region: '-9,1,-6,4', min_distance: 2}\n");
    const ProgramRun run = arena.fleet("-o fleet.csv");
    CHECK(run.status == 3);
    CHECK_THAT(run.err, Contains("b: only ") && Contains(" of 50 robots found, and none can be added at the") &&
                            Contains("valid poses of a raster with steps of 0.25 m and 1 heading"));
    CHECK_THAT(run.err, !Contains("a: only"));
    CHECK_THAT(bytes_of(arena / "fleet.csv"), Contains("a_2,a,") && Contains("b_1,b,"));
    // A kind that fills comes after all others, and says so.
    arena.write("fleet.yaml",
                head + "robots:\n- {name: fill, robot: 'box:0.8,0.8,1', count: fill, region: '-9,1,-6,4'}\n" +
                    "- {name: one, robot: 'box:1,1,1', count: 1, region: '-9,1,-6,4'}\n");
    const ProgramRun filled = arena.fleet("--format json");
    CHECK(filled.status == 0);
    const Json json = Json::parse(filled.out);
    CHECK(json["robots"].size() > 2);
    CHECK(json["robots"].back()["name"] == "one");
    CHECK(json["robots"][0]["name"] == "fill_1");
    CHECK(json["kinds"][0]["proof"]["step"] == 0.2);
    CHECK(json["kinds"][0]["proof"]["valid"] > 50);
    CHECK_FALSE(json["kinds"][0].contains("wanted"));
    CHECK_FALSE(json["kinds"][1].contains("proof"));
    CHECK_THAT(filled.err, Contains("fill: " + std::to_string(json["robots"].size() - 1) + " robots, and none can be"));
    arena.write("fleet.yaml", head +
                                  "robots:\n- {name: a, robot: 'box:1,1,1', count: 2, formation: {shape: line, "
                                  "spacing: 0.9, at: [3, -2.5], heading: 90}}\n");
    const ProgramRun close = arena.fleet();
    CHECK(close.status == 3);
    CHECK_THAT(close.err, Contains("a: only 0 of 2 robots found, because a_2 has no place at 3.45, -2.5: it overlaps"));
}

TEST_CASE("sample --fill places robots until none has room")
{
    const Arena arena;
    const std::string options = "sample map --robot box:1,1,0.5 --region=-9,-9,0,0 ";
    const ProgramRun run = arena(options + "--fill --min-distance 2 --threads 1");
    REQUIRE(run.status == 0);
    CHECK(run.out.starts_with("x,y,z,roll,pitch,yaw,tilt,margin\n"));
    const auto found = std::count(run.out.begin(), run.out.end(), '\n') - 1;
    CHECK(found > 8);
    CHECK_THAT(run.err, Contains("robot: " + std::to_string(found) + " robots, and none can be added at the"));
    CHECK(arena(options + "--fill --min-distance 2 --threads 8").out == run.out);
    CHECK_THAT(arena(options + "--fill --min-distance 2 --name r_{i} --format json").out, Contains("\"r_3\""));
    CHECK_THAT(arena(options + "--fill --fill-step 0.4").err, Contains("steps of 0.4 m"));
    const auto refuses = [&](const std::string& more, const std::string& message) {
        const ProgramRun refused = arena(options + more);
        CAPTURE(more);
        CHECK(refused.status == 2);
        CHECK(refused.out.empty());
        CHECK_THAT(refused.err, Contains(message));
    };
    refuses("--fill -n 3", "--count has no effect with --fill");
    refuses("--fill --near 'a*' 0:1", "--near is not possible with --fill");
    refuses("--fill --min-distance=-1", "--min-distance is -1");
    refuses("--fill --fill-step 0", "--fill-step is 0");
    refuses("-n 3 --fill-step 1", "--fill-step is only for --fill and --fleet");
    refuses("--fill --fleet a.yaml", "--fleet and --fill are both given");
    refuses("--fleet a.yaml", "--robot is for one kind of robot");
    refuses("--fill --format thesis -o t", "--format thesis has no fleets");
}

TEST_CASE("Ctrl-C ends a fill or a fleet with status 130, and the robots that were placed are written")
{
    const FleetArena arena;
    const ProgramRun run = interrupt_program(
        arena,
        "sample map --robot box:0.3,0.3,0.2 --yaw random --fill --fill-step 0.05 -o filled.csv --summary s.json");
    CHECK(run.status == 130);
    const std::size_t filled = read_poses(arena / "filled.csv").poses.size();
    CHECK_THAT(run.err, Contains("spawnfield sample: interrupted; " + std::to_string(filled) + " robots; ") &&
                            Catch::Matchers::EndsWith("spawnfield: interrupted: " + std::to_string(filled) +
                                                      " robots were found and written\n"));
    CHECK(Json::parse(bytes_of(arena / "s.json"))["interrupted"] == true);
    arena.write("fleet.yaml", head + "robots:\n- {name: a, robot: 'box:0.3,0.3,0.2', count: 1000000, yaw: random}\n");
    const ProgramRun fleet = interrupt_program(arena, "sample map --fleet fleet.yaml --format json -o fleet.json");
    CHECK(fleet.status == 130);
    const Json json = Json::parse(bytes_of(arena / "fleet.json"));
    CHECK(json["interrupted"] == true);
    const std::size_t found = json["robots"].size();
    CHECK((found > 0 && json["kinds"][0]["found"] == found));
    CHECK_THAT(fleet.err, Catch::Matchers::EndsWith("spawnfield: interrupted: " + std::to_string(found) +
                                                    " robots of 1000000 were found and written\n"));
}

TEST_CASE("all robots of a fleet with one_island stand on one side of a wall")
{
    const FleetArena arena;
    arena.write("rooms.yaml",
                "format: spawnfield-scene/1\nparts:\n"
                "- {name: floor, box: [8, 4, 0.2], xyz: [1, 0, -0.1], label: terrain}\n"
                "- {name: wall, box: [0.1, 4, 1], xyz: [0, 0, 0.5], label: obstacle}\n");
    REQUIRE(arena("bake rooms.yaml -o rooms").status == 0);
    const std::string robots =
        "robots:\n- {name: a, robot: 'box:0.8,0.8,0.3', count: 3, yaw: random}\n"
        "- {name: b, robot: 'box:0.3,0.3,0.3', count: 12}\n";
    arena.write("fleet.yaml", head + "one_island: true\n" + robots);
    const std::string options = "sample rooms --reach-step 0.2 --seed 5 --fleet fleet.yaml";
    const ProgramRun one = arena(options);
    REQUIRE(one.status == 0);
    for (const Pose& pose : parse_poses(one.out, "fleet").poses) CHECK(pose.position.x() > 0);  // the larger side
    std::string left = robots;
    left.replace(left.find("yaw: random"), 11, "island: 'at:-1.5,0'");
    arena.write("fleet.yaml", head + "one_island: true\n" + left);
    const ProgramRun other = arena(options);
    REQUIRE(other.status == 0);
    for (const Pose& pose : parse_poses(other.out, "fleet").poses) CHECK(pose.position.x() < 0);
    arena.write("fleet.yaml", head + robots);
    const std::vector<Pose> both = parse_poses(arena("sample rooms --seed 5 --fleet fleet.yaml").out, "fleet").poses;
    CHECK(std::ranges::any_of(both, [](const Pose& pose) { return pose.position.x() < 0; }));
}

TEST_CASE("formations of a file stand in their shape, and a convoy drives from one place to another")
{
    const FleetArena arena(
        head + "formation: {shape: circle, spacing: 1.5, at: [-6, 3], heading: [-6, 9]}\nrobots:\n" +
        "- {name: a, robot: 'box:0.5,0.5,0.3', count: 2}\n- {name: b, robot: 'box:0.4,0.4,0.3', count: 4}\n");
    const ProgramRun circle = arena.fleet();
    REQUIRE(circle.status == 0);
    const std::vector<Pose> poses = parse_poses(circle.out, "fleet").poses;
    REQUIRE(poses.size() == 6);
    CHECK(poses[0].position.x() == Approx(-6));
    CHECK(poses[0].position.y() == Approx(4.5));
    for (const Pose& pose : poses) {
        CHECK(std::hypot(pose.position.x() + 6, pose.position.y() - 3) == Approx(1.5));
        const Vec3 ahead = pose.position + 1.5 * pose.rotation.col(0);
        CHECK(std::hypot(ahead.x() + 6, ahead.y() - 3) < 1e-9);
    }
    arena.write("fleet.yaml", head +
                                  "robots:\n- {name: a, robot: 'box:0.5,0.5,0.3', count: 4, formation: {shape: convoy, "
                                  "spacing: 1, from: [-7.2, 1.7], to: [2.9, 3.7]}}\n");
    const ProgramRun convoy = arena.fleet("--reach-step 0.25");
    REQUIRE(convoy.status == 0);
    const std::vector<Pose> cars = parse_poses(convoy.out, "fleet").poses;
    CHECK(cars[3].position.head<2>().isApprox(Eigen::Vector2d(-7.2, 1.7), 1e-9));
    CHECK(cars[0].position.x() > -6);
}

TEST_CASE("the ends of a convoy are checked before islands, whose words in the summary name their kind")
{
    const FleetArena arena(
        head + "one_island: true\nrobots:\n- {name: a, robot: 'box:0.5,0.5,0.3', count: 3}\n" +
        "- {name: b, robot: 'box:0.4,0.4,0.3', count: 2, formation: {shape: convoy, spacing: 1, from: [-7.2, 1.7], "
        "to: [7, -7]}}\n");
    const ProgramRun run = arena.fleet("--reach-step 0.4");
    CHECK(run.status == 4);
    CHECK_THAT(run.err,
               Contains("fleet.yaml: robots \"b\" (line 5): to is 7,-7, where the robot can stand at none of 16 "
                        "headings (at the first one: submerged); choose another place"));
    const auto is_graph = [](const std::string& name) { return name.starts_with("reach-"); };
    CHECK(std::ranges::none_of(names_in(arena / "map"), is_graph));  // no island was searched
    std::string text = bytes_of(arena / "fleet.yaml");
    text.replace(text.find("[7, -7]"), 7, "[2.9, 3.7]");
    arena.write("fleet.yaml", text);
    const ProgramRun complete = arena.fleet("--reach-step 0.4");
    CHECK(complete.status == 0);
    CHECK_THAT(complete.err, Contains("; a: ") && Contains("; b: ") && !Contains("a: b:"));
    CHECK(std::ranges::any_of(names_in(arena / "map"), is_graph));
}

TEST_CASE("the example fleet of the training arena is complete", "[slow]")
{
    const Arena arena;
    const ProgramRun run = arena("sample map --seed 2 --reach-step 0.4 --fleet '" + source_folder() +
                                 "/maps/training/fleet.yaml'");
    REQUIRE(run.status == 0);
    CHECK_THAT(run.err, Contains("18 of 18 robots"));
    const PoseTable table = parse_poses(run.out, "fleet");
    const std::vector<std::string> kinds = column_of(table, "kind");
    CHECK(
        std::ranges::any_of(table.poses, [](const Pose& pose) { return pose.rotation(2, 2) < 0.99; }));  // on the ramp
    for (std::size_t i = 0; i < kinds.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) {
            const bool is_mixed = (kinds[i] == "cart") != (kinds[j] == "cart") &&
                                  (kinds[i] == "husky") != (kinds[j] == "husky") && kinds[j] == "husky";
            CHECK((table.poses[i].position - table.poses[j].position).norm() >= (is_mixed ? 2 : 0.8));
        }
}

TEST_CASE("faults in fleet files are named with file, line, key and what is allowed")
{
    const FleetArena arena;
    const std::string kind = "{name: a, robot: 'box:1,1,1', count: 2";
    const auto refuses = [&](const std::string& text, const std::string& message, const std::string& options = "") {
        arena.write("fleet.yaml", head + text);
        const ProgramRun run = arena.fleet(options);
        CAPTURE(text);
        CHECK(run.status == 4);
        CHECK(run.out.empty());
        CHECK_THAT(run.err, Contains("fleet.yaml: ") && Contains(message));
    };
    const auto refuses_kind = [&](const std::string& more, const std::string& message,
                                  const std::string& options = "") {
        refuses("robots:\n- " + kind + more + "}\n", message, options);
    };
    refuses("robots: []\n", "robots is empty");
    refuses("robot: a\n", "robot is not a known key; known keys: format, robots");
    refuses("robots:\n- {robot: a}\n", "robots 1: name is missing");
    refuses("robots:\n- {name: a, count: 1}\n", "robots \"a\": robot is missing");
    refuses("robots:\n- {name: a, robot: 'box:1,1,1'}\n", "robots \"a\": count is missing");
    refuses("robots:\n- {name: a_1, robot: 'box:1,1,1', count: 1}\n", "are for the robots of a kind");
    refuses("robots:\n- {name: 'a b', robot: 'box:1,1,1', count: 1}\n", "name is \"a b\", needs letters");
    refuses("robots:\n- " + kind + "}\n- " + kind + "}\n", "name is \"a\", which is given twice");
    refuses("robots:\n- {name: a, robot: 'box:1,1,1', count: 1.5}\n", "count is 1.5, needs a whole number from 1 to");
    refuses_kind(", colour: red", "colour is not a known key");
    refuses_kind(", min_distance: -1", "min_distance is -1, needs >= 0");
    refuses_kind(", yaw: north", "robots \"a\" (line 3): yaw is \"north\", needs radians");
    refuses_kind(", layers: upper", "layers is \"upper\"");
    refuses_kind(", island: big", "island is \"big\"");
    refuses_kind(", drive: legs", "drive is \"legs\", needs one of differential, omni");
    refuses_kind(", max_slope: 120", "max-slope is 120");
    refuses_kind(", floor: -1", "floor is -1, needs a whole number");
    refuses_kind(", region: []", "region is empty");
    refuses_kind(", formation: {shape: star, spacing: 1}",
                 "shape is \"star\", needs one of line, grid, circle, convoy");
    refuses_kind(", formation: {shape: line}", "formation.spacing is missing");
    refuses_kind(", formation: {shape: line, spacing: 1, columns: 2}", "columns is not a known key");
    refuses_kind(", formation: {shape: line, spacing: 1, heading: [1, 2]}", "is a point, which needs `at`, too");
    refuses_kind(", formation: {shape: convoy, spacing: 1}", "a convoy needs either `path`");
    refuses_kind(", formation: {shape: convoy, spacing: 1, path: [[1, 2]]}", "fewer than two corners");
    refuses_kind(", yaw: random, formation: {shape: line, spacing: 1}", "the formation sets the yaw");
    refuses_kind("", "model is missing, but --format sdf needs it", "--format sdf");
    refuses("between: [{kinds: [a, c], distance: 1}]\nrobots:\n- " + kind + "}\n",
            "has \"c\", needs names of robots: a");
    refuses("one_island: maybe\nrobots:\n- " + kind + "}\n", "one_island is \"maybe\", needs one of true, false");
    refuses("formation: {shape: line, spacing: 1}\nrobots:\n- {name: a, robot: 'box:1,1,1', count: fill}\n",
            "no number of robots (count is fill)");
    refuses("one_island: true\nrobots:\n- " + kind + "}\n", "one_island is true, but it is only for settled",
            "--stance level");
    refuses_kind(", island: largest", "island is only for settled robots", "--stance level");
    refuses("robots:\n- {name: a, robot: none.yaml, count: 1}\n",
            "robots \"a\" (line 3): robot is none.yaml, which does");
    CHECK_THAT(arena.fleet("--name a").err, Contains("--name is for one kind of robot"));
    CHECK_THAT(arena.fleet("--yaw north").err, Contains("--yaw is \"north\""));
    CHECK_THAT(arena("sample map -n 3").err, Contains("--robot is required, or --fleet"));
}
