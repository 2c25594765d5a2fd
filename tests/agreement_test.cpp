#include "catch.h"
#include "slow.h"
#include "test_map.h"

#include <map>
#include <sstream>

using namespace spawnfield;

namespace {

struct Tally {
    std::size_t decided = 0, open = 0, wrong = 0;
    std::map<Verdict, std::size_t> verdicts;
    std::string first;
};

std::string described(const Pose& pose, Verdict fast, Verdict slow)
{
    std::ostringstream out;
    out.precision(17);
    out << "at " << pose.position.transpose() << ": " << to_string(fast) << ", slowly " << to_string(slow) << "\n"
        << pose.rotation;
    return out.str();
}

/// Judges poses with check and with the independent decision, and counts where the two differ.
void compare(const TestMap& map, const Robot& robot, const std::vector<Pose>& poses, Tally& tally)
{
    const Judge judge(map, robot);
    const std::vector<Judgement> fast = judge.check(poses);
    for (std::size_t i = 0; i < poses.size(); ++i) {
        const slow::Decision slow = slow::decide(map.scene, map.bounds, robot, poses[i], 1.0, 1e9);
        if (!slow.verdict) {
            ++tally.open;
            continue;
        }
        ++tally.decided;
        ++tally.verdicts[*slow.verdict];
        const bool same_ground = slow.ground.has_value() == fast[i].ground.has_value() &&
                                 (!slow.ground || std::abs(*slow.ground - fast[i].ground->height) < 1e-6);
        if (*slow.verdict == fast[i].verdict && same_ground) continue;
        ++tally.wrong;
        if (tally.first.empty()) tally.first = described(poses[i], fast[i].verdict, *slow.verdict);
    }
}

}  // namespace

TEST_CASE("check agrees with an independent decision on 20,000 random poses in the training arena")
{
    const TestMap map = training_map();
    Tally tally;
    compare(map, husky(), random_poses(map.scene, 7, 20000), tally);
    INFO(tally.first);
    CHECK(tally.wrong == 0);
    CHECK(tally.decided > 19000);
    for (const Verdict verdict : {Verdict::Outside, Verdict::Aerial, Verdict::OffTerrain, Verdict::Submerged,
                                  Verdict::Collision, Verdict::Valid}) {
        INFO(to_string(verdict));
        CHECK(tally.verdicts[verdict] > 50);
    }
}

TEST_CASE("check agrees with an independent decision on 20,000 random poses in 30 random scenes")
{
    Tally all;
    for (std::uint64_t seed = 1; seed <= 30; ++seed) {
        const TestMap map = map_of(random_scene(seed));
        Tally tally;
        compare(map, random_robot(seed), random_poses(map.scene, seed, 667), tally);
        INFO("scene " << seed << " " << tally.first);
        CHECK(tally.wrong == 0);
        all.decided += tally.decided;
        all.open += tally.open;
        for (const auto& [verdict, count] : tally.verdicts) all.verdicts[verdict] += count;
    }
    CHECK(all.decided > 15000);
    for (const Verdict verdict :
         {Verdict::Aerial, Verdict::OffTerrain, Verdict::Submerged, Verdict::Collision, Verdict::Valid}) {
        INFO(to_string(verdict));
        CHECK(all.verdicts[verdict] > 50);
    }
}

TEST_CASE("layers agree with an independent second implementation")
{
    std::size_t several = 0, different = 0;
    for (std::uint64_t seed = 1; seed <= 60; ++seed) {
        const TestMap map = map_of(random_scene(seed));
        Random random(seed);
        for (int i = 0; i < 200; ++i) {
            const double x = random.between(-10, 10), y = random.between(-10, 10);
            const std::vector<double> fast = column_at(map.geometry, x, y).layers, slow = slow::layers(map.scene, x, y);
            several += fast.size() > 1;
            bool same = fast.size() == slow.size();
            for (std::size_t k = 0; same && k < fast.size(); ++k) same = std::abs(fast[k] - slow[k]) < 1e-7;
            different += !same;
            CAPTURE(seed, x, y, fast, slow);
            if (!same) CHECK(fast == slow);
        }
    }
    CHECK(different == 0);
    CHECK(several > 500);
}

TEST_CASE("a larger robot never gains a valid pose")
{
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        const TestMap map = map_of(random_scene(seed));
        const CollisionChecker small = checker_of(map, load_robot("box:0.4,0.3,0.2@0,0,0.2"));
        const CollisionChecker large = checker_of(map, load_robot("box:0.5,0.4,0.3@0,0,0.2"));
        std::size_t lost = 0;
        for (const Pose& pose : random_poses(map.scene, seed, 500)) {
            const bool small_free = small.is_free(pose), large_free = large.is_free(pose);
            CHECK((small_free || !large_free));
            lost += small_free && !large_free;
        }
        CHECK(lost > 0);
    }
}

TEST_CASE("a mirrored scene mirrors the verdicts")
{
    const TestMap map = training_map();
    Scene mirrored = map.scene;  // y becomes -y; boxes and balls are their own mirror images
    for (Primitive& primitive : mirrored.primitives) {
        primitive.shape.pose.position.y() *= -1;
        const Mat3 flip = Vec3(1, -1, 1).asDiagonal();
        primitive.shape.pose.rotation = flip * primitive.shape.pose.rotation * flip;
    }
    for (Vec3& vertex : mirrored.vertices) vertex.y() *= -1;
    const TestMap other = map_of(mirrored);
    const Robot robot = husky();
    const Judge judge(map, robot), mirror_judge(other, robot);
    for (Pose pose : random_poses(map.scene, 3, 3000)) {
        const Vec3 p = pose.position;
        const Judgement here = judge.check(pose);
        const Mat3 flip = Vec3(1, -1, 1).asDiagonal();
        pose = {Vec3(p.x(), -p.y(), p.z()), flip * pose.rotation * flip};
        const Judgement there = mirror_judge.check(pose);
        CHECK(here.verdict == there.verdict);
        CHECK(here.hit.has_value() == there.hit.has_value());
        if (here.hit && there.hit) CHECK(here.hit->part == there.hit->part);
    }
}
