#include "catch.h"
#include "shared_scenes.h"
#include "slow.h"
#include "test_map.h"
#include "this_build.h"

#include <algorithm>
#include <iostream>

using namespace spawnfield;

namespace {

const std::size_t spawn_count = is_slow_build() ? 20 : 200;

/// A file as its makers publish it, and how a robot should stand there.
struct Case {
    std::string file;
    double offset;  ///< m, height of the robot's origin above its layer
    std::vector<LabelRule> labels = {};
    double resolution = 0.25;
};

const std::vector<Case>& cases()
{
    static const std::vector<Case> all = {
        {"city/worlds/simple_city.world", 0.2, {}, 0.5},
        {"warehouse/worlds/small_warehouse.world", 0.2},
        {"warehouse/worlds/no_roof_small_warehouse.world", 0.2},
        {"mine/worlds/pittsburgh_mine.world", 0.2},
        {"mine/models/pittsburgh_mine", 0.2},
        {"inspection/cpr_inspection_gazebo/models/water_table", 0.3},
        {"inspection/cpr_inspection_gazebo/urdf/inspection_geometry.urdf",
         0.3,
         {{"HEIGHT*", Label::Terrain}, {"WoodPlanks*", Label::Terrain}}},
        {"lunar_pit/models/lunar_tranquillitatis_pit", 0.3, {}, 1.0},
        {"interchange/models/cloverleaf_interchange", 0.2, {}, 0.5},
        {"parking_garage/models/parking_garage", 0.2},
        {"nasty/models/house_3", 0.2},
        {"nasty/models/collapsed_fire_station", 0.2},
        {"dem/river/DEM-kootenai_37x50_1x1.asc", 0.6},
        {"dem/gully/west_bijou_gully.asc", 0.6, {}, 0.5},
        {"dem/moon_tif/dem_moon.tif", 0.3},
        {"octomap/geb079.bt", 0.2},
        {"octomap/car_cloud400.bt", 0.2},
        {"kaykit_town/town.glb", 0.2},
    };
    return all;
}

/// Returns the part of a scene that matters near a place: whole pieces and primitives whose boxes reach there, seen
/// from above.
Scene near(const Scene& scene, const Vec3& place, double reach)
{
    const auto is_near = [&](const Bounds& box) {
        return box.min.x() <= place.x() + reach && box.max.x() >= place.x() - reach &&
               box.min.y() <= place.y() + reach && box.max.y() >= place.y() - reach;
    };
    Scene out;
    out.parts = scene.parts;
    out.vertices = scene.vertices;
    for (const Piece& piece : scene.pieces) {
        // Far triangles of sheets are left out. Solids stay whole, because lines through them count crossings.
        const auto box_of = [&](std::uint32_t first, std::uint32_t count) {
            Bounds box;
            for (std::uint32_t t = first; t < first + count; ++t)
                for (const std::uint32_t corner : scene.triangles[t]) box.extend(scene.vertices[corner]);
            return box;
        };
        if (!is_near(box_of(piece.first_triangle, piece.triangle_count))) continue;
        Piece kept = piece;
        kept.first_triangle = std::uint32_t(out.triangles.size());
        for (std::uint32_t t = piece.first_triangle; t < piece.first_triangle + piece.triangle_count; ++t) {
            if (!piece.solid && !is_near(box_of(t, 1))) continue;
            out.triangles.push_back(scene.triangles[t]);
            out.triangle_labels.push_back(scene.triangle_labels[t]);
            out.triangle_pieces.push_back(std::uint32_t(out.pieces.size()));
        }
        kept.triangle_count = std::uint32_t(out.triangles.size()) - kept.first_triangle;
        out.pieces.push_back(kept);
    }
    for (const Primitive& primitive : scene.primitives)
        if (is_near(bounds_of(primitive.shape))) out.primitives.push_back(primitive);
    return out;
}

}  // namespace

TEST_CASE("Spawns in each shared world, as its makers publish it, are valid by the independent decision")
{
    const auto folder = shared_scenes();
    if (!folder) return;
    const Robot robot = load_robot((*folder / "robot_husky/husky_description/urdf/husky.urdf").string());
    for (const Case& item : cases()) {
        CAPTURE(item.file);
        const Scene scene = load_scene(*folder / item.file, {.labels = item.labels});
        const TestMap map = map_of(scene, item.resolution, scene.map_bounds);
        const Judge judge(map, robot);
        SampleOptions options{.count = spawn_count,
                              .min_distance = 0.1,
                              .random_yaw = true,
                              .seed = 6,
                              .stance = Stance::Level,
                              .offset = item.offset};
        const SpawnList list = sample(judge, options);
        CHECK(list.spawns.size() == spawn_count);
        std::size_t decided = 0, wrong = 0;
        for (const Spawn& spawn : list.spawns) {
            const Pose pose{spawn.position, rotation_from_rpy(0, 0, spawn.yaw)};
            const slow::Decision decision = slow::decide(near(map.scene, spawn.position, 3), map.bounds, robot, pose,
                                                         judge.options().max_height, judge.options().max_water_depth,
                                                         1e-6);
            decided += decision.verdict.has_value();
            wrong += decision.verdict && *decision.verdict != Verdict::Valid;
        }
        CAPTURE(decided);
        CHECK(wrong == 0);
        CHECK(4 * decided >= 3 * spawn_count);  // the others are too close to a limit for the independent decision
        std::cout << item.file << ": " << list.spawns.size() << " spawns, " << decided << " decided\n";
    }
}
