#include "arena.h"
#include "review/pack.h"
#include "review/reason_table.h"
#include "review_pack.h"
#include "test_map.h"

#include <spawnfield/frames.h>
#include <spawnfield/review.h>
#include <spawnfield/scene_parts.h>

#include <meshoptimizer.h>

#include <map>
#include <random>

using namespace spawnfield;
using nlohmann::json;

namespace {

/// A layer of a page, read back.
struct PageLayer {
    std::vector<Pose> poses;
    std::vector<std::int64_t> verdicts, hits, grounds;
    std::vector<std::string> reasons;
    std::vector<std::vector<double>> quantities;
};

std::vector<std::string> reasons_in(const ReviewPack& pack, const json& layer)
{
    const std::string numbers = pack.text(layer.at("reason_numbers"));
    std::size_t at = 0;
    std::vector<std::string> out;
    for (const std::int64_t index : pack.integers(layer.at("reason"))) {
        const std::string text = layer.at("reasons").at(std::size_t(index));
        std::string& reason = out.emplace_back();
        for (const char c : text) {
            if (c != '\1') {
                reason += c;
                continue;
            }
            const std::size_t end = numbers.find('\n', at);
            reason += numbers.substr(at, end - at);
            at = end + 1;
        }
    }
    CHECK(at == numbers.size());
    return out;
}

PageLayer layer_in(const ReviewPack& pack, const json& layer)
{
    PageLayer out;
    const json& grid = layer.at("grid");
    const std::int64_t cols = grid.at("cols");
    const double x0 = grid.at("x0"), y0 = grid.at("y0"), step = grid.at("step"), z0 = layer.at("z0"),
                 unit = layer.at("z_unit"), yaw = layer.at("yaw");
    const std::vector<std::int64_t> cells = pack.integers(layer.at("cell")), heights = pack.integers(layer.at("z"));
    for (std::size_t i = 0; i < cells.size(); ++i)
        out.poses.push_back({Vec3(x0 + double(cells[i] % cols) * step, y0 + double(cells[i] / cols) * step,
                                  z0 + unit * double(heights[i])),
                             rotation_from_rpy(0, 0, yaw)});
    out.verdicts = pack.integers(layer.at("verdict"));
    out.hits = pack.integers(layer.at("hit"));
    out.grounds = pack.integers(layer.at("ground"));
    out.reasons = reasons_in(pack, layer);
    for (const json& quantity : layer.at("quantities")) {
        std::vector<double>& values = out.quantities.emplace_back();
        for (const std::int64_t value : pack.integers(quantity.at("values")))
            values.push_back(value == 65535
                                 ? std::numeric_limits<double>::quiet_NaN()
                                 : double(quantity.at("offset")) + double(quantity.at("scale")) * double(value));
    }
    return out;
}

ReviewContents contents_of(const Judge& judge, Stance stance, double step, double yaw = 0.3)
{
    ReviewContents out{.stance = stance};
    out.rasters = {raster(judge, {.step = step, .stance = stance, .yaw = yaw})};
    return out;
}

std::size_t count_of(const json& counts)
{
    std::size_t sum = 0;
    for (const json& count : counts) sum += count.get<std::size_t>();
    return sum;
}

}  // namespace

TEST_CASE("a page has the verdict, the reason and the part of check for each of its poses")
{
    for (const std::uint64_t seed : {1u, 2u, 3u, 4u, 5u, 6u})
        for (const Stance stance : {Stance::Level, Stance::Settled}) {
            CAPTURE(seed, int(stance));
            const Judge judge(map_of(random_scene(seed)), random_robot(seed));
            const ReviewPack pack(review_pack(judge, contents_of(judge, stance, 0.6)));
            const json& layer = pack.head.at("layers").at(0);
            const PageLayer page = layer_in(pack, layer);
            REQUIRE(page.poses.size() > 300);
            REQUIRE(page.poses.size() == layer.at("count"));
            CHECK(count_of(layer.at("counts")) == page.poses.size());
            const std::vector<Judgement> judgements = judge.check(page.poses);
            const std::vector<SettledPose> settled = judge.settle(page.poses);
            const std::size_t parts = judge.map().geometry.parts().size();
            for (std::size_t i = 0; i < page.poses.size(); ++i) {
                const Judgement wanted = stance == Stance::Settled ? judgement_of(settled[i]) : judgements[i];
                const std::string reason = stance == Stance::Settled ? judge.describe(settled[i])
                                                                     : judge.describe(page.poses[i], wanted);
                REQUIRE(page.verdicts[i] == int(wanted.verdict));
                REQUIRE(page.reasons[i] == (wanted.verdict == Verdict::Valid ? "" : reason));
                REQUIRE(page.hits[i] == (wanted.hit ? 1 + std::int64_t(wanted.hit->part) : 0));
                REQUIRE(page.hits[i] <= std::int64_t(parts));
                const double ground = double(layer.at("z0")) + double(layer.at("z_unit")) * double(page.grounds[i]);
                if (wanted.ground)
                    REQUIRE(ground == Approx(wanted.ground->height).margin(1e-6));
                else
                    REQUIRE(page.grounds[i] == std::numeric_limits<std::int32_t>::min());
            }
        }
}

TEST_CASE("an update has the verdicts of the page")
{
    std::size_t compared = 0, aerial = 0;
    for (std::uint64_t seed = 1; seed <= 12; ++seed)
        for (const Stance stance : {Stance::Level, Stance::Settled}) {
            CAPTURE(seed, int(stance));
            const Judge judge(map_of(random_scene(seed)), random_robot(seed), {.max_height = seed % 2 ? 1.0 : 0.3});
            ReviewContents contents = contents_of(judge, stance, 0.6);
            if (stance == Stance::Level)
                contents.rasters = {raster(judge, {.step = 0.6, .offset = seed % 3 ? 0.1 : 0.5, .yaw = 0.3})};
            const auto verdicts = [&] {
                const ReviewPack pack(review_pack(judge, contents));
                const json& layer = pack.head.at("layers").at(0);
                const std::vector<std::int64_t> cells = pack.integers(layer.at("cell")),
                                                heights = pack.integers(layer.at("z")),
                                                values = pack.integers(layer.at("verdict"));
                std::map<std::pair<std::int64_t, std::int64_t>, std::int64_t> out;
                for (std::size_t i = 0; i < cells.size(); ++i) out[{cells[i], heights[i]}] = values[i];
                return out;
            };
            const auto page = verdicts();
            contents.is_update = true;
            const auto update = verdicts();
            CHECK(update == page);
            compared += update.size();
            for (const auto& [place, verdict] : update) aerial += verdict == int(Verdict::Aerial);
        }
    CHECK(compared > 3000);
    CHECK(aerial > 100);
}

TEST_CASE("a page has each place of a raster once, with the raster's verdict")
{
    for (const std::uint64_t seed : {2u, 4u, 7u}) {
        const Judge judge(map_of(random_scene(seed)), husky());
        const ReviewContents contents = contents_of(judge, Stance::Settled, 0.5);
        const RasterResult& raster = contents.rasters[0];
        const ReviewPack pack(review_pack(judge, contents));
        const json& counts = pack.head.at("layers").at(0).at("counts");
        // Poses that settle on a higher layer are left out; they are collisions.
        CHECK(counts.at(std::size_t(Verdict::Valid)) == raster.counts[Verdict::Valid]);
        CHECK(counts.at(std::size_t(Verdict::Collision)) <= raster.counts[Verdict::Collision]);
        CHECK(counts.at(std::size_t(Verdict::Steep)) == raster.counts[Verdict::Steep]);
    }
}

TEST_CASE("tilt, margin and clearance of a page are those of the poses, to a 65534th of their range")
{
    const Judge judge(map_of(random_scene(5)), husky());
    ReviewContents contents = contents_of(judge, Stance::Settled, 0.5);
    contents.quantities = {PlaceQuantity::Clearance};
    const ReviewPack pack(review_pack(judge, contents));
    const json& layer = pack.head.at("layers").at(0);
    const PageLayer page = layer_in(pack, layer);
    REQUIRE(page.quantities.size() == 3);
    CHECK(layer.at("quantities").at(0).at("name") == "tilt");
    CHECK(layer.at("quantities").at(1).at("name") == "margin");
    CHECK(layer.at("quantities").at(2).at("name") == "clearance");
    const std::vector<std::int64_t> roll = pack.integers(layer.at("roll"));
    const std::vector<SettledPose> settled = judge.settle(page.poses);
    std::size_t measured = 0;
    for (std::size_t i = 0; i < page.poses.size(); ++i) {
        CHECK(std::isnan(page.quantities[0][i]) == !settled[i].has_pose);
        CHECK(std::isnan(page.quantities[2][i]) == (settled[i].verdict != Verdict::Valid));
        measured += settled[i].verdict == Verdict::Valid;
        if (!settled[i].has_pose) continue;
        CHECK(page.quantities[0][i] == Approx(settled[i].tilt).margin(1e-4));
        CHECK(page.quantities[1][i] == Approx(settled[i].margin).margin(1e-4));
        CHECK(double(roll[i]) * std::numbers::pi / 32767 == Approx(settled[i].roll).margin(1e-4));
    }
    CHECK(measured > 50);
}

TEST_CASE("a page is the same for any number of threads")
{
    const Judge judge(map_of(random_scene(9)), husky());
    ReviewContents contents = contents_of(judge, Stance::Settled, 0.4);
    contents.graph = ReachGraph(judge);
    contents.quantities = {PlaceQuantity::Clearance, PlaceQuantity::View};
    contents.most_triangles = 500;
    const std::string one = review_pack(judge, contents, {.threads = 1});
    CHECK(one == review_pack(judge, contents, {.threads = 2}));
    CHECK(one == review_pack(judge, contents, {.threads = 8}));
}

TEST_CASE("the world of a page has all triangles, and their parts, near where they are")
{
    Scene scene;
    scene.name = "two boxes";
    add_shape(scene, "floor", Label::Terrain, box_shape({10, 10, 1}));
    add_shape(scene, "crate", Label::Obstacle, box_shape({1, 1, 1}, {Vec3(2, 1, 1)}));
    const Judge judge(map_of(scene), husky());
    const ReviewPack pack(review_pack(judge, {}));
    const json& world = pack.head.at("world");
    CHECK(world.at("triangles") == 24);
    CHECK(world.at("share") == 1);
    REQUIRE(world.at("meshes").size() == 2);
    const json& mesh = world.at("meshes").at(1);
    CHECK(mesh.at("label") == "obstacle");
    CHECK(mesh.at("parts") == json::array({json::array({1, 0})}));
    CHECK(pack.head.at("parts").at(1).at("name") == "crate");
    const std::size_t count = mesh.at("positions").at("count"), indices = mesh.at("indices").at("count");
    REQUIRE(indices == 36);
    // The blocks' own sizes are not known to the reader; zlib's streams say where they end.
    const auto decoded = [&](const json& array) {
        for (std::size_t size = 1; size < 4096; ++size) try {
                return pack.bytes(array, size);
            } catch (const std::runtime_error&) {
            }
        throw std::runtime_error("no size fits");
    };
    const std::string corners = decoded(mesh.at("positions"));
    std::vector<std::array<std::uint16_t, 4>> points(count);
    REQUIRE(meshopt_decodeVertexBuffer(points.data(), count, 8, reinterpret_cast<const unsigned char*>(corners.data()),
                                       corners.size()) == 0);
    Bounds bounds;
    for (const auto& point : points) {
        Vec3 corner;
        for (int axis = 0; axis < 3; ++axis)
            corner[axis] = double(pack.head.at("origin").at(std::size_t(axis))) +
                           double(mesh.at("offset").at(std::size_t(axis))) +
                           double(mesh.at("scale")) * point[std::size_t(axis)];
        bounds.extend(corner);
    }
    CHECK((bounds.min - Vec3(1.5, 0.5, 0.5)).norm() < 1e-4);
    CHECK((bounds.max - Vec3(2.5, 1.5, 1.5)).norm() < 1e-4);
}

TEST_CASE("a large world is simplified, its parts remain, and verdicts do not change")
{
    const Judge judge(map_of(random_scene(3)), husky());
    ReviewContents contents = contents_of(judge, Stance::Level, 1);
    const ReviewPack whole(review_pack(judge, contents));
    contents.most_triangles = 200;
    const ReviewPack simple(review_pack(judge, contents));
    const double share = simple.head.at("world").at("share");
    CHECK(share < 0.9);
    CHECK(simple.head.at("world").at("triangles") == whole.head.at("world").at("triangles"));
    for (std::size_t m = 0; m < whole.head.at("world").at("meshes").size(); ++m)
        CHECK(simple.head.at("world").at("meshes").at(m).at("parts").size() ==
              whole.head.at("world").at("meshes").at(m).at("parts").size());
    const auto verdicts = [](const ReviewPack& pack) {
        return pack.integers(pack.head.at("layers").at(0).at("verdict"));
    };
    CHECK(verdicts(simple) == verdicts(whole));
}

TEST_CASE("poses of a file and pairs have their verdicts, reasons, rests and paths")
{
    const Judge judge(training_map(), husky());
    ReviewContents contents;
    contents.spawns = {{"some.csv", parse_poses("name,x,y,z,yaw\ngood,0,0,0.5,0\nbad,1.67,-3.01,0.5,0\n", "some.csv")}};
    ReachOptions reach;
    reach.keep_ways = true;
    contents.graph = ReachGraph(judge, reach);
    contents.pairs = {{"pairs.csv", parse_pairs("start_x,start_y,start_z,goal_x,goal_y,goal_z\n0,0,0.5,-3,0,0.5\n"
                                                "0,0,0.5,1.67,-3.01,0.5\n",
                                                "pairs.csv")}};
    const ReviewPack pack(review_pack(judge, contents));
    const json& spawns = pack.head.at("spawns").at(0);
    const std::vector<SettledPose> settled = judge.settle(contents.spawns[0].table.poses);
    CHECK(spawns.at("file") == "some.csv");
    CHECK(spawns.at("columns") == json({"name", "x", "y", "z", "yaw"}));
    CHECK(spawns.at("rows").at(1).at(0) == "bad");
    for (std::size_t i = 0; i < 2; ++i) {
        CHECK(spawns.at("verdicts").at(i) == int(settled[i].verdict));
        if (settled[i].has_pose) CHECK(spawns.at("poses").at(i).at(2) == settled[i].lifted(0.02).position.z());
        if (settled[i].has_pose) CHECK(spawns.at("contacts").at(i).size() == settled[i].contacts.size());
    }
    REQUIRE(settled[0].verdict == Verdict::Valid);
    REQUIRE(settled[1].verdict != Verdict::Valid);
    CHECK(spawns.at("reasons").at(0) == "");
    CHECK(spawns.at("reasons").at(1) == judge.describe(settled[1]));
    CHECK(spawns.at("clearance").at(1).is_null());
    CHECK(spawns.at("clearance").at(0).is_number());
    const json& pairs = pack.head.at("pairs").at(0).at("pairs");
    CHECK(pairs.at(0).at("verdict") == "valid");
    CHECK(pairs.at(0).at("path").size() >= 2);
    CHECK(pairs.at(1).at("pair_verdict") == "goal_not_valid");
    CHECK(pairs.at(1).at("verdict") == to_string(settled[1].verdict));
    CHECK(pairs.at(1).at("path").empty());
    CHECK(pairs.at(1).at("reason") != "");
}

TEST_CASE("any text of a scene remains text in a pack")
{
    Scene scene;
    scene.name = "</script><b>\"\xff\x01";
    add_shape(scene, "</script>\n<img src=x onerror=alert(1)> 12", Label::Terrain, box_shape({10, 10, 1}));
    const Judge judge(map_of(scene), husky());
    const ReviewPack pack(review_pack(judge, contents_of(judge, Stance::Level, 1)));
    CHECK(pack.head.at("parts").at(0).at("name") == "</script>\n<img src=x onerror=alert(1)> 12");
    CHECK(pack.head.at("map").at("name") == "</script><b>\"\xEF\xBF\xBD\x01");
}

TEST_CASE("reasons keep their numbers, however they are written")
{
    ReasonTable table;
    const std::vector<std::string> reasons{"",
                                           "it tilts by 31.25 degrees, the limit is 30 degrees",
                                           "it tilts by 7 degrees, the limit is 30 degrees",
                                           "",
                                           "crate_007: 1e-07 m, -3.5e+12 m, 2.",
                                           "1.2.3",
                                           "no numbers"};
    for (const std::string& reason : reasons) table.add(reason);
    CHECK(table.texts().size() == 5);
    CHECK(table.texts()[1] == "it tilts by \1 degrees, the limit is \1 degrees");
    CHECK(table.indices() == std::vector<std::uint16_t>{0, 1, 1, 0, 2, 3, 4});
    CHECK(table.numbers() == "31.25\n30\n7\n30\n007\n1e-07\n3.5e+12\n2\n1.2\n3\n");
}

TEST_CASE("integers of a pack read back, also the largest")
{
    PackWriter writer;
    const std::vector<std::int32_t> values{0, -1, 2147483647, -2147483647 - 1, 5, 5};
    const std::vector<std::uint8_t> bytes{255, 0, 1, 128};
    const std::vector<std::uint32_t> words{4294967295u, 0, 1};
    const Json head{{"a", writer.delta(std::span<const std::int32_t>(values))},
                    {"b", writer.delta(std::span<const std::uint8_t>(bytes))},
                    {"c", writer.delta(std::span<const std::uint32_t>(words))}};
    const ReviewPack pack(writer.finish(head));
    CHECK(pack.integers(pack.head.at("a")) == std::vector<std::int64_t>(values.begin(), values.end()));
    CHECK(pack.integers(pack.head.at("b")) == std::vector<std::int64_t>(bytes.begin(), bytes.end()));
    CHECK(pack.integers(pack.head.at("c")) == std::vector<std::int64_t>(words.begin(), words.end()));
}

TEST_CASE("a page that cannot be made says why")
{
    const Judge judge(training_map(), husky());
    ReviewContents contents;
    contents.rasters = {raster(judge, {.dims = 3, .step = 4})};
    CHECK_THROWS_WITH(review_pack(judge, contents),
                      Contains("a raster has three dimensions or several headings, needs two and one"));
    contents.rasters.clear();
    contents.pairs = {{"pairs.csv", {}}};
    CHECK_THROWS_WITH(review_pack(judge, contents), Contains("pairs need a graph"));
    contents.pairs.clear();
    contents.most_triangles = 0;
    CHECK_THROWS_WITH(review_pack(judge, contents), Contains("most_triangles is 0, needs at least 1"));
}

TEST_CASE("review writes a page, or says that this program has none")
{
    const Arena arena;
    const std::string command = "review map" + husky_option;
    const ProgramRun run = arena(command + "-o page.html --raster 1");
    if (!has_review_page()) {
        CHECK(run.status == 1);
        CHECK(run.err ==
              "spawnfield: this program was built without the review page; run tools/build-web.sh, and build "
              "it again\n");
        CHECK(arena.names() == std::set<std::string>{"map"});
        return;
    }
    REQUIRE(run.status == 0);
    const std::string page = bytes_of(arena / "page.html");
    CHECK_THAT(page.substr(0, 15), Catch::Equals("<!doctype html>", Catch::CaseSensitive::No));
    CHECK_THAT(page, Contains("id=\"spawnfield-data\""));
    CHECK(arena(command + "-o again.html --raster 1 --threads 1").status == 0);
    CHECK(bytes_of(arena / "again.html").size() > 0);
    const auto refused = [&](const std::string& options, const std::string& message) {
        const ProgramRun bad = arena(command + "-o bad.html " + options);
        CAPTURE(options);
        CHECK(bad.status == 2);
        CHECK_THAT(bad.err, Contains(message));
        CHECK(!std::filesystem::exists(arena / "bad.html"));
    };
    refused("--raster 0", "--raster is 0, needs > 0");
    refused("--headings 17", "--headings");
    refused("--quantity room", "--quantity room has room, which a page does not show");
    refused("--stance level --pairs x.csv", "--pairs is only for settled robots");
    refused("--stance level --max-step 0.1", "--max-step is only for settled robots");
    refused("--quantity color", "--quantity");
}
