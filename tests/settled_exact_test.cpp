#include "catch.h"
#include "compare.h"
#include "shared_scenes.h"
#include "test_map.h"

#include <spawnfield/poses.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

using namespace spawnfield;

// Tests that settled rasters are the same with every pose checked exactly, and that their valid poses are valid.

namespace {

struct Compared {
    VerdictCounts counts;
    std::size_t valid_as_given = 0;
};

/// Compares a settled raster with about `columns` columns, and checks its valid poses as given.
void compare_settled(const Judge& judge, double columns, double yaw, Compared& out)
{
    const Vec3 size = judge.map().bounds.max - judge.map().bounds.min;
    const RasterOptions options{
        .step = std::sqrt(size.x() * size.y() / columns), .stance = Stance::Settled, .yaw = yaw};
    const RasterResult fast = raster(judge, options);
    CHECK(csv_of(fast) == csv_of(raster(without_mask(judge), options)));
    out.counts += fast.counts;
    std::vector<Pose> poses;
    for (std::size_t i = 0; i < fast.poses.size(); ++i) {
        if (fast.poses[i].verdict != Verdict::Valid) continue;
        const RasterRest& rest = fast.rests[i];
        poses.push_back(
            {{fast.poses[i].x, fast.poses[i].y, fast.poses[i].z}, rotation_from_rpy(rest.roll, rest.pitch, rest.yaw)});
    }
    const std::vector<Judgement> judged = judge.check(poses);
    for (std::size_t i = 0; i < poses.size(); ++i) {
        out.valid_as_given += judged[i].verdict == Verdict::Valid;
        CAPTURE(poses[i].position.transpose(), to_string(judged[i].verdict));
        CHECK(judged[i].verdict == Verdict::Valid);
    }
}

}  // namespace

TEST_CASE("settled rasters of random scenes are the same with --exhaustive")
{
    Compared all;
    for (std::uint64_t seed = 1; seed <= compare::scene_count(); ++seed) {
        CAPTURE(seed);
        const HardCase hard = hard_case(seed);
        const TestMap map = compare::map_of_case(hard);
        compare_settled(Judge(map, hard.robot, {.max_height = hard.max_height}), 40, hard.yaws[0], all);
    }
    CHECK(all.valid_as_given == all.counts[Verdict::Valid]);
    if (!compare::all_scenes()) return;
    for (const Verdict verdict : {Verdict::Valid, Verdict::Collision, Verdict::Unstable}) {
        CAPTURE(to_string(verdict));
        CHECK(all.counts[verdict] >= 200);
    }
}

TEST_CASE("settled rasters of real scenes are the same with --exhaustive", "[slow]")
{
    const auto folder = shared_scenes();
    if (!folder) return;
    Compared all;
    std::size_t scenes = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(
             *folder, std::filesystem::directory_options::follow_directory_symlink)) {
        if (entry.path().filename() != "scene.yaml") continue;
        CAPTURE(entry.path().string());
        ++scenes;
        const Scene scene = load_scene(entry.path());
        const Vec3 size = scene.bounds().max - scene.bounds().min;
        const TestMap map = map_of(scene, std::max(0.1, std::sqrt(size.x() * size.y() / 1e5)));
        compare_settled(Judge(map, husky()), 300, 0.6, all);
    }
    CHECK(scenes >= 10);
    CHECK(all.valid_as_given == all.counts[Verdict::Valid]);
    for (const Verdict verdict : {Verdict::Valid, Verdict::Collision, Verdict::Unstable, Verdict::Steep}) {
        CAPTURE(to_string(verdict));
        CHECK(all.counts[verdict] >= 20);
    }
}
