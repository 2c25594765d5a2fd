#include "arena.h"
#include "test_map.h"

#include <spawnfield/error.h>
#include <spawnfield/frames.h>
#include <spawnfield/repair.h>
#include <spawnfield/robot_parts.h>
#include <spawnfield/scene_parts.h>

#include <nlohmann/json.hpp>

#include <cmath>
#include <numbers>

using namespace spawnfield;

namespace {

constexpr double pi = std::numbers::pi;

struct GridPose {
    double distance, turn;  ///< turn: without its sign
};

double lowest_of(const Robot& robot, const Mat3& rotation)
{
    double out = std::numeric_limits<double>::infinity();
    for (const RobotPart& part : robot.parts) {
        for (const Vec3& corner : part.hull_vertices) out = std::min(out, (rotation * corner).z());
        if (part.shape.kind == ShapeKind::Hull) continue;
        Shape shape = part.shape;
        shape.pose = Pose{Vec3::Zero(), rotation} * shape.pose;
        out = std::min(out, bounds_of(shape).min.z());
    }
    return out;
}

/// Returns all valid grid poses with a turn, by the definition in repair.h.
std::vector<GridPose> valid_grid_poses(const Judge& judge, const Pose& pose, const RepairOptions& options, double turn)
{
    const Mat3 rotation = rotation_from_rpy(0, 0, turn) * pose.rotation;
    const Geometry& geometry = judge.map().geometry;
    std::vector<double> heights{0.1 - lowest_of(judge.robot(), pose.rotation)};
    const auto ground = ground_below(column_at(geometry, pose.position.x(), pose.position.y()), pose.position.z());
    if (ground && pose.position.z() - ground->height <= judge.options().max_height)
        heights.push_back(pose.position.z() - ground->height);
    std::vector<GridPose> out;
    const auto add = [&](const Vec3& position) {
        const double distance = (position - pose.position).norm();
        if (distance <= options.radius + 1e-9) out.push_back({distance, std::abs(turn)});
    };
    const int most = int(options.radius / *options.step) + 1;
    for (int i = -most; i <= most; ++i)
        for (int j = -most; j <= most; ++j) {
            const double x = pose.position.x() + i * *options.step, y = pose.position.y() + j * *options.step;
            for (const double layer : column_at(geometry, x, y).layers) {
                if (options.stance == Stance::Settled) {
                    const SettledPose rest = judge.settle({x, y, layer}, std::atan2(rotation(1, 0), rotation(0, 0)));
                    if (rest.verdict == Verdict::Valid) add(rest.lifted(judge.options().stand.lift).position);
                    continue;
                }
                for (const double height : heights)
                    if (judge.is_valid({{x, y, layer + height}, rotation})) add({x, y, layer + height});
            }
        }
    return out;
}

/// Returns the nearest valid grid pose; of equally near ones, one with the smallest turn.
std::optional<GridPose> slow_repair(const Judge& judge, const Pose& pose, const RepairOptions& options)
{
    std::vector<GridPose> all = valid_grid_poses(judge, pose, options, 0);
    for (int k = 1; k < options.headings && (k > 1 || all.empty()); ++k) {
        const double turn = std::remainder(2 * pi * k / options.headings, 2 * pi);
        for (const GridPose& grid_pose : valid_grid_poses(judge, pose, options, turn)) all.push_back(grid_pose);
    }
    std::optional<GridPose> best;
    for (const GridPose& at : all)
        if (!best || at.distance < best->distance - 1e-9 ||
            (at.distance < best->distance + 1e-9 && at.turn < best->turn))
            best = at;
    return best;
}

void check_repair(const Judge& judge, const Pose& pose, const RepairOptions& options, const Repair& repair)
{
    const std::optional<GridPose> slow = slow_repair(judge, pose, options);
    REQUIRE(repair.pose.has_value() == slow.has_value());
    if (!slow) return;
    CHECK(std::abs(repair.distance - slow->distance) <= 1e-9);
    CHECK(std::abs(std::abs(repair.turn) - slow->turn) <= 1e-9);
    const Spawn& to = *repair.pose;
    CHECK(std::abs((to.position - pose.position).norm() - repair.distance) <= 1e-9);
    CHECK(judge.is_valid({to.position, rotation_from_rpy(to.roll, to.pitch, to.yaw)}));
    const Rpy before = rpy_from(pose.rotation);
    if (options.stance == Stance::Level)
        CHECK(std::abs(std::remainder(to.yaw - before.yaw - repair.turn, 2 * pi)) <= 1e-9);
}

void add_block(Scene& scene, const Vec3& low, const Vec3& high, Label label, const char* name)
{
    add_shape(scene, name, label, box_shape(high - low, {(low + high) / 2}));
}

Robot box_robot(const Vec3& size) { return make_robot("box", {shape_part(box_shape(size, {{0, 0, size.z() / 2}}))}); }

std::vector<Verdict> verdicts_of_poses(const Judge& judge, const std::vector<Pose>& poses)
{
    std::vector<Verdict> out;
    for (const Judgement& judged : judge.check(poses)) out.push_back(judged.verdict);
    return out;
}

}  // namespace

TEST_CASE("a repair is the nearest valid grid pose of its definition, in random scenes", "[slow]")
{
    const Stance stance = GENERATE(Stance::Level, Stance::Settled);
    std::size_t moved = 0, turned = 0, none = 0;
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
        const Scene scene = random_scene(seed);
        const Judge judge(map_of(scene), random_robot(seed));
        const bool is_settled = stance == Stance::Settled;  // this takes longer
        const RepairOptions options{
            .radius = 0.6, .step = is_settled ? 0.2 : 0.15, .headings = is_settled ? 4 : 6, .stance = stance};
        for (const Pose& pose : random_poses(scene, seed, is_settled ? 5 : 25)) {
            CAPTURE(seed, pose.position.transpose());
            const Repair repair = nearest_valid(judge, pose, options);
            check_repair(judge, pose, options, repair);
            ++(!repair.pose ? none : repair.turn == 0 ? moved : turned);
        }
    }
    CHECK(moved > 5);
    CHECK(turned > 0);
    CHECK(none > 5);
}

TEST_CASE("a robot beside a wall moves away from it, and one across a corridor turns")
{
    Scene scene;
    add_block(scene, {-5, -5, -1}, {5, 5, 0}, Label::Terrain, "floor");
    add_block(scene, {0.1, -5, 0}, {0.2, 5, 1}, Label::Obstacle, "wall");
    add_block(scene, {0.7, -5, 0}, {0.8, 5, 1}, Label::Obstacle, "other_wall");
    const Judge small(map_of(scene), box_robot({0.4, 0.4, 0.4}));
    const Repair away = nearest_valid(small, {{0, 0, 0.05}}, {.radius = 1, .step = 0.05});
    REQUIRE(away.pose);
    CHECK(away.turn == 0);
    CHECK(std::abs(away.distance - 0.15) <= 1e-9);  // at 0.1 m, it touches the wall
    CHECK((away.pose->position - Vec3(-0.15, 0, 0.05)).norm() <= 1e-9);

    const Judge large(map_of(scene), box_robot({1, 0.2, 0.4}));
    const Repair turned = nearest_valid(large, {{0.45, 0, 0.05}}, {.radius = 0.5});
    REQUIRE(turned.pose);
    CHECK(turned.turn == pi / 2);  // 67.5 degrees is not enough
    CHECK(turned.distance <= 1e-9);
    CHECK(turned.pose->yaw == pi / 2);
    const Repair settled = nearest_valid(large, {{0.45, 0, 0.05}}, {.radius = 0.5, .stance = Stance::Settled});
    REQUIRE(settled.pose);
    CHECK(settled.turn == pi / 2);
    CHECK(std::abs(settled.distance - 0.03) <= 1e-9);  // from 0.05 m to --lift

    CHECK_FALSE(nearest_valid(large, {{0.45, 0, 0.05}}, {.radius = 0.5, .headings = 1}).pose);
    const Repair sunk = nearest_valid(small, {{-2, 0, -0.3}}, {.radius = 0.5});
    REQUIRE(sunk.pose);
    CHECK((sunk.pose->position - Vec3(-2, 0, 0.1)).norm() <= 1e-9);
    CHECK_FALSE(nearest_valid(small, {{-2, 0, -0.3}}, {.radius = 0.39}).pose);
}

TEST_CASE("repairs of a list are the same for any number of threads, and with --exhaustive")
{
    const Scene scene = random_scene(3);
    const Judge judge(map_of(scene), random_robot(3));
    std::vector<Pose> poses = random_poses(scene, 3, 24);
    std::string text = "x,y,z,yaw\n";
    for (Pose& pose : poses) {
        const Vec3& p = pose.position;
        text += std::to_string(p.x()) + "," + std::to_string(p.y()) + "," + std::to_string(p.z()) + ",0.3\n";
    }
    const PoseTable table = parse_poses(text, "poses");
    for (const Stance stance : {Stance::Level, Stance::Settled}) {
        std::vector<Judgement> judgements = judge.check(table.poses);
        if (stance == Stance::Settled) {
            judgements.clear();
            for (const SettledPose& pose : judge.settle(table.poses)) judgements.push_back(judgement_of(pose));
        }
        RepairOptions options{.radius = 0.8, .step = 0.4, .headings = 4, .stance = stance, .threads = 1};
        const auto csv = [&](const Judge& by) {
            const RepairList list = repair_poses(by, table.poses, judgements, options);
            return verdicts_csv(table, judgements, judge.map(), &list) + repaired_csv(table, list);
        };
        const std::string one = csv(judge);
        for (const int threads : {2, 8}) {
            options.threads = threads;
            CHECK(csv(judge) == one);
        }
        CHECK(csv(without_mask(judge)) == one);
        const RepairList list = repair_poses(judge, table.poses, judgements, options);
        for (std::size_t i = 0; i < table.poses.size(); ++i)
            CHECK(list.repairs[i].has_value() == (judgements[i].verdict != Verdict::Valid));
        CHECK((list.repaired > 0 && list.unrepaired > 0));
        const std::vector<Verdict> after = verdicts_of_poses(judge,
                                                             parse_poses(repaired_csv(table, list), "new").poses);
        for (std::size_t i = 0; i < after.size(); ++i)
            if (list.repairs[i] && list.repairs[i]->pose) CHECK(after[i] == Verdict::Valid);
    }
}

TEST_CASE("options of repairs that are out of range are refused")
{
    const Judge judge(training_map(), husky());
    const auto repair = [&](const RepairOptions& options) { nearest_valid(judge, {}, options); };
    CHECK_THROWS_WITH(repair({.radius = 0}), "nearest_valid: radius is 0, needs > 0 m");
    CHECK_THROWS_WITH(repair({.radius = 1, .step = 0.00075}),
                      "nearest_valid: step is 0.00075, needs at least a thousandth of radius");
    CHECK_THROWS_WITH(repair({.headings = 0}), "nearest_valid: headings is 0, needs 1 .. 64");
    CHECK_THROWS_AS(nearest_valid(judge, {{NAN, 0, 0}}), ArgumentError);
    const std::vector<Pose> poses(2);
    CHECK_THROWS_WITH(repair_poses(judge, poses, {}), "repair_poses: size of judgements is 0, needs as many as poses");
    CHECK(auto_repair_step(husky(), 1) == 0.05);
    CHECK(auto_repair_step(box_robot({1, 0.1, 1}), 1) == Approx(0.025));
    CHECK(auto_repair_step(box_robot({1, 0.001, 1}), 1) == Approx(0.02));
}

TEST_CASE("a table with repairs keeps the texts of all that does not change, in any format of angles")
{
    const Repair turned{.pose = Spawn{{1, 2, 3}, pi / 2, 0, 0}, .distance = 1, .turn = pi / 2};
    const Repair tilted{.pose = Spawn{{1, 2, 3}, 0, 0.5, 0}, .distance = 1};
    const auto csv = [](const std::string& text, const Repair& repair) {
        const PoseTable table = parse_poses(text, "poses");
        RepairList list;
        list.repairs.resize(table.poses.size());
        list.repairs.back() = repair;
        return repaired_csv(table, list);
    };
    CHECK(csv("id,z,y,x,verdict,repair\n\"a, b\",0.10,0,0,valid,\n ,3.0,2,9,collision,none\n", tilted) ==
          "id,z,y,x,roll\n\"a, b\",0.10,0,0,0\n ,3.0,2,1,0.5\n");
    CHECK(csv("x,y,z,yaw_deg\n0,0,0,30\n0,0,0,360\n", tilted) ==
          "x,y,z,yaw_deg,roll_deg\n0,0,0,30,0\n1,2,3,360," + nlohmann::json(0.5 * 180 / pi).dump() + "\n");
    CHECK(csv("x,y,z,yaw_deg\n0,0,0,30\n0,0,0,0\n", turned) == "x,y,z,yaw_deg\n0,0,0,30\n1,2,3,90\n");
    CHECK(csv("x,y,z,qx,qy,qz,qw\n0,0,0,0,0,0,-1\n", Repair{.pose = Spawn{{1, 2, 3}, 0, 0, 0}}) ==
          "x,y,z,qx,qy,qz,qw\n1,2,3,0,0,0,-1\n");
    const Pose pose = parse_poses(csv("x,y,z,qx,qy,qz,qw\n0,0,0,0,0,0,1\n", turned), "new").poses.at(0);
    CHECK((pose.rotation - rotation_from_rpy(0, 0, pi / 2)).norm() <= 1e-12);
}

TEST_CASE("check --repair adds repairs to the verdicts and writes a repaired list, and --require-valid accepts it")
{
    const Arena arena;
    arena.write("poses.csv", "name,x,y,z,yaw\nstart,0,3,0.1,0.5\nwall,-6.5,-5,0.1,0\nlake,7,-7,0.1,0\n");
    const std::string command = "check map --poses poses.csv --repair 1 " + husky_option;
    const ProgramRun run = arena(command + "-o out.csv --repaired new.csv --threads 1");
    CHECK(run.status == 0);
    CHECK_THAT(run.err,
               Contains("1 repaired (0 turned), 1 without a repair; 3 poses: 1 valid, 1 collision, 1 submerged"));
    CHECK_THAT(run.err,
               Contains("1 pose has no repair: within 1 m, no place on a grid with a step of 0.05 m is valid at "
                        "any of 16 headings; a larger --repair or a smaller --repair-step may find one; "
                        "new.csv has the old poses there"));
    const PoseTable checked = read_poses(arena / "out.csv");
    CHECK(column_of(checked, "repair") == std::vector<std::string>{"", "moved", "none"});
    CHECK(bytes_of(arena / "new.csv").starts_with("name,x,y,z,yaw\nstart,0,3,0.1,0.5\nwall,-7.1,-5,0.1,0\nlake,7,-7,"));
    for (const std::string threads : {"2", "8"}) {
        CHECK(arena(command + "-o more.csv --repaired more_new.csv --threads " + threads).status == 0);
        CHECK(bytes_of(arena / "more.csv") == bytes_of(arena / "out.csv"));
        CHECK(bytes_of(arena / "more_new.csv") == bytes_of(arena / "new.csv"));
    }

    const auto json = nlohmann::json::parse(arena(command + "--format json -q").out);
    CHECK(json["settings"]["repair"] == nlohmann::json{{"radius", 1.0}, {"step", 0.05}, {"headings", 16}});
    CHECK(json["poses"][0]["repair"].is_null());
    CHECK(json["poses"][1]["repair"]["distance"].get<double>() == Approx(0.6));
    CHECK(json["poses"][2]["repair"]["found"] == false);
    CHECK_THAT(arena(command + "--format junit -q").out, Contains("grid poses within 1 m is valid"));

    const ProgramRun refused = arena(command + "--require-valid -q -o out.csv");
    CHECK(refused.status == 3);
    CHECK_THAT(refused.err, Contains("1 of 3 poses is neither valid nor repaired:\n  lake: submerged\n"));
    arena.write("poses.csv", "x,y,z,yaw\n0,3,0.1,0.5\n-6.5,-5,0.1,0\n5.5,7.5,-0.3,0\n");
    CHECK(arena(command + "--settle --repaired new.csv --require-valid -q -o out.csv").status == 0);
    CHECK(read_poses(arena / "new.csv").header == "x,y,z,yaw,pitch");  // the last one is on a ramp
    CHECK(arena("check map --poses new.csv --require-valid -q -o out.csv" + husky_option).status == 0);
}

TEST_CASE("check writes verdicts and repaired poses, or none of them, and refuses what does not go together")
{
    const Arena arena;
    arena.write("poses.csv", "x,y,z\n-6.5,-5,0.1\n");
    const std::string command = "check map --poses poses.csv -q" + husky_option;
    CHECK(arena(command + "--repair 1 -o out.csv --repaired none/new.csv").status == 1);
    CHECK_FALSE(arena.names().contains("out.csv"));
    const auto refused = [&](const std::string& options, const std::string& message) {
        const ProgramRun run = arena(command + options);
        CHECK(run.status == 2);
        CHECK_THAT(run.err, Contains(message));
    };
    refused("--repair 0", "--repair is 0, needs > 0 m");
    refused("--repair nan", "--repair is nan, needs > 0 m");
    refused("--repaired new.csv", "--repaired needs --repair M");
    refused("--repair-step 0.1", "--repair-step needs --repair M");
    refused("--repair 1 --repair-step 0",
            "--repair-step is 0, needs at least 0.001 m, so that the grid has at most 3 million places");
    refused("--repair 1 --repaired -", "the result and --repaired would both go to standard output");
    refused("--repair 1 --settle --collision octree", "settled poses need geometry");
}
