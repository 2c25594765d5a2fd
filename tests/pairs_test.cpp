#include "catch.h"
#include "compare.h"
#include "junit_cases.h"
#include "program.h"
#include "rest_robots.h"
#include "temp_folder.h"
#include "test_map.h"

#include <spawnfield/frames.h>
#include <spawnfield/pair_files.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <set>

#include <nlohmann/json.hpp>
#include <yaml-cpp/yaml.h>

using namespace spawnfield;
using Json = nlohmann::json;
using rest_robots::add_block;
using rest_robots::boxy;

// Tests of start and goal pairs.

namespace {

/// Two rooms without a door between them; a wall with a gap divides the left one.
Scene two_rooms()
{
    Scene scene;
    add_block(scene, {-3, -2, -0.5}, {3, 2, 0});
    const auto wall = [&](double x, double low, double high) {
        add_shape(scene, "wall", Label::Obstacle, box_shape({0.1, high - low, 0.6}, {{x, (low + high) / 2, 0.3}}));
    };
    wall(1, -2, 2);
    wall(-1, -2, 1);
    return scene;
}

struct Rooms {
    TestMap map = map_of(two_rooms());
    Judge judge{map, boxy({0.3, 0.3, 0.2})};
    ReachGraph graph{judge, {.step = 0.1, .keep_ways = true}};

    PairList operator()(const PairOptions& options) const { return sample_pairs(judge, graph, options); }
};

/// A folder with a map of two rooms without a door between them.
class RoomsFolder : public TempFolder {
public:
    RoomsFolder()
    {
        write("rooms.yaml",
              "format: spawnfield-scene/1\nparts:\n"
              "- {name: floor, box: [6.1, 4, 0.2], xyz: [-0.95, 0, -0.1], label: terrain}\n"
              "- {name: wall, box: [0.1, 4, 1], xyz: [0.05, 0, 0.5], label: obstacle}\n");
        REQUIRE(run_program(*this, "bake rooms.yaml -o rooms").status == 0);
    }
    ProgramRun sample(const std::string& options) const
    {
        return run_program(*this, "sample rooms --robot box:0.3,0.3,0.2 " + options);
    }
};

/// Pairs of the two rooms: valid, unreachable, with a start in the wall, with a goal in the air, too direct.
const std::string given_pairs =
    "name,start_x,start_y,start_z,goal_x,goal_y,goal_z,pair_reason,goal_yaw_deg\n"
    "a,-2,0,0.1,-1,0,0.1,old,90\nb,-2,0,0.1,1,0,0.1,old,0\n\"c, d\",0.22,0,0.1,-1,0,0.1,old,0\n"
    ",-2,0,0.1,-1,0,5,old,0\n,0.22,1,0.1,-0.12,0.5,0.1,old,0\n";

}  // namespace

TEST_CASE("pairs are on one island, within the limits, and their path lengths are those of a search")
{
    const Rooms rooms;
    const PairOptions options{
        .spawns = {.count = 100, .random_yaw = true, .seed = 5}, .min_path = 1, .max_path = 4, .min_detour = 1.1};
    const PairList list = rooms(options);
    REQUIRE(list.pairs.size() == 100);
    PathSearch search(rooms.graph);
    std::size_t left = 0;
    for (const StartGoal& pair : list.pairs) {
        REQUIRE((pair.start.verdict == Verdict::Valid && pair.goal.verdict == Verdict::Valid));
        CHECK(rooms.graph.island_of(pair.start) == pair.island);
        CHECK(rooms.graph.island_of(pair.goal) == pair.island);
        CHECK((pair.start.position.x() < 1) == (pair.goal.position.x() < 1));
        CHECK((pair.path_length >= 1 && pair.path_length <= 4 && pair.detour() >= 1.1));
        CHECK(pair.path_length >= pair.straight);
        CHECK(pair.path_length == search.path(pair.start, pair.goal)->length);
        left += pair.start.position.x() < 1;
    }
    CHECK(left == 100);  // only there, a wall is in the way
}

TEST_CASE("pairs are the same at any number of threads, and differ between seeds")
{
    const Rooms rooms;
    const auto text = [&](int threads, std::uint64_t seed) {
        PairOptions options{.spawns = {.count = 40, .random_yaw = true, .seed = seed, .threads = threads},
                            .keep_paths = true};
        options.min_path = 1;
        const PairList list = rooms(options);
        return pairs_csv(list, 0.02) + paths_csv(list, 0.02);
    };
    const std::string one = text(1, 3);
    CHECK(one == text(2, 3));
    CHECK(one == text(8, 3));
    CHECK(one != text(1, 4));
}

TEST_CASE("pairs that are stopped are the first ones of the whole list", "[slow]")
{
    const Rooms rooms;
    PairOptions options{.spawns = {.count = 400, .random_yaw = true, .seed = 5}, .min_path = 1, .max_path = 4};
    const std::string all = pairs_csv(rooms(options), 0.02);
    std::set<std::size_t> sizes;
    for (const long asked : {0L, 10L, 400L, 1500L, 1600L, 1700L, 1800L, 100000L}) {
        CAPTURE(asked);
        std::atomic<long> left{asked};
        options.spawns.stop = [&] { return left.fetch_sub(1) <= 0; };
        options.spawns.threads = int(asked % 3 + 1);
        const PairList part = rooms(options);
        CHECK(all.starts_with(pairs_csv(part, 0.02)));
        CHECK(part.is_stopped == (part.pairs.size() < 400));
        CHECK(part.starts == part.pairs.size() + part.without_goal);
        sizes.insert(part.pairs.size());
    }
    CHECK(sizes.size() >= 4);
    CHECK((sizes.contains(0) && sizes.contains(400)));
}

TEST_CASE("goals are uniform by area among those that fit")
{
    const Rooms rooms;
    const std::size_t count = compare::all_scenes() ? 3000 : 700;
    const PairList list = rooms({.spawns = {.count = count, .random_yaw = true, .seed = 1}});
    REQUIRE(list.pairs.size() == count);
    // Without limits, goals fill the room of the start. The left one has the width 4 m, less margins.
    std::size_t low = 0, all = 0;
    for (const StartGoal& pair : list.pairs) {
        if (pair.goal.position.x() > -1.3) continue;  // beside the wall, both halves are not alike
        ++all;
        low += pair.goal.position.y() < 0;
    }
    REQUIRE(all > count / 6);
    CHECK(std::abs(double(low) / double(all) - 0.5) < 4 * 0.5 / std::sqrt(double(all)));
}

TEST_CASE("pairs that cannot exist are missing, and faults in the options are named")
{
    const Rooms rooms;
    const PairList none = rooms({.spawns = {.count = 2}, .min_path = 100});
    CHECK(none.pairs.empty());
    CHECK((none.starts == 20 && none.without_goal == 20));
    CHECK_THROWS_WITH(rooms({.min_path = -1}), Contains("min_path") && Contains("-1"));
    CHECK_THROWS_WITH(rooms({.min_path = 2, .max_path = 1}), Contains("max_path"));
    CHECK_THROWS_WITH(rooms({.min_detour = 0.5}), Contains("min_detour") && Contains("0.5"));
    CHECK_THROWS_WITH(rooms({.spawns = {.min_distance = 1}}), Contains("min_distance"));
    CHECK_THROWS_WITH(rooms({.spawns = {.stance = Stance::Level}}), Contains("Settled"));
    const ReachGraph islands_only(rooms.judge, {.step = 0.5});
    CHECK_THROWS_WITH(sample_pairs(rooms.judge, islands_only, {}), Contains("does not keep its ways"));
}

TEST_CASE("sample --pairs writes pairs and paths, all poses of which are valid for check --settle")
{
    const RoomsFolder rooms;
    const std::string options = "--pairs 20 --min-path 1 --max-path 2.5 --yaw random --reach-step 0.1 --seed 4 ";
    const ProgramRun run = rooms.sample(options + "--path paths.csv --threads 1");
    REQUIRE(run.status == 0);
    CHECK(std::count(run.out.begin(), run.out.end(), '\n') == 21);
    CHECK_THAT(run.err, Contains("20 of 20 pairs"));
    const PoseTable paths = parse_poses(bytes_of(rooms / "paths.csv"), "paths.csv");
    CHECK(paths.poses.size() > 100);
    CHECK(column_of(paths, "pair").back() == "19");
    const ProgramRun check = run_program(
        rooms, "check rooms --robot box:0.3,0.3,0.2 --poses paths.csv --settle --require-valid");
    CHECK(check.status == 0);
    const std::string first = bytes_of(rooms / "paths.csv");
    for (const char* const threads : {"2", "8"}) {
        CHECK(rooms.sample(options + "--path paths.csv --threads " + threads).out == run.out);
        CHECK(bytes_of(rooms / "paths.csv") == first);
    }
    const ProgramRun few = rooms.sample("--pairs 3 --min-path 50 --reach-step 0.2");
    CHECK(few.status == 3);
    CHECK_THAT(few.err, Contains("only 0 of 3 pairs were found") && Contains("--min-path"));
    for (const std::string& line : {std::string("--pairs 5 --island at:1,0"), std::string("--pairs 5 --island 0")}) {
        const ProgramRun one = rooms.sample(line + " --reach-step 0.2");
        CHECK(one.status == 0);
        CHECK(std::count(one.out.begin(), one.out.end(), '\n') == 6);
    }
}

TEST_CASE("all formats of pairs have the poses and lengths of the CSV file")
{
    const RoomsFolder rooms;
    const std::string options = "--pairs 7 --min-path 1 --yaw random --reach-step 0.2 --seed 4 --island largest ";
    const auto run = [&](const std::string& more) {
        const ProgramRun out = rooms.sample(options + more);
        REQUIRE(out.status == 0);
        return out.out;
    };
    std::string csv = run("");
    // The same columns for the goals as those of a table of poses.
    const std::vector<std::string> names{"x", "y", "z", "roll", "pitch", "yaw"};
    const auto poses_of = [&](const std::string& end) {
        std::string text = csv;
        for (const std::string& name : names) text.replace(text.find(end + name + ","), end.size() + name.size(), name);
        return parse_poses(text, "pairs");
    };
    const PoseTable starts = poses_of("start_"), goals = poses_of("goal_");
    REQUIRE(starts.poses.size() == 7);
    const auto length = [&](std::size_t k) { return std::stod(column_of(starts, "path_length")[k]); };
    constexpr double lift = 0.02;
    const Vec3 up(0, 0, lift);

    const Json json = Json::parse(run("--format json"));
    CHECK(json["format"] == "spawnfield-pairs/1");
    CHECK(json["settings"]["min_path"] == 1);
    CHECK(json["settings"]["islands"] == "island largest");
    REQUIRE(json["pairs"].size() == 7);
    const YAML::Node nav2 = YAML::Load(run("--format nav2-goals"));
    REQUIRE(nav2.size() == 7);
    rooms.sample(options + "--format habitat --scene-id data/rooms.glb -o rooms.json.gz");
    REQUIRE(std::system(
                ("gzip -dc " + (rooms / "rooms.json.gz").string() + " > " + (rooms / "rooms.json").string()).c_str()) ==
            0);
    const Json habitat = Json::parse(bytes_of(rooms / "rooms.json"));
    REQUIRE(habitat["episodes"].size() == 7);

    const auto check_position = [](const Vec3& found, const Vec3& wanted) { CHECK((found - wanted).norm() < 1e-9); };
    for (std::size_t k = 0; k < 7; ++k) {
        CAPTURE(k);
        const auto vec = [](const Json& xyz) { return Vec3(xyz[0], xyz[1], xyz[2]); };
        const Json& pair = json["pairs"][k];
        check_position(vec(pair["start"]["position"]), starts.poses[k].position);
        check_position(vec(pair["goal"]["position"]), goals.poses[k].position);
        CHECK(double(pair["start"]["rpy"][2]) == Approx(rpy_from(starts.poses[k].rotation).yaw));
        CHECK(double(pair["path_length"]) == length(k));

        for (const auto& [name, poses] : {std::pair("start", &starts.poses), std::pair("goal", &goals.poses)}) {
            const YAML::Node stamped = nav2[k][name], at = stamped["pose"]["position"],
                             turn = stamped["pose"]["orientation"];
            CHECK(stamped["header"]["frame_id"].as<std::string>() == "map");
            check_position({at["x"].as<double>(), at["y"].as<double>(), at["z"].as<double>()},
                           (*poses)[k].position - up);
            const Eigen::Quaterniond rotation(turn["w"].as<double>(), turn["x"].as<double>(), turn["y"].as<double>(),
                                              turn["z"].as<double>());
            check_position(rotation * Vec3::UnitX(), (*poses)[k].rotation * Vec3::UnitX());
        }
        CHECK(nav2[k]["path_length"].as<double>() == length(k));

        // Habitat: x to the right, y up, z backwards; an agent looks along -z of its own frame.
        const Json& episode = habitat["episodes"][k];
        const auto in_map = [](const Vec3& point) { return Vec3(point.x(), -point.z(), point.y()); };
        CHECK(episode["episode_id"] == std::to_string(k));
        CHECK(episode["scene_id"] == "data/rooms.glb");
        check_position(in_map(vec(episode["start_position"])), starts.poses[k].position - up);
        check_position(in_map(vec(episode["goals"][0]["position"])), goals.poses[k].position - up);
        const Json& turn = episode["start_rotation"];
        const auto part = [&](int axis) { return turn[std::size_t(axis)].get<double>(); };
        const Eigen::Quaterniond rotation(part(3), part(0), part(1), part(2));
        check_position(in_map(rotation * -Vec3::UnitZ()), starts.poses[k].rotation * Vec3::UnitX());
        CHECK(double(episode["info"]["geodesic_distance"]) == length(k));
    }
}

TEST_CASE("judge_pairs finds the paths that sample_pairs has found, and says why others are not valid")
{
    const Rooms rooms;
    PairOptions options{.spawns = {.count = 30, .random_yaw = true, .seed = 9, .threads = 1}, .min_path = 1};
    const PairList list = rooms(options);
    REQUIRE(list.pairs.size() == 30);
    std::vector<Pose> starts, goals;
    const auto raised = [](const SettledPose& pose) {
        return Pose{pose.position + 0.02 * Vec3::UnitZ(), rotation_of_rpy(pose.roll, pose.pitch, pose.yaw)};
    };
    for (const StartGoal& pair : list.pairs) {
        starts.push_back(raised(pair.start));
        goals.push_back(raised(pair.goal));
    }
    const auto judged = judge_pairs(rooms.judge, rooms.graph, starts, goals, options);
    for (std::size_t k = 0; k < judged.size(); ++k) {
        CAPTURE(k);
        CHECK(judged[k].verdict == PairVerdict::Valid);
        CHECK(*judged[k].path_length == list.pairs[k].path_length);
        CHECK(*judged[k].straight == list.pairs[k].straight);
        CHECK(judged[k].start_island == list.pairs[k].island);
    }
    for (const int threads : {2, 8}) {
        options.spawns.threads = threads;
        const auto again = judge_pairs(rooms.judge, rooms.graph, starts, goals, options);
        for (std::size_t k = 0; k < judged.size(); ++k) CHECK(again[k].path_length == judged[k].path_length);
    }
    // Each limit is the first one that does not hold.
    const auto verdict = [&](const Vec3& start, const Vec3& goal, const PairOptions& limits = {}) {
        const Pose from{start}, to{goal};
        return judge_pairs(rooms.judge, rooms.graph, std::span(&from, 1), std::span(&to, 1), limits)[0].verdict;
    };
    const Vec3 left(-2, -1, 0.02), middle(0, -1, 0.02), right(2, 0, 0.02);
    CHECK(verdict(left, middle) == PairVerdict::Valid);
    CHECK(verdict(left, right) == PairVerdict::Unreachable);
    CHECK(verdict(left + Vec3::UnitX(), middle) == PairVerdict::StartNotValid);  // in the wall
    CHECK(verdict(left, middle - Vec3::UnitX()) == PairVerdict::GoalNotValid);
    CHECK(verdict(left, middle + 3 * Vec3::UnitZ()) == PairVerdict::GoalNotValid);
    // Around the wall, whose end is at y = 1: more than twice the way from there.
    const double least = 2 * std::hypot(1, 2);
    CHECK(verdict(left, middle, {.max_path = least}) == PairVerdict::TooLong);
    CHECK(verdict(left, middle, {.min_path = least, .max_path = least + 1}) == PairVerdict::Valid);
    CHECK(verdict(left, middle, {.min_path = least + 1}) == PairVerdict::TooShort);
    CHECK(verdict(left, middle, {.min_detour = least / 2}) == PairVerdict::Valid);
    CHECK(verdict(left, middle, {.min_detour = least / 2 + 0.5}) == PairVerdict::TooDirect);
    CHECK_THROWS_WITH(judge_pairs(rooms.judge, rooms.graph, starts, {}, {}), Contains("as many as starts"));
}

TEST_CASE("check --pairs accepts the pairs of sample, and adds its verdicts to those of a file")
{
    const RoomsFolder rooms;
    const std::string robot = "--robot box:0.3,0.3,0.2 --reach-step 0.2 ";
    REQUIRE(rooms.sample("--pairs 12 --min-path 1 --yaw random --reach-step 0.2 -o pairs.csv").status == 0);
    const ProgramRun all = run_program(rooms, "check rooms " + robot + "--pairs pairs.csv --require-valid");
    CHECK(all.status == 0);
    CHECK_THAT(all.err, Contains("12 pairs: 12 valid"));
    const PairTable before = parse_pairs(bytes_of(rooms / "pairs.csv"), "before"),
                    after = parse_pairs(all.out, "after");
    for (const std::string name : {"start_x", "goal_yaw", "path_length", "straight", "detour", "island"})
        CHECK(column_of(before.starts, name) == column_of(after.starts, name));
    CHECK(column_of(after.goals, "pair_verdict") == std::vector<std::string>(12, "valid"));
    for (const std::string threads : {"1", "8"})
        CHECK(run_program(rooms, "check rooms " + robot + "--pairs pairs.csv --threads " + threads).out == all.out);

    rooms.write("given.csv",
                "name,start_x,start_y,start_z,goal_x,goal_y,goal_z,goal_yaw_deg\n"
                "a,-2,0,0.1,-1,0,0.1,90\nb,-2,0,0.1,1,0,0.1,0\nc,-2,0,5,-1,0,0.1,0\n");
    const ProgramRun given = run_program(rooms, "check rooms " + robot + "--pairs given.csv --require-valid");
    CHECK(given.status == 3);
    const PoseTable table = parse_pairs(given.out, "given").starts;
    CHECK(column_of(table, "name") == std::vector<std::string>{"a", "b", "c"});
    CHECK(column_of(table, "pair_verdict") == std::vector<std::string>{"valid", "unreachable", "start_not_valid"});
    CHECK(column_of(table, "start_verdict") == std::vector<std::string>{"valid", "valid", "aerial"});
    CHECK(std::stod(column_of(table, "path_length")[0]) == Approx(1).margin(1e-9));
    CHECK(column_of(table, "path_length")[1].empty());
    CHECK_THAT(given.err, Contains("2 of 3 pairs are not valid") &&
                              Contains("pair 2: unreachable: the start is on island 0, the goal on island 1") &&
                              Contains("pair 3: start_not_valid: aerial: 5 m above the ground"));

    const auto refuses = [&](const std::string& options, const std::string& message, int status = 2) {
        CAPTURE(options);
        const ProgramRun run = run_program(rooms, "check rooms --robot box:0.3,0.3,0.2 " + options);
        CHECK(run.status == status);
        CHECK(run.out.empty());
        CHECK_THAT(run.err, Contains(message));
    };
    refuses("", "--poses is required, or --pairs");
    refuses("--pairs given.csv --poses given.csv", "--poses has no effect with --pairs");
    refuses("--pairs given.csv --repair 1", "--repair has no effect with --pairs");

    refuses("--pairs given.csv --format xml", "--format: \"xml\" is not one of csv, json, junit");
    refuses("--pairs given.csv --stance level", "--pairs is only for settled robots");
    refuses("--pairs given.csv --min-path 2 --max-path 1", "--max-path is 1");
    refuses("--poses given.csv --detour 2", "--detour is only for --pairs");
    refuses("--poses given.csv --reach-step 1", "--reach-step is only for --pairs");
    rooms.write("bad.csv", "start_x,start_y,start_z,goal_x,goal_y\n0,0,0,1,1\n");
    refuses("--pairs bad.csv", "bad.csv: line 1: column goal_z is missing, needs a header with goal_x,goal_y,goal_z",
            4);
    rooms.write("bad.csv", "start_x,start_y,start_z,goal_x,goal_y,goal_z\n0,0,0,1,one,0\n");
    refuses("--pairs bad.csv", "bad.csv: line 2: column goal_y is \"one\", needs a number", 4);
}

TEST_CASE("check --pairs says why starts, goals and pairs are refused, and which part is hit")
{
    const RoomsFolder rooms;
    rooms.write("given.csv", given_pairs);
    const std::string command = "check rooms --robot box:0.3,0.3,0.2 --reach-step 0.2 --max-path 2.5 --pairs ";
    const ProgramRun csv = run_program(rooms, command + "given.csv");
    REQUIRE(csv.status == 0);
    CHECK(csv.out.starts_with("name,start_x,start_y,start_z,goal_x,goal_y,goal_z,goal_yaw_deg,pair_verdict,"));
    const PoseTable table = parse_pairs(csv.out, "given").starts;
    const auto column = [&](const std::string& name) { return column_of(table, name); };
    using Texts = std::vector<std::string>;
    const std::string rests = "off_terrain: it comes to rest on wall";
    CHECK(column("pair_verdict") ==
          Texts{"valid", "unreachable", "start_not_valid", "goal_not_valid", "start_not_valid"});
    CHECK(column("start_hit") == Texts{"", "", "wall", "", "wall"});
    CHECK(column("goal_hit") == Texts{"", "", "", "", "wall"});
    CHECK(column("start_reason") == Texts{"", "", rests, "", rests});
    const std::string high = "aerial: 5 m above the ground, the limit is 1 m (--max-height)";
    CHECK(column("goal_reason") == Texts{"", "", "", high, rests});
    CHECK(column("pair_reason") == Texts{"", "unreachable: the start is on island 0, the goal on island 1",
                                         "start_not_valid: " + rests, "goal_not_valid: " + high,
                                         "start_not_valid: " + rests});

    // Each pose of the reports is that of `check --poses` for the same pose.
    std::string poses = "x,y,z,yaw_deg\n";
    const PairTable given = parse_pairs(given_pairs, "given");
    for (const std::string end : {"start", "goal"}) {
        const PoseTable& ends = end == "start" ? given.starts : given.goals;
        for (std::size_t i = 0; i < 5; ++i) {
            const Vec3& p = ends.poses[i].position;
            poses += std::to_string(p.x()) + "," + std::to_string(p.y()) + "," + std::to_string(p.z()) + "," +
                     (end == "goal" && i == 0 ? "90\n" : "0\n");
        }
    }
    rooms.write("poses.csv", poses);
    const Json by_pose = Json::parse(
        run_program(rooms, "check rooms --robot box:0.3,0.3,0.2 --settle --format json -p poses.csv").out);
    const Json json = Json::parse(run_program(rooms, command + "given.csv --format json --threads 1").out);
    CHECK(json["format"] == "spawnfield-pair-verdicts/1");
    CHECK(json["settings"]["max_path"] == 2.5);
    CHECK(json["settings"]["stance"] == "settled");
    CHECK(json["counts"]["start_not_valid"] == 2);
    CHECK(json["counts"]["too_long"] == 0);
    REQUIRE(json["pairs"].size() == 5);
    for (std::size_t i = 0; i < 5; ++i) {
        CAPTURE(i);
        const Json& row = json["pairs"][i];
        CHECK(row["row"] == i + 1);
        CHECK(row["verdict"] == column("pair_verdict")[i]);
        CHECK((row["reason"].is_null() ? "" : row["reason"].get<std::string>()) == column("pair_reason")[i]);
        CHECK((row["path_length"].is_null() == column("path_length")[i].empty()));
        CHECK(row["columns"].size() == 8);  // without the replaced pair_reason
        for (const std::string end : {"start", "goal"}) {
            Json pose = by_pose["poses"][end == "start" ? i : 5 + i];
            for (const char* const key : {"row", "columns"}) pose.erase(key);
            CHECK(row[end] == pose);
        }
    }
    CHECK(json["pairs"][0]["start_island"] == json["pairs"][0]["goal_island"]);
    CHECK(json["pairs"][1]["start_island"] == 0);
    CHECK(json["pairs"][1]["goal_island"] == 1);
    CHECK(json["pairs"][2]["name"] == "c, d");

    const ProgramRun junit = run_program(rooms, command + "given.csv --format junit --require-valid");
    CHECK(junit.status == 3);
    const std::vector<JunitTestCase> cases = cases_of(junit.out);
    REQUIRE(cases.size() == 5);
    CHECK(cases[0].class_name == "rooms.box:0.3,0.3,0.2");
    CHECK(cases[0].type.empty());
    CHECK(cases[1].name == "b");
    CHECK(cases[3].name == "pair 4");
    for (std::size_t i = 1; i < 5; ++i) {
        CHECK(cases[i].type == column("pair_verdict")[i]);
        CHECK(cases[i].message == column("pair_reason")[i]);
    }
    CHECK_THAT(cases[2].text,
               Contains("row 3: \"c, d\",0.22,0,0.1,-1,0,0.1,old,0\nstart: " + rests +
                        "\nposition 0.22, 0, 0.1 m; roll, pitch, yaw 0, 0, 0 rad\nground at 0 m") &&
                   Contains("\nhit wall\ngoal: valid\nposition -1, 0, 0.1 m; roll, pitch, yaw 0, 0, 0 rad\n"
                            "ground at 0 m, 0 m below the origin\n"));
    CHECK_THAT(junit.out, Contains("<property name=\"max_path\" value=\"2.5\"/>"));
    for (const char* const format : {"json", "junit"}) {
        const std::string options = command + "given.csv --format " + format + " --threads ";
        CHECK(run_program(rooms, options + "1").out == run_program(rooms, options + "8").out);
    }
    // The limits of paths are reasons, too.
    const ProgramRun near = run_program(
        rooms, "check rooms --robot box:0.3,0.3,0.2 --reach-step 0.2 --max-path 0.5 --pairs given.csv --format json");
    CHECK(Json::parse(near.out)["pairs"][0]["reason"] == "too_long: the path is longer than 0.5 m (--max-path)");
}

TEST_CASE("faults in the options of pairs are named with their values and what to do")
{
    const RoomsFolder rooms;
    const auto refuses = [&](const std::string& options, const std::string& message) {
        CAPTURE(options);
        const ProgramRun run = rooms.sample(options);
        CHECK(run.status == 2);
        CHECK(run.out.empty());
        CHECK_THAT(run.err, Contains(message));
    };
    refuses("--seed 1", "--count is required, or --pairs");
    refuses("-n 5 --min-path 2", "--min-path is only for --pairs");
    refuses("--pairs 5 -n 5", "has no effect with --pairs; leave it out");
    refuses("--pairs 5 --min-distance 1", "--min-distance has no effect with --pairs");
    refuses("--pairs 0", "--pairs is 0, needs 1 to");
    refuses("--pairs 5 --min-path -1", "--min-path is -1");
    refuses("--pairs 5 --min-path 3 --max-path 2", "--max-path is 2");
    refuses("--pairs 5 --detour 0.9", "--detour is 0.9");
    refuses("--pairs 5 --stance level", "only for settled robots");
    refuses("--pairs 5 --format sdf", "--format is sdf, but --pairs writes csv, json, habitat or nav2-goals");
    refuses("-n 5 --format habitat", "--format habitat is only for --pairs");
    refuses("--pairs 5 --format json --scene-id a", "--scene-id is only for --format habitat");
}
