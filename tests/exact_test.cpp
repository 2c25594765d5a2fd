#include "catch.h"
#include "compare.h"
#include "sdf_world.h"
#include "shared_scenes.h"

#include <spawnfield/free_space.h>
#include <spawnfield/poses.h>

#include <algorithm>
#include <iostream>
#include <set>

using namespace spawnfield;

// With the free-space mask every query gives exactly the verdicts of the exhaustive query, pose by pose.

namespace {

using compare::all_scenes, compare::scene_count;

/// Checks that some poses were proven and some were not; without both, the comparison would mean nothing.
void check_shares(const compare::Tally& tally, double least_proven)
{
    if (!all_scenes()) return;
    CAPTURE(tally.asked, tally.exact);
    CHECK(tally.exact > 0);
    CHECK(double(tally.exact) <= (1 - least_proven) * double(tally.asked));
}

void check_verdicts(const compare::Tally& tally, const std::vector<Verdict>& expected, std::size_t least)
{
    if (!all_scenes()) return;
    for (const Verdict verdict : expected) {
        INFO(to_string(verdict));
        CHECK(tally.verdicts[verdict] >= least);
    }
}

void print(const char* what, const compare::Tally& tally)
{
    std::cout << what << ": " << tally.poses << " poses,";
    for (const Verdict verdict : all_verdicts)
        std::cout << " " << tally.verdicts[verdict] << " " << to_string(verdict) << ",";
    std::cout << " " << tally.exact << " of " << tally.asked << " checked exactly\n";
}

/// Compares poses in the order of the other raster.
bool earlier(const RasterPose& a, const RasterPose& b)
{
    return std::tuple(a.y, a.x, -a.z) < std::tuple(b.y, b.x, -b.z);
}

struct Change {
    std::size_t valid = 0, other = 0, lost = 0, gained = 0;  ///< lost and gained count valid poses
};

/// Counts how the verdict of each pose changes. The poses must be the same up to rounding.
Change change(const std::vector<RasterPose>& before, const std::vector<RasterPose>& after)
{
    Change out;
    REQUIRE(before.size() == after.size());
    for (std::size_t i = 0; i < before.size(); ++i) {
        const bool was = before[i].verdict == Verdict::Valid, is = after[i].verdict == Verdict::Valid;
        ++(was ? out.valid : out.other);
        out.lost += was && !is;
        out.gained += is && !was;
    }
    return out;
}

/// Returns a raster with steps that are multiples of 2^-6 m, from a place with such coordinates. After mirroring, all
/// columns have exactly the same coordinates.
RasterOptions dyadic_raster(const TestMap& map, const HardCase& hard)
{
    Random random{hard.seed + 3};
    RasterOptions options{
        .step = (1 + random.below(16)) / 64.0, .offset = hard.offset, .yaw = hard.yaws[0], .threads = 1};
    const Bounds crop = compare::crop_near(map, random, options.step, 20);
    options.bounds = crop;
    for (int axis = 0; axis < 2; ++axis) {
        options.bounds.min[axis] = std::round(crop.min[axis] * 64) / 64;
        options.bounds.max[axis] = options.bounds.min[axis] + 19 * options.step;
    }
    return options;
}

bool same_verdicts(const std::vector<RasterPose>& a, const std::vector<RasterPose>& b)
{
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const RasterPose& l, const RasterPose& r) {
        return l.layer == r.layer && l.verdict == r.verdict;
    });
}

std::size_t valid_count(const std::vector<RasterPose>& poses)
{
    return std::size_t(std::count_if(poses.begin(), poses.end(),
                                     [](const RasterPose& pose) { return pose.verdict == Verdict::Valid; }));
}

/// Returns a case with a shared scene, the Husky, and a mask of about a million columns.
HardCase real_case(const std::filesystem::path& file)
{
    HardCase out;
    out.scene = load_scene(file);
    out.robot = husky();
    out.yaws = {0.6};
    const Vec3 size = out.scene.bounds().max - out.scene.bounds().min;
    out.resolution = std::max(0.05, std::sqrt(size.x() * size.y() / 1e6));
    return out;
}

std::vector<std::filesystem::path> scene_files(const std::filesystem::path& folder)
{
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(
             folder, std::filesystem::directory_options::follow_directory_symlink))
        if (entry.path().string().ends_with("scene.yaml")) files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

/// Compares a 2D raster across the map, and 3D rasters around every hundredth pose.
compare::Tally real_rasters(const TestMap& map, const compare::TwoJudges& judges, const std::vector<Pose>& poses)
{
    compare::Tally tally;
    RasterOptions options{.step = (map.bounds.max - map.bounds.min).head<2>().maxCoeff() / 70.3};
    for (const double offset : {0.05, 0.3}) {
        options.offset = offset;
        tally.add(compare::of_raster(judges, options));
    }
    options.dims = 3;
    options.step = 0.13;
    options.step_z = 0.11;
    for (std::size_t i = 0; i < poses.size(); i += 100) {
        const Vec3& near = poses[i].position;
        options.bounds = {near - Vec3(1, 1, 1), near + Vec3(1, 1, 2)};
        options.height_check = i % 200 == 0;
        tally.add(compare::of_raster(judges, options));
    }
    return tally;
}

}  // namespace

TEST_CASE("every query gives the exhaustive verdicts, pose by pose, in random hard scenes")
{
    compare::CaseTally all;
    for (std::uint64_t seed = 1; seed <= scene_count(); ++seed) {
        const HardCase hard = hard_case(seed);
        const compare::CaseTally tally = compare::of_case(hard);
        all.add(tally);
        INFO("scene " << seed << ", resolution " << hard.resolution << ": " << tally.sum().first
                      << "\nrepeat: spawnfield_fuzz --scenes 1 --seed " << seed);
        CHECK(tally.sum().differences == 0);
    }
    using enum Verdict;
    print("2D rasters", all.raster_2d);
    print("3D rasters", all.raster_3d);
    print("3D rasters without height check", all.collisions);
    print("check", all.check);
    print("sample", all.sample);
    print("search", all.search);
    print("3D rasters with snap", all.snap);
    check_verdicts(all.raster_2d, {Outside, OffTerrain, Submerged, Collision, Valid}, 1000);
    check_verdicts(all.raster_3d, {Outside, OffTerrain, Submerged, Collision, Valid}, 1000);
    check_verdicts(all.collisions, {Collision, Valid}, 10000);
    check_verdicts(all.check, {Outside, Aerial, OffTerrain, Submerged, Collision, Valid}, 500);
    check_verdicts(all.sample, {Valid}, 2000);
    check_verdicts(all.search, {Valid}, 1000);
    check_verdicts(all.snap, {Outside, OffTerrain, Submerged, Collision, Valid}, 1000);
    check_shares(all.raster_2d, 0.2);
    check_shares(all.raster_3d, 0.2);
    check_shares(all.snap, 0.2);
    check_shares(all.collisions, 0.1);
    check_shares(all.check, 0.1);
    if (all_scenes())
        CHECK(all.check.proven_valid > 1000);  // naming the part that a blocked pose hits needs an exact check
}

TEST_CASE("hard scenes contain everything that scenes can contain, and their robots have all kinds of parts")
{
    std::set<std::string> features, kinds;
    std::set<ShapeKind> shapes;
    std::size_t far = 0, sides_up = 0, solid = 0, sheet = 0, filled_open = 0, cropped = 0;
    for (std::uint64_t seed = 1; seed <= 300; ++seed) {
        const HardCase hard = hard_case(seed);
        for (const Part& part : hard.scene.parts) features.insert(part.name.substr(0, part.name.rfind('-')));
        for (const Part& part : hard.scene.parts) kinds.insert(part.kind);
        for (const RobotPart& part : hard.robot.parts) shapes.insert(part.shape.kind);
        for (const Piece& piece : hard.scene.pieces) {
            ++(piece.solid ? solid : sheet);
            sides_up += piece.sides_up;
            filled_open += piece.solid && hard.scene.parts[piece.part].open_edges > 0;
        }
        far += hard.scene.bounds().min.head<2>().norm() > 500;
        cropped += !hard.map_bounds.is_empty();
        CHECK((hard.resolution >= 0.0199 && hard.resolution <= 0.501));
        CHECK((hard.robot.parts.size() >= 1 && hard.robot.parts.size() <= 4));
        CHECK(hard.scene.bounds().min.allFinite());
        CHECK(hard.scene.bounds().max.allFinite());
    }
    const std::vector<std::string> expected = hard_features();
    CHECK(features == std::set<std::string>(expected.begin(), expected.end()));
    for (const char* kind : {"box", "sphere", "cylinder", "capsule", "heightmap", "mesh", "plane", "octomap"})
        CHECK(kinds.contains(kind));
    CHECK(shapes.size() == 5);
    for (const std::size_t count : {far, cropped}) CHECK(count > 20);
    for (const std::size_t count : {sides_up, solid, sheet, filled_open}) CHECK(count > 40);
}

TEST_CASE("the exhaustive answers agree with an independent decision in random hard scenes")
{
    compare::Tally all;
    for (std::uint64_t seed = 1; seed <= scene_count(); ++seed) {
        const compare::Tally tally = compare::independently(hard_case(seed, {.razor = false}));
        all.add(tally);
        INFO("scene " << seed << ": " << tally.first);
        CHECK(tally.differences == 0);
    }
    using enum Verdict;
    check_verdicts(all, {Outside, Aerial, OffTerrain, Submerged, Collision, Valid}, 100);
}

TEST_CASE("with the mask a larger robot never gains a valid pose")
{
    std::size_t kept = 0, lost = 0;
    for (std::uint64_t seed = 1; seed <= scene_count() / 3; ++seed) {
        const HardCase hard = hard_case(seed);
        const TestMap map = compare::map_of_case(hard);
        Robot longer = hard.robot;
        longer.parts.push_back(random_robot(seed + 9).parts[0]);
        const RasterOptions options = dyadic_raster(map, hard);
        const RasterResult small = raster(Judge(map, hard.robot), options);
        for (const Robot& robot : {enlarged(hard.robot, 1.05), enlarged(hard.robot, 1.4), longer}) {
            const Change becomes = change(small.poses, raster(Judge(map, robot), options).poses);
            CAPTURE(seed, hard.resolution);
            CHECK(becomes.gained == 0);
            kept += becomes.valid - becomes.lost;
            lost += becomes.lost;
        }
    }
    if (all_scenes()) CHECK((kept > 5000 && lost > 1000));
}

TEST_CASE("a finer mask changes no verdict, only the number of exact checks")
{
    std::size_t valid = 0;
    std::uint64_t fine_checks = 0, coarse_checks = 0;
    for (std::uint64_t seed = 1; seed <= scene_count() / 3; ++seed) {
        const HardCase hard = hard_case(seed);
        const TestMap coarse = map_at(hard.scene, 3 * hard.resolution, hard.map_bounds);
        RasterOptions options = dyadic_raster(coarse, hard);
        for (const int dims : {2, 3}) {
            options.dims = dims;
            options.step_z = 0.17;
            const RasterResult expected = raster(Judge(coarse, hard.robot), options);
            valid += valid_count(expected.poses);
            coarse_checks += expected.exact_checks;
            for (const double resolution : {1.37 * hard.resolution, std::max(0.02, hard.resolution / 1.5)}) {
                const TestMap fine = map_at(hard.scene, resolution, hard.map_bounds);
                const RasterResult result = raster(Judge(fine, hard.robot), options);
                CAPTURE(seed, hard.resolution, resolution, dims);
                CHECK(csv_of(result) == csv_of(expected));
                if (resolution < hard.resolution) fine_checks += result.exact_checks;
            }
        }
    }
    if (all_scenes()) CHECK(valid > 3000);
    if (all_scenes()) CHECK(fine_checks < coarse_checks);
}

TEST_CASE("with the mask a mirrored scene mirrors the verdicts")
{
    std::size_t valid = 0, other = 0;
    for (std::uint64_t seed = 1; seed <= scene_count() / 3; ++seed) {
        const HardCase hard = hard_case(seed, {.razor = false});
        const TestMap map = map_at(hard.scene, hard.resolution), mirror = map_at(mirrored(hard.scene), hard.resolution);
        RasterOptions options = dyadic_raster(map, hard);
        const RasterResult here = raster(Judge(map, hard.robot), options);
        options.yaw *= -1;
        std::swap(options.bounds.min.y(), options.bounds.max.y());
        options.bounds.min.y() *= -1;
        options.bounds.max.y() *= -1;
        std::vector<RasterPose> there = raster(Judge(mirror, mirrored(hard.robot)), options).poses;
        for (RasterPose& pose : there) pose.y *= -1;
        std::sort(there.begin(), there.end(), earlier);
        CAPTURE(seed, hard.resolution);
        CHECK(same_verdicts(here.poses, there));
        valid += valid_count(here.poses);
        other += here.poses.size() - valid_count(here.poses);
    }
    if (all_scenes()) CHECK((valid > 3000 && other > 3000));
}

TEST_CASE("with the mask a scene moved by whole metres keeps its verdicts")
{
    std::size_t valid = 0, other = 0;
    for (std::uint64_t seed = 1; seed <= scene_count() / 3; ++seed) {
        const HardCase hard = hard_case(seed, {.razor = false});
        const Scene scene = on_binary_lattice(hard.scene);
        const Vec3 by = {double(seed % 7) * 157 - 300, 1000 - double(seed % 5) * 321, double(seed % 3) * 64};
        const TestMap map = map_at(scene, hard.resolution), moved = map_at(shifted(scene, by), hard.resolution);
        RasterOptions options = dyadic_raster(map, hard);
        const RasterResult here = raster(Judge(map, hard.robot), options);
        options.bounds.min += by;
        options.bounds.max += by;
        const RasterResult there = raster(Judge(moved, hard.robot), options);
        CAPTURE(seed, hard.resolution);
        CHECK(same_verdicts(here.poses, there.poses));
        valid += valid_count(here.poses);
        other += here.poses.size() - valid_count(here.poses);
    }
    if (all_scenes()) CHECK((valid > 3000 && other > 3000));
}

TEST_CASE("the mask never proves a pose free if a yaw of the set collides, nor blocked if a yaw is free")
{
    compare::Tally all;
    std::size_t lies = 0, proven_for_all_yaws = 0;
    std::array<std::size_t, 3> proven{};
    for (std::uint64_t seed = 1; seed <= scene_count() / 2; ++seed) {
        const HardCase hard = hard_case(seed);
        const TestMap map = compare::map_of_case(hard);
        const compare::TwoJudges judges(map, hard.robot);
        const CollisionChecker checker = checker_of(map, hard.robot);
        Random random{seed};
        const Bounds crop = compare::crop_near(map, random, 2 * hard.resolution, 15);
        std::vector<Pose> poses;
        for (const Pose& pose : compare::standing_poses(map, hard, crop, 40))
            for (int i = 0; i < 24; ++i) {
                const double yaw = i < 8 ? M_PI / 4 * i : random.between(-M_PI, M_PI);
                poses.push_back({pose.position, rotation_from_rpy(0, 0, yaw)});
            }
        const compare::Tally tally = compare::of_check(judges, poses);
        INFO("scene " << seed << ": " << tally.first);
        CHECK(tally.differences == 0);
        all.add(tally);
        const FreeSpace space(map.solid_bounds, hard.robot);
        std::optional<Proof> every_yaw;
        for (std::size_t i = 0; i < poses.size(); ++i) {
            if (i % 24 == 0) every_yaw = space.proof_at_every_yaw(poses[i].position);
            const Proof proof = space.proof_of(poses[i]);
            if (proof == Proof::Candidate && *every_yaw == Proof::Candidate) continue;
            const Proof truth = checker.is_free(poses[i]) ? Proof::Free : Proof::Blocked;
            lies += (proof != Proof::Candidate && proof != truth) ||
                    (*every_yaw != Proof::Candidate && *every_yaw != truth);
            proven[std::size_t(truth)] += 1;
            proven_for_all_yaws += *every_yaw != Proof::Candidate;
        }
    }
    CHECK(lies == 0);
    check_verdicts(all, {Verdict::Valid, Verdict::Collision}, 5000);
    if (all_scenes())
        CHECK((proven[std::size_t(Proof::Free)] > 2000 && proven[std::size_t(Proof::Blocked)] > 2000 &&
               proven_for_all_yaws > 2000));
}

TEST_CASE("with a mask that is made on first use, rasters are the same bytes with any number of threads")
{
    for (std::uint64_t seed = 1; seed <= scene_count() / 10; ++seed) {
        const HardCase hard = hard_case(seed);
        std::string expected;
        for (const int threads : {1, 2, 8}) {
            const TestMap map = compare::map_of_case(hard);
            const Judge judge(map, hard.robot);
            RasterOptions options = dyadic_raster(map, hard);
            options.bounds = {};
            options.step = std::max(0.1, (map.bounds.max - map.bounds.min).head<2>().maxCoeff() / 60);
            options.threads = threads;
            std::string text;
            for (const int dims : {2, 3}) {
                options.dims = dims;
                options.snap = dims == 3;
                options.step_z = 1.7;
                options.offset = std::clamp(*options.offset, 0.0, judge.options().max_height);
                const RasterResult result = raster(judge, options);
                text += csv_of(result) + std::to_string(result.exact_checks);
            }
            if (threads == 1) expected = text;
            CAPTURE(seed, threads);
            CHECK(text == expected);
        }
    }
}

TEST_CASE("every query gives the exhaustive verdicts in real scenes", "[real][slow]")
{
    const auto folder = shared_scenes();
    if (!folder) return;
    compare::Tally all;
    std::vector<std::filesystem::path> files = scene_files(*folder);
    CHECK(files.size() >= 12);
    const TempFolder city, warehouse, moon;
    files.push_back(scene_of_world(city, *folder / "city/worlds/simple_city.world", *folder / "city/models"));
    files.push_back(
        scene_of_world(warehouse, *folder / "warehouse/worlds/small_warehouse.world", *folder / "warehouse/models"));
    files.push_back(moon.write(
        "scene.yaml",
        "format: spawnfield-scene/1\nname: moon\nparts:\n  - {name: ground, label: terrain, heightmap: {file: " +
            (*folder / "dem/moon_tif/dem_moon.tif").string() + ", size: [77.65, 77.65]}}\n"));
    for (const std::filesystem::path& file : files) {
        const HardCase real = real_case(file);
        const TestMap map = compare::map_of_case(real);
        const compare::TwoJudges judges(map, real.robot);
        const std::vector<Pose> standing = compare::standing_poses(map, real, map.bounds, 300);
        std::vector<Pose> poses = random_poses(real.scene, 5, 200);
        poses.insert(poses.end(), standing.begin(), standing.end());
        compare::Tally tally = compare::of_check(judges, poses);
        tally.add(real_rasters(map, judges, poses));
        SampleOptions sampling{.count = 100, .min_distance = 0.5, .random_yaw = true, .stance = Stance::Level};
        tally.add(compare::of_sample(judges, sampling));
        INFO(file.string() << ": " << tally.first);
        CHECK(tally.differences == 0);
        CHECK(tally.poses > 5000);
        all.add(tally);
    }
    print("real scenes", all);
    check_verdicts(all, {Verdict::OffTerrain, Verdict::Collision, Verdict::Valid}, 1000);
    check_shares(all, 0.2);
}
