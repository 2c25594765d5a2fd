#include "catch.h"
#include "compare.h"
#include "robot/contacts.h"
#include "slow.h"
#include "worlds/hand_scene.h"

#include <spawnfield/error.h>
#include <spawnfield/poses.h>

#include <cmath>
#include <iostream>

using namespace spawnfield;
using enum Verdict;

// Tests of how a robot stands on the ground (its footing). Queries examine this only if max_slope is set.

namespace {

const std::uint64_t scene_count = is_slow_build() ? 10 : 60;

constexpr double off = std::numeric_limits<double>::infinity();

double rad(double degrees) { return degrees * M_PI / 180; }

Pose pose_at(double x, double y, double z, double yaw = 0, double roll = 0, double pitch = 0)
{
    return {{x, y, z}, rotation_of_rpy(roll, pitch, yaw)};
}

void add_box(Scene& scene, const Vec3& low, const Vec3& high, Label label = Label::Terrain)
{
    hand::add_shape(scene, label, {ShapeKind::Box, high - low, {(low + high) / 2, Mat3::Identity()}});
}

Scene floor_scene()
{
    Scene scene;
    add_box(scene, {-10, -10, -1}, {10, 10, 0});
    return scene;
}

/// Returns open ground that rises towards +x.
Scene slope_scene(double degrees)
{
    Scene scene;
    const Pose raised = {Vec3::Zero(), rotation_of_rpy(0, -rad(degrees), 0)};
    hand::add_mesh(scene, Label::Terrain, hand::moved(hand::rectangle(30, 20), raised), {.kind = "plane"});
    return scene;
}

/// Returns the verdict of one pose, after a check that the mask and the exhaustive query agree. max_slope is in
/// degrees.
Verdict verdict_of(const Scene& scene, const Robot& robot, const Pose& pose, double max_slope)
{
    const TestMap map = map_of(scene);
    const Judge judge(map, robot, {.max_slope = max_slope == off ? off : rad(max_slope)});
    const Verdict verdict = judge.check(pose).verdict;
    CHECK(judge.is_valid(pose) == (verdict == Valid));
    CHECK(judge.check(std::span(&pose, 1), {.threads = 1})[0].verdict == verdict);
    CHECK(without_mask(judge).check(pose).verdict == verdict);
    return verdict;
}

/// Returns a box robot whose contacts are at this distance from its origin.
Robot robot_on(double x, double y)
{
    Robot robot = load_robot("box:0.99,0.67,0.39");
    robot.contacts = {{x, y, 0}, {x, -y, 0}, {-x, y, 0}, {-x, -y, 0}};
    return robot;
}

Robot robot_of(const Shape& shape)
{
    Robot robot;
    robot.parts.resize(1);
    robot.parts[0].shape = shape;
    return robot;
}

/// Returns how far a polygon reaches in a direction.
double extent(const Polygon2& polygon, const Vec2& direction)
{
    double out = -off;
    for (const Vec2& corner : polygon) out = std::max(out, corner.dot(direction));
    return out;
}

/// Returns the hard case of a seed with a random max_slope. About half of the robots have random contacts.
HardCase case_with_limit(std::uint64_t seed, const HardOptions& hard_options = {})
{
    HardCase hard = hard_case(seed, hard_options);
    Random random{seed + 5};
    hard.max_slope = rad(random.between(3, 40));
    const int contacts = random.chance(0.5) ? 3 + random.below(3) : 0;
    for (int i = 0; i < contacts; ++i)
        hard.robot.contacts.push_back(
            {random.between(-0.4, 0.4), random.between(-0.4, 0.4), random.between(-0.1, 0.1)});
    return hard;
}

RasterOptions raster_options(const TestMap& map, const HardCase& hard, int columns)
{
    return {.step = (map.bounds.max - map.bounds.min).head<2>().maxCoeff() / (columns - 0.37),
            .offset = hard.offset,
            .yaw = hard.yaws[0],
            .threads = 1};
}

bool is_footing(Verdict verdict) { return verdict == Steep || verdict == Unstable; }

}  // namespace

TEST_CASE("a robot stands on the corners of its lowest parts, unless its file lists contacts")
{
    const std::vector<Vec3> box = contacts_of(load_robot("box:1,0.6,0.4"));
    REQUIRE(box.size() == 4);
    for (const Vec3& contact : box) CHECK(contact.cwiseAbs().isApprox(Vec3(0.5, 0.3, 0.02), 1e-12));

    // Points that are on a line except for rounding are not corners, on either side.
    Robot cart;
    for (const double x : {-0.256, 0.256})
        for (const double y : {-0.285, 0.285})
            cart.parts.push_back(
                robot_of({ShapeKind::Cylinder, {0.165, 0.1143, 0}, pose_at(x, y, 0.165, 0, M_PI / 2)}).parts[0]);
    const std::vector<Vec3> wheels = contacts_of(cart);
    CHECK(wheels.size() == 4);
    for (const Vec3& wheel : wheels) CHECK((wheel.cwiseAbs() - wheels[0].cwiseAbs()).norm() < 1e-9);

    const Polygon2 ball = lowest_footprint(robot_of({ShapeKind::Sphere, {0.5, 0, 0}, pose_at(1, 0, 0.7)}));
    CHECK(extent(ball, {1, 0}) == Approx(1 + std::sqrt(0.25 - 0.48 * 0.48)));
    CHECK(extent(ball, {0, -1}) == Approx(std::sqrt(0.25 - 0.48 * 0.48)));
    const Polygon2 disc = lowest_footprint(robot_of({ShapeKind::Cylinder, {0.2, 0.1, 0}, pose_at(0, 0, 0.05)}));
    CHECK(extent(disc, {0.6, 0.8}) == Approx(0.2).epsilon(0.01));
    CHECK(extent(disc, Vec2(1, 1).normalized()) < 0.21);  // round robots have no corners that could hang over an edge
    const Polygon2 wheel = lowest_footprint(
        robot_of({ShapeKind::Cylinder, {0.165, 0.1, 0}, pose_at(0, 0.3, 0.165, 0, M_PI / 2)}));
    CHECK(extent(wheel, {1, 0}) == Approx(std::sqrt(0.165 * 0.165 - 0.145 * 0.145)).epsilon(0.03));
    CHECK(extent(wheel, {0, 1}) == Approx(0.35));
    const Polygon2 pill = lowest_footprint(
        robot_of({ShapeKind::Capsule, {0.1, 1, 0}, pose_at(0, 0, 0.1, 0, 0, M_PI / 2)}));
    CHECK(extent(pill, {1, 0}) == Approx(0.5 + std::sqrt(0.01 - 0.0064)));
    CHECK(extent(pill, {0, 1}) == Approx(std::sqrt(0.01 - 0.0064)));

    Robot raised = load_robot("box:1,0.6,0.4@0,0,0.3");
    raised.parts.push_back(load_robot("box:0.2,0.2,0.2").parts[0]);
    CHECK(extent(lowest_footprint(raised), {1, 0}) == Approx(0.1));  // the body is too high to be a support

    CHECK(contacts_of(robot_on(0.2, 0.3)) == robot_on(0.2, 0.3).contacts);
    Robot bicycle = load_robot("box:1,0.6,0.4");
    for (const std::vector<Vec3>& line :
         {std::vector<Vec3>{{0.3, 0, 0}}, {{0.3, 0, 0}, {-0.3, 0, 0}}, {{0.3, 0.1, 0}, {0, 0, 0.2}, {-0.3, -0.1, 0}}}) {
        bicycle.contacts = line;
        CHECK(contacts_of(bicycle) == box);
    }
}

TEST_CASE("the footprint of the lowest parts agrees with dense samples of their lower sides")
{
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
        Robot robot = random_robot(seed);
        std::erase_if(robot.parts, [](const RobotPart& part) { return part.shape.kind == ShapeKind::Hull; });
        if (robot.parts.empty()) continue;
        const Bounds bounds = robot.bounds();
        Polygon2 low;
        for (double x = bounds.min.x(); x <= bounds.max.x(); x += 0.004)
            for (double y = bounds.min.y(); y <= bounds.max.y(); y += 0.004)
                for (const RobotPart& part : robot.parts)
                    if (const auto z = vertical_interval(part.shape, x, y);
                        z && z->bottom <= bounds.min.z() + contact_depth)
                        low.emplace_back(x, y);
        const Polygon2 polygon = lowest_footprint(robot);
        for (int k = 0; k < 16; ++k) {
            const Vec2 direction(std::cos(M_PI / 8 * k), std::sin(M_PI / 8 * k));
            CAPTURE(seed, k);
            CHECK(extent(polygon, direction) == Approx(extent(low, direction)).margin(0.008));
        }
    }
}

TEST_CASE("on level ground a robot stands with any limit, also if it leans a little")
{
    for (const Robot& robot :
         {husky(), load_robot("box:0.99,0.67,0.39"), robot_of({ShapeKind::Sphere, {0.3, 0, 0}, pose_at(0, 0, 0.3)})})
        for (const double limit : {0.1, 20.0, 89.9}) {
            CHECK(verdict_of(floor_scene(), robot, pose_at(1, 2, 0.1, 0.3), limit) == Valid);
            CHECK(verdict_of(floor_scene(), robot, pose_at(1, 2, 0.3, 0.3, 0.1, -0.2), limit) == Valid);
        }
    CHECK(verdict_of(floor_scene(), husky(), pose_at(1, 2, 0.1, 0.3), off) == Valid);
    CHECK(verdict_of(floor_scene(), husky(), pose_at(1, 2, 0.7, 0.3, M_PI / 2), 20) ==
          Unstable);  // it lies on its side, with two contacts above the other two
    CHECK(verdict_of(floor_scene(), husky(), pose_at(1, 2, 0.7, 0.3, M_PI / 2), off) == Valid);
}

TEST_CASE("a slope above the limit is steep, a slope at the limit is not, whichever way the robot faces")
{
    for (const double slope : {5.0, 10.0, 20.0, 40.0})
        for (const double limit : {1.0, 5.0, 9.9, 10.0, 19.0, 20.0, 30.0, 45.0, 80.0})
            for (const double yaw : {0.0, 0.7, 2.0}) {
                CAPTURE(slope, limit, yaw);
                const Pose pose = pose_at(0.3, 1, 0.7 + 0.3 * std::tan(rad(slope)), yaw);
                for (const Robot& robot : {husky(), robot_on(0.1, 0.1)})
                    CHECK(verdict_of(slope_scene(slope), robot, pose, limit) == (slope > limit ? Steep : Valid));
            }
    const Robot own = load_robot("box:0.3,0.3,0.3");
    CHECK(verdict_of(slope_scene(60), own, pose_at(0, 0, 0.5, 0.4), 20) == Steep);
    CHECK(verdict_of(slope_scene(60), own, pose_at(0, 0, 0.5, 0.4), 61) == Valid);
}

TEST_CASE("the slope also counts for a robot that is tilted like the ground")
{
    const Pose along = pose_at(0, 0, 0.2, 0, 0, -rad(20));
    CHECK(verdict_of(slope_scene(20), husky(), along, 25) == Valid);
    CHECK(verdict_of(slope_scene(20), husky(), along, 15) == Steep);
}

TEST_CASE("on a beam between its wheels, on a pillar and over an edge a robot is unstable")
{
    Scene scene = floor_scene();
    add_box(scene, {-8, -0.15, 0}, {-2, 0.15, 5});  // beam
    add_box(scene, {1, -0.15, 0}, {1.3, 0.15, 5});  // pillar
    add_box(scene, {3, -6, 4.8}, {9, 6, 5});        // deck
    const double limit = 30;
    CHECK(verdict_of(scene, husky(), pose_at(-5, 0, 5.1), off) == Valid);
    CHECK(verdict_of(scene, husky(), pose_at(-5, 0, 5.1), limit) == Unstable);
    CHECK(verdict_of(scene, husky(), pose_at(-5, 0, 5.1, M_PI / 2), limit) == Unstable);
    CHECK(verdict_of(scene, robot_on(0.3, 0.14), pose_at(-5, 0, 5.1), limit) == Valid);  // narrow enough for the beam
    CHECK(verdict_of(scene, robot_on(0.3, 0.14), pose_at(-5, 0.02, 5.1), limit) == Unstable);
    CHECK(verdict_of(scene, robot_on(0.3, 0.14), pose_at(-5, 0, 5.1, 0.2), limit) == Unstable);
    CHECK(verdict_of(scene, husky(), pose_at(1.15, 0, 5.1), limit) == Unstable);
    CHECK(verdict_of(scene, load_robot("box:0.29,0.29,1"), pose_at(1.15, 0, 5.1), limit) == Valid);
    CHECK(verdict_of(scene, load_robot("box:0.31,0.31,1"), pose_at(1.15, 0, 5.1), limit) == Unstable);

    CHECK(verdict_of(scene, husky(), pose_at(8.7, 0, 5.1), limit) == Valid);
    // The edge of the deck is at x = 9.
    CHECK(verdict_of(scene, husky(), pose_at(8.8, 0, 5.1), limit) == Unstable);  // both front wheels are beyond it
    CHECK(verdict_of(scene, husky(), pose_at(8.75, 0, 5.1, M_PI / 4), limit) == Unstable);  // one of them is beyond it
    CHECK(verdict_of(scene, husky(), pose_at(8.75, 0, 5.1, M_PI / 4), 80) == Unstable);
    CHECK(verdict_of(scene, husky(), pose_at(6, 0, 0.1), limit) == Valid);  // below the deck
    CHECK(verdict_of(scene, husky(), pose_at(9.6, 9.6, 0.1, 1), limit) == Valid);
    CHECK(verdict_of(scene, husky(), pose_at(9.7, 9.6, 0.1, 1), limit) == Unstable);  // a contact is beyond the scene
    CHECK(verdict_of(scene, husky(), pose_at(8.8, 0, 7), limit) == Aerial);           // aerial comes before unstable
}

TEST_CASE("a kerb under two wheels is ground, a wall or a bench under them is not")
{
    Scene scene = floor_scene();
    add_box(scene, {-8, -3, 0}, {8, -0.2, 0.1}, Label::Obstacle);
    CHECK(verdict_of(scene, husky(), pose_at(0, 0, 0.2), 20) == Valid);
    CHECK(verdict_of(scene, husky(), pose_at(0, 0, 0.2), 9) ==
          Unstable);  // the wheels are at 9.9 degrees, but on an edge and not on a slope
    Scene bench = floor_scene();
    hand::add_mesh(bench, Label::Obstacle, hand::moved(hand::rectangle(4, 2), {Vec3(0, -1.2, 0.4), Mat3::Identity()}),
                   {.kind = "plane"});
    CHECK(verdict_of(bench, husky(), pose_at(0, 0, 0.5), off) == Valid);
    CHECK(verdict_of(bench, husky(), pose_at(0, 0, 0.5), 20) == Unstable);  // two wheels are above the bench
    CHECK(verdict_of(bench, load_robot("box:0.6,0.5,0.2"), pose_at(0, -1, 0.1), 20) == Valid);  // below the bench
}

TEST_CASE("sunken and stacked solids count as one, and a low bump under the origin does not matter")
{
    Scene scene = floor_scene();
    add_box(scene, {-3, -3, -0.5}, {3, 3, 0.05});                  // a plate sunk into the floor
    add_box(scene, {-3, -3, 0.05}, {3, 3, 0.1}, Label::Obstacle);  // and one on top of it
    add_box(scene, {-0.1, -0.1, 0.1}, {0.1, 0.1, 0.13});           // terrain below the origin
    CHECK(verdict_of(scene, husky(), pose_at(0, 0, 0.2), 10) == Valid);
    CHECK(verdict_of(scene, husky(), pose_at(0, 0, 0.2), 1) == Unstable);  // 3 cm below the pose's ground
}

TEST_CASE("on a bridge that is terrain as a whole, frames, rails and pillars are unstable; deck and ground are not")
{
    Scene scene = floor_scene();
    const auto boxes = [](std::initializer_list<std::pair<Vec3, Vec3>> all) {
        hand::Mesh mesh;
        for (const auto& [low, high] : all) {
            const hand::Mesh box = hand::moved(hand::box(high - low), {(low + high) / 2, Mat3::Identity()});
            const auto first = std::uint32_t(mesh.vertices.size());
            mesh.vertices.insert(mesh.vertices.end(), box.vertices.begin(), box.vertices.end());
            for (const Triangle& t : box.triangles)
                mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
        }
        return mesh;
    };
    hand::add_mesh(scene, Label::Terrain, boxes({{{-6, -2, 2}, {6, 2, 2.2}}}));  // deck
    for (const double y : {-1.95, 1.95}) {
        hand::add_piece(scene, boxes({{{-6, y - 0.05, 2.2}, {6, y + 0.05, 3.2}}}));  // rails
        for (const double x : {-4.0, 4.0}) {
            hand::add_piece(scene, boxes({{{x - 0.15, y * 1.2 - 0.15, 0}, {x + 0.15, y * 1.2 + 0.15, 6}}}));  // pillars
            hand::add_piece(scene, boxes({{{x - 0.15, -2.5, 6}, {x + 0.15, 2.5, 6.3}}}));                     // frames
        }
    }
    const TestMap map = map_of(scene);
    const RasterOptions options{.step = 0.11, .offset = 0.1};
    const RasterResult without = raster(Judge(map, husky()), options);
    const RasterResult with = raster(Judge(map, husky(), {.max_slope = rad(25)}), options);
    std::size_t frames = 0, deck = 0, ground = 0;
    REQUIRE(with.poses.size() == without.poses.size());
    for (std::size_t i = 0; i < with.poses.size(); ++i) {
        const RasterPose& pose = with.poses[i];
        const double height = pose.z - *options.offset;
        frames += without.poses[i].verdict == Valid && height > 2.5;
        if (pose.verdict != Valid) continue;
        CHECK((std::abs(height) < 1e-9 || std::abs(height - 2.2) < 1e-9));
        ++(height > 1 ? deck : ground);
    }
    CHECK(frames > 100);
    CHECK(deck > 2000);
    CHECK(ground > 10000);
    CHECK(with.counts[Steep] == 0);
    CHECK(with.counts[Unstable] + with.counts[Valid] == without.counts[Valid]);
}

TEST_CASE("a max_slope out of its range is refused with its value and limits")
{
    const TestMap map = map_of(floor_scene());
    const std::pair<double, std::string> bad[] = {{0, "0"}, {-0.1, "-0.1"},        {M_PI / 2, "1.5707963267948966"},
                                                  {2, "2"}, {std::nan(""), "nan"}, {-off, "-inf"}};
    for (const auto& [limit, text] : bad) {
        CHECK_THROWS_WITH(Judge(map, husky(), {.max_slope = limit}),
                          "Judge: max_slope is " + text + ", needs > 0 and < pi/2 rad, or infinite");
    }
}

TEST_CASE("footings only remove valid poses, fewer with a larger limit, and need no additional exact checks")
{
    std::size_t steep = 0, unstable = 0, valid = 0, changed = 0, regained = 0;
    for (std::uint64_t seed = 1; seed <= scene_count; ++seed) {
        const HardCase hard = case_with_limit(seed);
        const TestMap map = compare::map_of_case(hard);
        const RasterOptions options = raster_options(map, hard, 40);
        std::vector<RasterResult> results;  // first without a limit, then with smaller and smaller limits
        for (const double limit : {off, 1.5, 1.0, 0.6, 0.35, 0.2, 0.1, 0.01}) {
            results.push_back(raster(Judge(map, hard.robot, {.max_slope = limit}), options));
        }
        for (std::size_t r = 1; r < results.size(); ++r) {
            CHECK(results[r].exact_checks == results[0].exact_checks);
            REQUIRE(results[r].poses.size() == results[0].poses.size());
            for (std::size_t i = 0; i < results[r].poses.size(); ++i) {
                const Verdict without = results[0].poses[i].verdict, verdict = results[r].poses[i].verdict;
                changed += verdict != without && !(without == Valid && is_footing(verdict));
                regained += verdict == Valid && results[r - 1].poses[i].verdict != Valid;
                steep += verdict == Steep;
                unstable += verdict == Unstable;
                valid += verdict == Valid;
            }
        }
    }
    CHECK(changed == 0);
    CHECK(regained == 0);
    if (!is_slow_build()) CHECK((steep > 1000 && unstable > 1000 && valid > 1000));
}

TEST_CASE("a mirrored scene mirrors the footings")
{
    std::size_t footings = 0, valid = 0, differences = 0;
    for (std::uint64_t seed = 1; seed <= scene_count; ++seed) {
        const HardCase hard = case_with_limit(seed, {.razor = false});
        const TestMap map = map_at(hard.scene, hard.resolution), mirror = map_at(mirrored(hard.scene), hard.resolution);
        const JudgeOptions limits{.max_height = std::max(hard.max_height, hard.offset), .max_slope = hard.max_slope};
        const Judge judge(map, hard.robot, limits), mirror_judge(mirror, mirrored(hard.robot), limits);
        std::vector<Pose> poses = compare::standing_poses(map, hard, map.bounds, 200), mirrored_poses = poses;
        for (Pose& pose : mirrored_poses) {
            const Eigen::DiagonalMatrix<double, 3> flip(1, -1, 1);
            pose = {flip * pose.position, flip * pose.rotation * flip};
        }
        const auto here = judge.check(poses, {.threads = 1}),
                   there = mirror_judge.check(mirrored_poses, {.threads = 1});
        for (std::size_t i = 0; i < poses.size(); ++i) {
            if (!is_footing(here[i].verdict) && here[i].verdict != Valid) continue;
            differences += here[i].verdict != there[i].verdict;
            ++(here[i].verdict == Valid ? valid : footings);
        }
    }
    CHECK(differences == 0);
    if (!is_slow_build()) CHECK((valid > 300 && footings > 300));
}

TEST_CASE("footings agree with their definition in random scenes")
{
    std::array<std::size_t, verdict_count> seen{};
    std::size_t undecided = 0;
    for (std::uint64_t seed = 1; seed <= scene_count; ++seed) {
        const TestMap map = map_of(random_scene(seed));
        Robot robot = random_robot(seed);
        if (seed % 2 == 0) robot.contacts = {{0.3, 0.2, -0.05}, {0.3, -0.2, 0.1}, {-0.4, 0, 0}};
        const Judge judge(map, robot, {.max_slope = rad(4 + 5 * double(seed % 7))});
        const std::vector<Pose> poses = random_poses(map.scene, seed, 120);
        const std::vector<Judgement> judged = judge.check(poses, {.threads = 1});
        for (std::size_t i = 0; i < poses.size(); ++i) {
            const Verdict verdict = judged[i].verdict;
            if (verdict != Valid && !is_footing(verdict)) continue;
            const auto slow = slow::footing(map.scene, robot, contacts_of(robot), poses[i], judged[i].ground->height,
                                            judge.options().max_slope);
            if (!slow)
                ++undecided;
            else
                ++seen[std::size_t(*slow)];
            INFO("scene " << seed << " " << compare::described(poses[i]) << ": " << to_string(verdict));
            CHECK(slow.value_or(verdict) == verdict);
        }
    }
    std::cout << "footings: " << seen[std::size_t(Valid)] << " valid, " << seen[std::size_t(Steep)] << " steep, "
              << seen[std::size_t(Unstable)] << " unstable, " << undecided << " too close to call\n";
    if (!is_slow_build())
        CHECK((seen[std::size_t(Valid)] > 1000 && seen[std::size_t(Steep)] > 100 && seen[std::size_t(Unstable)] > 100));
}

TEST_CASE("with footings every query gives the exhaustive verdicts in random hard scenes")
{
    compare::CaseTally all;
    for (std::uint64_t seed = 1; seed <= scene_count; ++seed) {
        const compare::CaseTally tally = compare::of_case(case_with_limit(seed));
        all.add(tally);
        INFO("scene " << seed << ": " << tally.sum().first);
        CHECK(tally.sum().differences == 0);
    }
    if (is_slow_build()) return;
    for (const compare::Tally& tally : {all.raster_2d, all.raster_3d, all.check})
        for (const Verdict verdict : {Steep, Unstable, Valid}) {
            INFO(to_string(verdict));
            CHECK(tally.verdicts[verdict] > 100);
        }
    CHECK(all.sample.poses > 200);
    CHECK(all.search.poses > 100);
    CHECK(all.collisions.verdicts[Unstable] + all.collisions.verdicts[Steep] == 0);
}

TEST_CASE("samples have a footing, and footings are the same bytes with any number of threads")
{
    for (std::uint64_t seed = 1; seed <= scene_count / 10; ++seed) {
        const HardCase hard = case_with_limit(seed);
        const TestMap map = compare::map_of_case(hard);
        const Judge judge(map, hard.robot, {.max_height = std::max(1.0, hard.offset), .max_slope = hard.max_slope});
        const Judge exhaustive = at_any_height(judge);
        RasterOptions options = raster_options(map, hard, 60);
        SampleOptions samples{.count = 60, .random_yaw = true, .stance = Stance::Level, .offset = hard.offset};
        std::vector<std::string> texts;
        for (const int threads : {1, 2, 8}) {
            options.threads = samples.threads = threads;
            std::string text;
            write_raster_csv(raster(judge, options), false, [&](std::string_view piece) { text += piece; });
            const SpawnList list = sample(judge, samples);
            texts.push_back(text + spawns_csv(list));
            for (const Spawn& spawn : list.spawns)
                CHECK(exhaustive.is_valid({spawn.position, rotation_from_rpy(0, 0, spawn.yaw)}));
        }
        CAPTURE(seed);
        CHECK(texts[0] == texts[1]);
        CHECK(texts[0] == texts[2]);
    }
}

TEST_CASE("where everything is too steep, sample finds nothing, but does not call the region full without a proof",
          "[slow]")
{
    const TestMap map = map_of(slope_scene(20));
    const Robot robot = load_robot("box:0.4,0.4,0.3");
    const SampleOptions options{
        .count = 5, .stance = Stance::Level, .offset = 0.3, .bounds = {Vec3(-1, -1, 0), Vec3(1, 1, 0)}};
    const SpawnList list = sample(Judge(map, robot, {.max_slope = rad(15)}), options);
    CHECK(list.spawns.empty());
    CHECK(list.counts[Steep] > 0);
    CHECK_FALSE(list.is_full);
    CHECK(list.undecided_area == Approx(4).epsilon(0.01));
    CHECK(sample(Judge(map, robot, {.max_slope = rad(25)}), options).spawns.size() == 5);
}
