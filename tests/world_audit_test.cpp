#include "arena.h"
#include "junit_cases.h"

#include <spawnfield/audit.h>
#include <spawnfield/bake.h>
#include <spawnfield/error.h>
#include <spawnfield/review.h>
#include <spawnfield/robot_parts.h>
#include <spawnfield/scene_parts.h>

#include <nlohmann/json.hpp>

#include <algorithm>

using namespace spawnfield;

namespace {

void add_block(Scene& scene, const std::string& name, Label label, const Vec3& low, const Vec3& high)
{
    add_shape(scene, name, label, box_shape(high - low, {(low + high) / 2}));
}

/// Returns level ground of 8 x 8 m with four walls around a room of 2 x 3 m, and a gap of this width in one wall.
Scene room(double gap)
{
    Scene scene;
    scene.name = "room";
    add_block(scene, "floor", Label::Terrain, {-4, -4, -0.2}, {4, 4, 0});
    add_block(scene, "west", Label::Obstacle, {-1.1, -1.6, 0}, {-1, 1.6, 1});
    add_block(scene, "east", Label::Obstacle, {1, -1.6, 0}, {1.1, 1.6, 1});
    add_block(scene, "north", Label::Obstacle, {-1, 1.5, 0}, {1, 1.6, 1});
    add_block(scene, "south", Label::Obstacle, {-1, -1.6, 0}, {1 - gap, -1.5, 1});
    return scene;
}

Robot cube() { return make_robot("cube", {shape_part(box_shape({0.2, 0.2, 0.2}, {{0, 0, 0.1}}))}); }

RobotAudit audit_of(const Scene& scene, const AuditOptions& options = {})
{
    return audit_robot({make_map(scene), cube(), {}}, options);
}

/// A world with all kinds of faults, whose names contain special characters.
struct FaultyWorld {
    TempFolder folder;

    FaultyWorld()
    {
        folder.write("scene.yaml", R"(format: spawnfield-scene/1
name: "a <b> & \"c\""
parts:
  - {name: floor, label: terrain, box: [6, 6, 0.2], xyz: [0, 0, -0.1]}
  - {name: "<script>alert(1)</script>", box: [1, 1, 1], xyz: [0, 0, 1.5]}
  - {name: "sunk & gone", box: [0.5, 0.5, 1], xyz: [2, 2, -0.4]}
  - {name: crate_a, box: [1, 1, 1], xyz: [-2, -2, 0.5]}
  - {name: crate_b, box: [1, 1, 1], xyz: [-1.25, -2, 0.5]}
  - {name: statue, mesh: statue.stl, xyz: [2, -2, 0]}
)");
        folder.write("poses.csv", "name,x,y,z,yaw\ngood,0,-1.5,0.1,0\n\"<in> \"\"crate\"\"\",-2,-2,0.1,0\n");
    }

    ProgramRun operator()(const std::string& arguments) const
    {
        return run_program(folder, "audit scene.yaml --robot box:0.3,0.3,0.3 --poses poses.csv " + arguments);
    }
    /// Runs the audit with rules.
    ProgramRun with_rules(const std::string& rules, const std::string& arguments = "") const
    {
        folder.write("rules.yaml", rules);
        return (*this)("--rules rules.yaml " + arguments);
    }
};

}  // namespace

TEST_CASE("the free area is that of the places where the middle of a robot can be")
{
    Scene scene;
    add_block(scene, "floor", Label::Terrain, {-4, -4, -0.2}, {4, 4, 0});
    const RobotAudit open = audit_of(scene, {.step = 0.1});
    CHECK(open.raster.stance == Stance::Settled);
    // On the edge, less than half of the robot is above the ground, so it would fall; 81 columns are at most 8.1 m.
    CHECK(open.free_area == Approx(8 * 8).epsilon(0.03));
    CHECK(open.free_share == Approx(double(open.raster.counts[Verdict::Valid]) / (81 * 81)));
    add_block(scene, "block", Label::Obstacle, {-2, -2, 0}, {2, 2, 1});
    const double blocked = audit_of(scene, {.step = 0.1}).free_area;
    CHECK(open.free_area - blocked == Approx(4.2 * 4.2).epsilon(0.06));  // touching is a collision
    CHECK(auto_audit_step(make_map(scene)) == 0.1);
}

TEST_CASE("a closed room has the area within its walls, and a door opens it")
{
    const RobotAudit closed = audit_of(room(0), {.reach = {.step = 0.05}});
    REQUIRE(closed.closed_rooms.size() == 1);
    CHECK(closed.closed_rooms[0].area == Approx(1.8 * 2.8).epsilon(0.05));
    CHECK(closed.closed_rooms[0].place.head<2>().norm() < 0.1);
    CHECK(closed.graph.islands().size() == 2);
    CHECK(audit_of(room(0), {.reach = {.step = 0.05}, .min_room = 6}).closed_rooms.empty());
    const RobotAudit opened = audit_of(room(0.6), {.reach = {.step = 0.05}});
    CHECK(opened.closed_rooms.empty());
    CHECK(opened.graph.islands().size() == 1);
}

TEST_CASE("start poses that are not valid have a reason, a culprit and the nearest valid pose")
{
    const RobotAudit audit = audit_of(room(0), {.poses = {{"in", {{0, 0, 0.1}}}, {"wall", {{1, 0, 0.1}}}}});
    REQUIRE(audit.bad_poses.size() == 1);
    const BadPose& bad = audit.bad_poses[0];
    CHECK(bad.pose == 1);
    CHECK(bad.verdict == Verdict::OffTerrain);
    CHECK(bad.culprit == "east");
    CHECK(bad.reason == "off_terrain: it comes to rest on east");
    REQUIRE(bad.repair.pose);
    CHECK(bad.repair.distance == Approx(0.15).margin(0.1));
    CHECK(audit_of(room(0), {.poses = {{"wall", {{1, 0, 0.1}}}}, .repair = 0.01}).bad_poses[0].repair.pose ==
          std::nullopt);
}

TEST_CASE("rules are kept or broken, with value and limit")
{
    AuditReport report{.map = make_map(room(0)), .missing = {{"a", "b"}}};
    report.poses = {{"in", {{0, 0, 0.1}}}, {"wall", {{1, 0, 0.1}}}};
    report.robots = {audit_robot({report.map, cube(), {}}, {.poses = report.poses})};
    report.parts.overlaps.resize(2);
    report.parts.floating.resize(7);
    for (FloatingProps& floating : report.parts.floating) floating.props = {"lamp"};
    const AuditRules rules{.min_free_area = 1000,
                           .max_islands = 1,
                           .max_closed_rooms = 1,
                           .max_overlaps = 2,
                           .max_floating = 0,
                           .max_sunken = 0,
                           .max_missing = 1,
                           .requires_all = true};
    const std::vector<RuleResult> results = results_of(rules, report);
    std::vector<std::string> broken, kept;
    for (const RuleResult& result : results) (result.is_kept ? kept : broken).push_back(result.words);
    REQUIRE(broken.size() == 5);
    CHECK(broken[0].starts_with("free area of cube is "));
    CHECK(broken[0].ends_with(" m2, at least 1000 m2 are needed"));
    CHECK(broken[1] == "2 islands of cube, at most 1 is allowed");
    CHECK(broken[2].starts_with("wall, cube: off_terrain: it comes to rest on east"));
    CHECK(broken[3] == "7 floating props, at most 0 are allowed: lamp; lamp; lamp; lamp; lamp; …");
    CHECK(broken[4] == "2 missing files, at most 1 is allowed: a; b");
    CHECK(kept == std::vector<std::string>{"1 closed room of cube, at most 1 is allowed", "in, cube: valid",
                                           "2 overlaps, at most 2 are allowed",
                                           "0 sunken props, at most 0 are allowed"});
    report.missing.reset();
    CHECK(!results_of({.max_missing = 9}, report)[0].is_kept);
    CHECK(results_of({}, report).empty());
}

TEST_CASE("a scene.yaml whose files do not exist is refused, or its parts are left out and listed")
{
    const TempFolder folder;
    const auto file = folder.write("scene.yaml", R"(format: spawnfield-scene/1
parts:
  - {name: floor, label: terrain, box: [6, 6, 0.2]}
  - {name: cart, mesh: no.stl, path: [{time: 0, xyz: [0, 0, 0]}, {time: 1, xyz: [1, 0, 0]}]}
  - {name: hill, label: terrain, heightmap: {file: no.png, size: [10, 10], z: [0, 1]}}
  - {name: cloud, octomap: no.bt}
  - {name: statue, mesh: no.stl}
)");
    CHECK_THROWS_WITH(load_scene(file), Contains("part \"cart\": mesh cannot be used"));
    const Scene scene = load_scene(file, {.allow_missing = true});
    REQUIRE(scene.missing.size() == 4);
    CHECK(scene.missing[0] ==
          file.string() + ": part \"cart\": mesh: " + (folder / "no.stl").string() + " is not found: it is ignored");
    for (const std::string& text : scene.missing)
        CHECK(std::count(scene.notices.begin(), scene.notices.end(), text) == 1);
    CHECK(scene.parts.size() == 5);
    CHECK(scene.primitives.size() == 1);
    CHECK(scene.triangles.empty());
}

TEST_CASE("audit writes a report and ends with status 0 without rules")
{
    const FaultyWorld world;
    const ProgramRun run = world("");
    CHECK(run.status == 0);
    CHECK(run.out.find("box:0.3,0.3,0.3: free area ") != std::string::npos);
    CHECK(run.out.find("1 of 2 poses valid\n") != std::string::npos);
    CHECK(run.out.find("floating props: 1\n  <script>alert(1)</script>: hangs 1 m above floor") != std::string::npos);
    CHECK(run.out.find("sunken props: 1\n  sunk & gone: 90 % of it is below the ground") != std::string::npos);
    CHECK(run.out.find("overlapping parts: 1\n  crate_a, crate_b: overlap by 0.25 m") != std::string::npos);
    CHECK(run.out.find("missing files: 1\n") != std::string::npos);
    CHECK(run.out.find("statue.stl is not found") != std::string::npos);
    CHECK(run.out.find("rules:") == std::string::npos);
    CHECK(names_in(world.folder.path()) == std::set<std::string>{"scene.yaml", "poses.csv"});
    CHECK(world("--strict").status == 4);
}

TEST_CASE("a broken rule ends audit with status 3 and its name, and a kept one with status 0")
{
    const FaultyWorld world;
    const ProgramRun broken = world.with_rules("max_floating: 0\nmin_free_area: 1\nrequire: all\n", "-o out.txt");
    CHECK(broken.status == 3);
    CHECK(broken.out.empty());
    CHECK(broken.err.find("spawnfield: 2 of 4 rules are broken:\n  require: <in> \"crate\", box:0.3,0.3,0.3: "
                          "off_terrain: it comes to rest on crate_a") != std::string::npos);
    CHECK(
        broken.err.ends_with("\n  max_floating: 1 floating prop, at most 0 are allowed: "
                             "<script>alert(1)</script>\n"));
    CHECK(bytes_of(world.folder / "out.txt").find("rules: 2 of 4 broken\n") != std::string::npos);
    CHECK(world.with_rules("max_floating: 1\nmax_islands: 5\nrequire: [good, [0, -1.5, 0.1, 1]]\n").status == 0);
    const ProgramRun allowed = world.with_rules(
        "max_floating: 0\nmax_overlaps: 0\nallow: ['<script>*', crate_b, no]\n");
    CHECK(allowed.status == 0);
    CHECK(allowed.err.find("rules.yaml: allow: \"no\" matches no part of the world") != std::string::npos);
}

TEST_CASE("audit of a map folder gives the same findings as of its scene")
{
    const FaultyWorld world;
    REQUIRE(run_program(world.folder, "bake scene.yaml -o map --allow-missing").status == 0);
    const auto json_of = [](const ProgramRun& run) {
        REQUIRE(run.status == 0);
        nlohmann::json out = nlohmann::json::parse(run.out);
        out.erase("missing");
        out["world"].erase("hash");
        return out;
    };
    const std::string map = "audit map --robot box:0.3,0.3,0.3 --poses poses.csv --format json";
    CHECK(json_of(run_program(world.folder, map)) == json_of(world("--format json")));
    CHECK(json_of(run_program(world.folder, map + " --threads 1")) == json_of(world("--format json --threads 3")));
    CHECK(nlohmann::json::parse(run_program(world.folder, map).out)["missing"].is_null());
    const ProgramRun refused = run_program(world.folder, map + " --up y");
    CHECK(refused.status == 2);
    CHECK(refused.err.ends_with("spawnfield: --up is only for scenes; map is a map\n"));
}

TEST_CASE("JSON, JUnit and HTML of an audit are read back, and names in them are escaped")
{
    const FaultyWorld world;
    const std::string rules = "max_floating: 0\nrequire: [good]\n";
    const nlohmann::json json = nlohmann::json::parse(world.with_rules(rules, "--format json").out);
    CHECK(json["format"] == "spawnfield-audit/1");
    CHECK(json["floating"][0]["props"][0] == "<script>alert(1)</script>");
    CHECK(json["floating"][0]["height"].get<double>() == Approx(1));
    CHECK(json["overlaps"][0]["depth"].get<double>() == Approx(0.25).margin(1e-6));
    CHECK(json["robots"][0]["bad_poses"][0]["culprit"] == "crate_a");
    CHECK(json["robots"][0]["free"]["area"].get<double>() > 10);
    CHECK(json["rules"].size() == 2);

    const std::vector<JunitTestCase> cases = cases_of(world.with_rules(rules, "--format junit").out);
    std::vector<std::string> failed;
    for (const JunitTestCase& test : cases)
        if (!test.type.empty()) failed.push_back(test.class_name + " / " + test.name + " / " + test.type);
    const std::string map = "a <b> & \"c\".";
    CHECK(failed == std::vector<std::string>{
                        map + "rules / max_floating / max_floating",
                        map + "box:0.3,0.3,0.3 / <in> \"crate\" / off_terrain", map + "world / sunken props / sunken",
                        map + "world / overlapping parts / overlaps", map + "world / missing files / missing"});
    CHECK(cases.size() == 7);  // and `good` and the closed rooms, which pass

    const ProgramRun html = world.with_rules(rules, "--format html -o audit.html");
    CHECK(html.status == 3);
    const std::string written = bytes_of(world.folder / "audit.html");
    const std::size_t frame = written.find("<iframe"), end = written.find("</iframe>");
    CHECK((frame != std::string::npos) == has_review_page());
    CHECK(std::count(written.begin(), written.end(), '<') > 100);
    const std::string page = frame == std::string::npos ? written : written.substr(0, frame) + written.substr(end);
    if (has_review_page()) {
        const std::string inside = written.substr(frame, end - frame);
        CHECK(std::count(inside.begin(), inside.end(), '<') == 1);  // names and scripts are escaped
        CHECK(written.find("script-src 'sha256-") < frame);
    }
    CHECK(page.starts_with("<!DOCTYPE html>"));
    CHECK(page.ends_with("</body>\n</html>\n"));
    CHECK(page.find("<script") == std::string::npos);
    CHECK(page.find("&lt;script&gt;alert(1)&lt;/script&gt;") != std::string::npos);
    CHECK(page.find("<title>Audit of a &lt;b&gt; &amp; &quot;c&quot;</title>") != std::string::npos);
    CHECK(page.find("&lt;in&gt; &quot;crate&quot;") != std::string::npos);
    CHECK(page.find("http://") == std::string::npos);
    std::size_t pictures = 0;
    for (std::size_t at = page.find("data:image/png;base64,iVBORw0KGgo"); at != std::string::npos;
         at = page.find("data:image/png;base64,iVBORw0KGgo", at + 1))
        ++pictures;
    CHECK(pictures == 2);
    CHECK(written == world.with_rules(rules, "--format html --threads 1").out);
}

TEST_CASE("faults of rules are named with the file, the key and what is allowed")
{
    const FaultyWorld world;
    const auto complaint = [&](const std::string& rules) {
        const ProgramRun run = world.with_rules(rules);
        CHECK((run.status == 4 || run.status == 2));
        CHECK(run.out.empty());
        return run.err;
    };
    CHECK(complaint("max_flying: 1\n")
              .find("max_flying is not a known key; known keys: min_free_area, max_islands, "
                    "max_closed_rooms, max_overlaps, max_floating, max_sunken, max_missing, "
                    "require, allow") != std::string::npos);
    CHECK(complaint("max_islands: 1.5\n").find("max_islands is 1.5, needs a whole number from 0 to ") !=
          std::string::npos);
    CHECK(complaint("max_islands: -1\n").find("max_islands is -1, needs a whole number from 0 to ") !=
          std::string::npos);
    CHECK(complaint("min_free_area: -2\n").find("min_free_area is -2, needs >= 0 m2") != std::string::npos);
    CHECK(complaint("require: dock\n").find("require is \"dock\", needs a list of poses") != std::string::npos);
    CHECK(complaint("require: [dock]\n").find("require: no pose has the name \"dock\"") != std::string::npos);
    CHECK(complaint("require: [[1, 2, 3]]\n").find("require entry 1 has 3 numbers, needs [x, y, z, yaw]") !=
          std::string::npos);
    CHECK(complaint("require: [[1, 2, 3, x]]\n").find("require entry 1 has a value that is not a finite number") !=
          std::string::npos);
    CHECK(complaint("require: [{a: 1}]\n").find("require entry 1 is neither a name nor [x, y, z, yaw]") !=
          std::string::npos);
    CHECK(complaint("allow: crate\n").find("allow is crate, needs a list") != std::string::npos);
    CHECK(complaint("allow: [[a]]\n").find("allow has an entry that is not a glob of parts") != std::string::npos);
}

TEST_CASE("options of audit that cannot be used are refused before any work")
{
    const FaultyWorld world;
    CHECK(world("--gap -1").err == "spawnfield: --gap is -1, needs >= 0 m\n");
    CHECK(world("--overlap 0").err == "spawnfield: --overlap is 0, needs > 0\n");
    CHECK(world("--repair 0").err == "spawnfield: --repair is 0, needs > 0\n");
    CHECK(world("--min-room -1").err == "spawnfield: --min-room is -1, needs >= 0 m2\n");
    CHECK(world("--step 0").err == "spawnfield: --step is 0, needs > 0\n");
    CHECK(world("--format xml").status == 2);
    CHECK(world("--allow-missing").status == 2);
    const ProgramRun unwritable = world("-o no/such/folder/out.txt");
    CHECK(unwritable.status == 1);
}
