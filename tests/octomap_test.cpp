#include "catch.h"
#include "compare.h"
#include "program.h"
#include "scene/octomap_file.h"
#include "scene/octomap_space.h"
#include "shared_scenes.h"
#include "slow.h"
#include "test_map.h"

#include <spawnfield/error.h>
#include <spawnfield/query.h>
#include <spawnfield/scene_parts.h>

#include <octomap/ColorOcTree.h>
#include <octomap/OcTree.h>
#include <octomap/OcTreeStamped.h>

#include <random>
#include <sstream>

using namespace spawnfield;
using Catch::Contains;

namespace {

/// Returns a tree with voxels of 0.25 m: a floor over x and y of -2 .. 2 with its top at z = 0, and free space up to z
/// = 2 where x < 0. The other half is unknown, except for a free column at its far corner.
template <class Tree>
Tree half_seen()
{
    Tree tree(0.25);
    const auto set = [&](double x, double y, double z, bool occupied) {
        tree.updateNode(octomap::point3d(float(x), float(y), float(z)), occupied);
    };
    for (int i = 0; i < 16; ++i)
        for (int j = 0; j < 16; ++j) {
            const double x = -1.875 + 0.25 * i, y = -1.875 + 0.25 * j;
            set(x, y, -0.125, true);
            for (int k = 0; k < 8; ++k)
                if (x < 0 || (i == 15 && j == 15)) set(x, y, 0.125 + 0.25 * k, false);
        }
    tree.toMaxLikelihood();
    tree.prune();
    return tree;
}

template <class Tree>
std::string bytes_of_tree(Tree tree, bool full)
{
    std::ostringstream out;
    if (full)
        tree.write(out);
    else
        tree.writeBinary(out);
    return out.str();
}

std::string half_seen_bytes(bool full = false) { return bytes_of_tree(half_seen<octomap::OcTree>(), full); }

octomap::OcTree random_tree(unsigned seed)
{
    octomap::OcTree tree(0.1);
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> place(-1.5f, 1.5f);
    for (int k = 0; k < 400; ++k) {
        const octomap::point3d centre{place(random), place(random), place(random)};
        const bool occupied = random() % 3 == 0;
        const int side = 1 << random() % 4;
        for (int cell = 0; cell < side * side * side; ++cell) {
            const octomap::point3d step(0.1f * float(cell % side), 0.1f * float(cell / side % side),
                                        0.1f * float(cell / side / side));
            tree.updateNode(centre + step, occupied);
        }
    }
    tree.toMaxLikelihood();
    tree.prune();
    return tree;
}

Scene load(const TempFolder& folder, const std::string& more)
{
    folder.write("scan.bt", half_seen_bytes());
    return load_scene(folder.write(
        "scene.yaml",
        "format: spawnfield-scene/1\nparts:\n  - {name: scan, label: terrain, octomap: scan.bt" + more + "}\n"));
}

double volume_of(const Scene& scene, std::uint32_t part)
{
    double sum = 0;
    for (const Primitive& primitive : scene.primitives)
        if (primitive.part == part) sum += primitive.shape.size.prod();
    return sum;
}

}  // namespace

TEST_CASE("unknown boxes fill exactly the unknown space in the extent of the tree, once")
{
    const unsigned seed = GENERATE(range(1u, 6u));
    const octomap::OcTree tree = random_tree(seed);
    const VoxelBox extent = known_extent(tree);
    const std::vector<VoxelBox> boxes = unknown_boxes(tree, extent);
    double sum = 0;
    for (const VoxelBox& box : boxes) {
        CHECK(box.volume() > 0);
        sum += box.volume();
    }
    CHECK(sum == extent.volume() - known_volume(tree));  // together with the check below: no boxes overlap
    double x = 0, y = 0, z = 0;
    auto& changeable = const_cast<octomap::OcTree&>(tree);
    changeable.getMetricMin(x, y, z);
    const Bounds bounds = bounds_of(tree, extent);
    CHECK((bounds.min - Vec3(x, y, z)).norm() < 1e-9);
    changeable.getMetricMax(x, y, z);
    CHECK((bounds.max - Vec3(x, y, z)).norm() < 1e-9);
    for (std::uint32_t i = extent.lo[0]; i < extent.hi[0]; ++i)
        for (std::uint32_t j = extent.lo[1]; j < extent.hi[1]; ++j)
            for (std::uint32_t k = extent.lo[2]; k < extent.hi[2]; k += 3) {
                const auto holds = [&](const VoxelBox& box) {
                    return box.lo[0] <= i && i < box.hi[0] && box.lo[1] <= j && j < box.hi[1] && box.lo[2] <= k &&
                           k < box.hi[2];
                };
                const octomap::OcTreeKey key{octomap::key_type(i), octomap::key_type(j), octomap::key_type(k)};
                if ((std::count_if(boxes.begin(), boxes.end(), holds) == 1) != (tree.search(key) == nullptr))
                    FAIL("voxel " << i << " " << j << " " << k);
            }
}

TEST_CASE("unknown space needs few boxes: here a half with one free column")
{
    const octomap::OcTree tree = half_seen<octomap::OcTree>();
    CHECK(unknown_boxes(tree, known_extent(tree)).size() <= 8);
}

TEST_CASE("unknown space is free unless the scene or the caller makes it blocked, and a notice states its volume")
{
    const TempFolder folder;
    const std::string words = (folder / "scan.bt").string() + ": 15.875 m3 of its 36 m3 are unknown (44.1 %) and ";
    const Scene open = load(folder, "");
    CHECK(open.parts.size() == 1);
    REQUIRE(open.notices.size() == 1);
    CHECK(open.notices[0] == words + "are treated as free (--unknown blocked makes them solid)");
    const Scene blocked = load(folder, ", unknown: blocked");
    REQUIRE(blocked.parts.size() == 2);
    CHECK(blocked.parts[1].name == "scan:unknown");
    CHECK(blocked.parts[1].label == Label::Obstacle);
    CHECK(volume_of(blocked, 0) == Approx(4));
    CHECK(volume_of(blocked, 1) == Approx(15.875));
    CHECK(blocked.notices == std::vector<std::string>{words + "are treated as solid"});
    const auto file = folder.write("bare.bt", half_seen_bytes());
    CHECK(load_scene(file, {.unknown = Unknown::Blocked}).parts.size() == 2);
    CHECK(load_scene(folder / "scene.yaml", {.unknown = Unknown::Free}).parts.size() == 1);
    CHECK_THROWS_WITH(load(folder, ", unknown: solid"),
                      (folder / "scene.yaml").string() +
                          ": part \"scan\": unknown is \"solid\", needs one of free, blocked (line 3)");
}

TEST_CASE("a part must not have the name of unknown space, and unknown without an OctoMap gets a notice")
{
    const TempFolder folder;
    folder.write("scan.bt", half_seen_bytes());
    const std::string head = "format: spawnfield-scene/1\nparts:\n",
                      box = "  - {name: 'scan:unknown', label: terrain, box: [1, 1, 1]}\n",
                      scan = "  - {name: scan, octomap: scan.bt, unknown: blocked}\n";
    CHECK_THROWS_WITH(load_scene(folder.write("a.yaml", head + box + scan)),
                      Contains("is already used; rename one of the parts"));
    CHECK_THROWS_WITH(load_scene(folder.write("a.yaml", head + scan + box)),
                      Contains("is also the name of an earlier part"));
    const Scene plain = load_scene(folder.write("a.yaml", head + box), {.unknown = Unknown::Blocked});
    REQUIRE(plain.notices.size() == 1);
    CHECK(plain.notices[0] == (folder / "a.yaml").string() + ": has no OctoMap, so --unknown has no effect");
    CHECK_THROWS_WITH(load_scene(folder.write("a.yaml", head + "  - {name: a, box: [1, 1, 1], unknown: free}\n")),
                      Contains("unknown is not a known key"));
}

TEST_CASE("a robot that is partly in unknown space collides if that is blocked")
{
    const TempFolder folder;
    const Robot robot = load_robot("box:0.4,0.4,0.4");
    const std::vector<Pose> poses = {
        {{-1, 0, 0.1}, Mat3::Identity()},     // completely in free space
        {{-0.1, 0, 0.1}, Mat3::Identity()},   // half of it beyond x = 0
        {{-0.21, 0, 0.1}, Mat3::Identity()},  // 1 cm before unknown space
        {{1, 1, 0.5}, Mat3::Identity()},      // in unknown space
        {{-1, 0, 1.9}, Mat3::Identity()}};    // reaches beyond the top, where nothing is blocked
    const auto verdicts = [&](const std::string& more) {
        const TestMap map = map_of(load(folder, more));
        return Judge(map, robot, {.max_height = 5}).check(poses);
    };
    for (const Judgement& judged : verdicts("")) CHECK(judged.verdict == Verdict::Valid);
    const auto blocked = verdicts(", unknown: blocked");
    const std::vector<Verdict> wanted = {Verdict::Valid, Verdict::Collision, Verdict::Valid, Verdict::Collision,
                                         Verdict::Valid};
    for (std::size_t k = 0; k < poses.size(); ++k) {
        INFO(k);
        CHECK(blocked[k].verdict == wanted[k]);
    }
    REQUIRE(blocked[1].hit);
    CHECK(blocked[1].hit->part == 1);
    // Above unknown space the ground is unknown space, which is not terrain.
    const TestMap map = map_of(load(folder, ", unknown: blocked"));
    const Judge judge(map, robot);
    CHECK(judge.check({{1, 1, 2.1}, Mat3::Identity()}).verdict == Verdict::OffTerrain);
}

TEST_CASE("with unknown space blocked the mask and the independent decision still agree")
{
    const TempFolder folder;
    folder.write("scan.bt", bytes_of_tree(random_tree(GENERATE(11u, 12u)), false));
    const auto file = folder.write(
        "scene.yaml",
        "format: spawnfield-scene/1\nparts:\n  - {name: scan, label: terrain, octomap: scan.bt, unknown: blocked, "
        "xyz: [3, 1, 0], rpy: [0, 0, 0.3]}\n");
    const TestMap map = map_of(load_scene(file), 0.05);
    const Robot robot = load_robot("box:0.12,0.08,0.1");
    const RasterOptions options{.step = 0.07, .offset = 0.03, .yaw = 0.2};
    const compare::Tally tally = compare::of_raster({map, robot}, options);
    INFO(tally.first);
    CHECK(tally.differences == 0);
    CHECK(tally.verdicts[Verdict::Collision] > 100);
    CHECK(tally.verdicts[Verdict::Valid] > 10);
    const std::vector<Pose> poses = random_poses(map.scene, 5, 400);
    const auto fast = Judge(map, robot).check(poses);
    std::size_t decided = 0;
    for (std::size_t k = 0; k < poses.size(); ++k) {
        const slow::Decision slow = slow::decide(map.scene, map.bounds, robot, poses[k], 1.0, 1e9);
        if (!slow.verdict) continue;
        ++decided;
        CHECK(*slow.verdict == fast[k].verdict);
    }
    CHECK(decided > 200);
}

TEST_CASE("an OctoMap is the same world as a box for each of its occupied leaves")
{
    const TempFolder folder;
    VerdictCounts counts;
    std::size_t settled = 0, different = 0;
    for (unsigned seed = 1; seed <= 4; ++seed) {
        CAPTURE(seed);
        const octomap::OcTree tree = random_tree(seed);
        const Scene scene = load_scene(folder.write("a.bt", bytes_of_tree(tree, false)));
        Scene leaves;
        for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf)
            if (tree.isNodeOccupied(*leaf))
                add_shape(leaves, "leaf" + std::to_string(leaves.parts.size()), Label::Terrain,
                          box_shape(Vec3::Constant(leaf.getSize()), {{leaf.getX(), leaf.getY(), leaf.getZ()}}));
        CHECK(scene.primitives.size() < leaves.primitives.size());
        const Bounds bounds = leaves.bounds();
        const TestMap joined = map_of(scene, 0.1, bounds), apart = map_of(leaves, 0.1, bounds);
        for (const char* const text : {"box:0.9,0.6,0.4", "box:0.3,0.2,0.2"})
            for (const Stance stance : {Stance::Level, Stance::Settled}) {
                const Robot robot = load_robot(text);
                CAPTURE(robot.name, int(stance));
                const RasterOptions options{.step = 0.37, .stance = stance, .yaw = 0.4};
                const RasterResult ours = raster(Judge(joined, robot), options),
                                   theirs = raster(Judge(apart, robot), options);
                REQUIRE(ours.poses.size() == theirs.poses.size());
                for (std::size_t i = 0; i < ours.poses.size(); ++i) {
                    const RasterPose &a = ours.poses[i], &b = theirs.poses[i];
                    CAPTURE(a.x, a.y, a.z);
                    CHECK((a.x == b.x && a.y == b.y && a.layer == b.layer));
                    if (stance == Stance::Level) CHECK(to_string(a.verdict) == to_string(b.verdict));
                    settled += stance == Stance::Settled;
                    different += a.verdict != b.verdict;
                }
                counts += ours.counts;
            }
    }
    // A wall of one box stops a robot that turns against it. A stack of boxes may not: the robot may rest on one that
    // is below another.
    CHECK(settled > 1000);
    CHECK(double(different) < 0.01 * double(settled));
    for (const Verdict verdict : {Verdict::Valid, Verdict::Collision, Verdict::Unstable}) CHECK(counts[verdict] > 20);
}

TEST_CASE("OctoMaps with colours or times have the same contents as plain ones")
{
    const TempFolder folder;
    auto coloured = half_seen<octomap::ColorOcTree>();
    for (auto leaf = coloured.begin_leafs(); leaf != coloured.end_leafs(); ++leaf) leaf->setColor(1, 2, 3);
    const auto boxes = [&](const std::string& name, const std::string& bytes) {
        std::vector<std::array<double, 6>> out;
        for (const Primitive& primitive :
             load_scene(folder.write(name, bytes), {.unknown = Unknown::Blocked}).primitives) {
            const Vec3 &at = primitive.shape.pose.position, &size = primitive.shape.size;
            out.push_back({at.x(), at.y(), at.z(), size.x(), size.y(), size.z()});
        }
        return out;
    };
    const auto wanted = boxes("a.bt", half_seen_bytes());
    REQUIRE(wanted.size() > 5);
    std::ostringstream full, binary;
    coloured.write(full);
    coloured.writeBinaryConst(binary);
    CHECK_THAT(full.str(), Contains("id ColorOcTree"));
    CHECK_THAT(binary.str(), Contains("id ColorOcTree"));
    CHECK(boxes("a.ot", half_seen_bytes(true)) == wanted);
    CHECK(boxes("colour.ot", full.str()) == wanted);
    CHECK(boxes("colour.bt", binary.str()) == wanted);
    CHECK(boxes("stamped.ot", bytes_of_tree(half_seen<octomap::OcTreeStamped>(), true)) == wanted);
}

TEST_CASE("an OctoMap that is cut short or of another type is refused by name, at every byte")
{
    const TempFolder folder;
    octomap::ColorOcTree small(0.5);
    small.updateNode(octomap::point3d(0.25f, 0.25f, 0.25f), true);
    small.updateNode(octomap::point3d(2.25f, 0.25f, 0.25f), false);
    std::ostringstream out;
    small.write(out);
    const std::string whole = out.str();
    REQUIRE(load_scene(folder.write("a.ot", whole)).primitives.size() == 1);
    for (std::size_t length = 0; length < whole.size(); ++length)
        CHECK_THROWS_AS(load_scene(folder.write("a.ot", whole.substr(0, length))), FileError);

    std::string counting = half_seen_bytes(true);
    counting.replace(counting.find("id OcTree"), 9, "id CountingOcTree");
    const auto file = folder.write("b.ot", counting);
    CHECK_THROWS_WITH(
        load_scene(file),
        file.string() + ": is an OctoMap of type CountingOcTree, needs OcTree, ColorOcTree or OcTreeStamped");
    std::string odd = half_seen_bytes();
    odd.replace(odd.find("id OcTree"), 9, "id FooTree");
    const auto binary = folder.write("b.bt", odd);
    CHECK_THROWS_WITH(load_scene(binary),
                      binary.string() + ": is an OctoMap of type FooTree, needs OcTree, ColorOcTree or OcTreeStamped");
}

TEST_CASE("bake --unknown blocked puts unknown space into the map")
{
    const TempFolder folder;
    folder.write("scan.bt", half_seen_bytes());
    const ProgramRun open = run_program(folder, "bake scan.bt -o open"),
                     blocked = run_program(folder, "bake scan.bt -o blocked --unknown blocked");
    REQUIRE(open.status == 0);
    REQUIRE(blocked.status == 0);
    CHECK_THAT(open.err,
               Contains("notice: scan.bt: 15.875 m3 of its 36 m3 are unknown (44.1 %) and are treated as free"));
    CHECK_THAT(blocked.err, Contains("(44.1 %) and are treated as solid"));
    folder.write("poses.csv", "x,y,z\n-1,0,0.1\n1,1,0.1\n");
    CHECK_THAT(run_program(folder, "check open --robot box:0.4,0.4,0.4 --poses poses.csv").out,
               Contains("1,1,0.1,valid"));
    const std::string verdicts = run_program(folder, "check blocked --robot box:0.4,0.4,0.4 --poses poses.csv").out;
    CHECK_THAT(verdicts, Contains("-1,0,0.1,valid") && Contains("scan:unknown"));
    CHECK(run_program(folder, "bake scan.bt -o other --unknown solid").status == 2);
}

TEST_CASE("the unknown space of the corridor is a reasonable number of boxes", "[real]")
{
    const auto shared = shared_scenes();
    if (!shared) return;
    const auto tree = read_octomap(*shared / "octomap/geb079.bt");
    const VoxelBox extent = known_extent(*tree);
    const std::vector<VoxelBox> boxes = unknown_boxes(*tree, extent);
    double sum = 0;
    for (const VoxelBox& box : boxes) sum += box.volume();
    CHECK(sum == extent.volume() - known_volume(*tree));
    CHECK(boxes.size() < 100000);
    CHECK(boxes.size() > 1000);
}
