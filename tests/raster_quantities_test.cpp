#include "arena.h"
#include "query/clearance.h"
#include "test_map.h"

#include <spawnfield/raster_quantities.h>

using namespace spawnfield;

namespace {

Pose pose_in(const RasterResult& raster, std::size_t p)
{
    const RasterPose& pose = raster.poses[p];
    if (raster.rests.empty()) return {{pose.x, pose.y, pose.z}, rotation_from_rpy(0, 0, raster.yaw)};
    const RasterRest& rest = raster.rests[p];
    return {{pose.x, pose.y, pose.z}, rotation_from_rpy(rest.roll, rest.pitch, rest.yaw)};
}

/// Returns the pose of a raster of one column that is the spawn.
std::optional<std::size_t> pose_of_spawn(const RasterResult& raster, const Spawn& spawn)
{
    for (std::size_t p = 0; p < raster.poses.size(); ++p)
        if (raster.poses[p].z == spawn.position.z() && raster.poses[p].verdict == Verdict::Valid) return p;
    return std::nullopt;
}

}  // namespace

TEST_CASE("a raster measures what sample measures at the same pose")
{
    for (const std::uint64_t seed : {3u, 5u, 8u})
        for (const Stance stance : {Stance::Level, Stance::Settled}) {
            const Judge judge(map_of(random_scene(seed)), husky());
            SampleOptions wanted{.count = 40, .yaw = 0.4, .seed = seed, .stance = stance};
            wanted.measures.columns = {PlaceQuantity::Clearance, PlaceQuantity::HeadRoom, PlaceQuantity::Roughness,
                                       PlaceQuantity::View};
            const SpawnList list = sample(judge, wanted);
            REQUIRE(list.spawns.size() > 10);
            for (std::size_t i = 0; i < list.spawns.size(); ++i) {
                const Vec3& at = list.spawns[i].position;
                const RasterResult one = raster(judge, {.step = 1,
                                                        .bounds = {Vec3(at.x(), at.y(), 0), Vec3(at.x(), at.y(), 0)},
                                                        .stance = stance,
                                                        .yaw = wanted.yaw});
                const std::optional<std::size_t> pose = pose_of_spawn(one, list.spawns[i]);
                REQUIRE(pose.has_value());
                for (const PlaceColumn& column : list.columns) {
                    const double value = raster_quantity(judge, one, column.quantity)[*pose];
                    CHECK((value == column.values[i] || (std::isnan(value) && std::isnan(column.values[i]))));
                }
            }
        }
}

TEST_CASE("clearances of a raster are those of each pose alone, bit by bit, with any number of threads")
{
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
        CAPTURE(seed);
        const Judge judge(map_of(random_scene(seed)), random_robot(seed));
        const Stance stance = seed % 2 == 0 ? Stance::Settled : Stance::Level;
        const RasterResult plain = raster(judge, {.step = 0.7, .stance = stance, .yaw = 0.2});
        const std::vector<double> values = raster_quantity(judge, plain, PlaceQuantity::Clearance, {}, {.threads = 1});
        REQUIRE(values.size() == plain.poses.size());
        const ClearanceMeter meter(judge.map().geometry, judge.robot());
        for (std::size_t p = 0; p < values.size(); ++p) {
            const bool is_valid = plain.poses[p].verdict == Verdict::Valid;
            CHECK(std::isnan(values[p]) == !is_valid);
            if (is_valid) CHECK(values[p] == meter.clearance_at(pose_in(plain, p)));
        }
        const std::vector<double> again = raster_quantity(judge, plain, PlaceQuantity::Clearance, {}, {.threads = 3});
        CHECK(std::equal(values.begin(), values.end(), again.begin(),
                         [](double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }));
    }
}

TEST_CASE("quantities of a raster name what is wrong")
{
    const Judge judge(training_map(), husky());
    const RasterResult level = raster(judge, {.step = 4});
    CHECK_THROWS_WITH(raster_quantity(judge, level, PlaceQuantity::Tilt),
                      "raster_quantity: the quantity tilt is only known of settled robots; give stance Settled, or "
                      "leave it out");
    CHECK_THROWS_WITH(raster_quantity(judge, level, PlaceQuantity::View, {.view_range = 0}),
                      "raster_quantity: view_range is 0, needs > 0 m");
    RasterResult settled = raster(judge, {.step = 4, .stance = Stance::Settled});
    settled.rests.clear();
    CHECK_THROWS_WITH(raster_quantity(judge, settled, PlaceQuantity::Clearance), Contains("size of raster.rests is 0"));
}

TEST_CASE("heatmap draws each measured quantity, and refuses what it cannot measure")
{
    const Arena arena;
    for (const std::string quantity : {"clearance", "head_room", "roughness", "view"}) {
        CAPTURE(quantity);
        const ProgramRun run = arena("heatmap map --step 1 -o " + quantity + ".svg --quantity " + quantity +
                                     husky_option);
        CHECK(run.status == 0);
    }
    CHECK(arena("heatmap map --step 1 -o room.svg --quantity room --reach-step 0.4" + husky_option).status == 0);
    CHECK_THAT(bytes_of(arena / "room.svg"), Contains("room to manoeuvre, m2"));
    CHECK_THAT(bytes_of(arena / "head_room.svg"), Contains("head room, m"));
    const auto message = [&](const std::string& arguments) {
        const ProgramRun run = arena("heatmap map --step 1 -o x.png" + arguments + husky_option);
        CHECK(run.status == 2);
        return run.err;
    };
    CHECK(message(" --quantity clearance --yaw random --stance level") ==
          "spawnfield: --quantity clearance needs one heading at each place; give --yaw an angle, for example 90deg\n");
    CHECK_THAT(message(" --quantity room --stance level"), Contains("--quantity room is about the robot at rest"));
    CHECK(message(" --quantity clearance --view-range 3") == "spawnfield: --view-range is only for --quantity view\n");
    CHECK_FALSE(std::filesystem::exists(arena / "x.png"));
}
