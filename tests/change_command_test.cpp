#include "catch.h"
#include "this_build.h"
#include "program.h"

#include <spawnfield/poses.h>

#include <nlohmann/json.hpp>

using spawnfield::column_of, spawnfield::parse_poses, spawnfield::PoseTable;
using Json = nlohmann::json;

namespace {

const std::string head = "format: spawnfield-scene/1\nname: yard\nparts:\n",
                  floor_and_wall =
                      "- {name: floor, label: terrain, box: [10, 8, 1], xyz: [0, 0, -0.5]}\n"
                      "- {name: wall, label: obstacle, box: [0.2, 8, 1], xyz: [2, 0, 0.5]}\n",
                  crates =
                      "- {name: crate-1, label: obstacle, box: [1, 1, 1], xyz: [-1, 1, 0.5]}\n"
                      "- {name: crate-2, label: terrain, box: [1, 1, 0.3], xyz: [-1, -2, 0.15]}\n",
                  ramp =
                      "- {name: ramp, label: terrain, box: [2, 2, 0.2], xyz: [-3, 0, 0.1], rpy_deg: [0, 10, 0]}\n"
                      "- {name: lake, label: water, plane: [1, 2], xyz: [0.5, 1, 0.05]}\n";

/// A folder with the map of a yard before a change, and that of the yard after it.
class Yard : public TempFolder {
public:
    Yard()
    {
        write("before.yaml", head + floor_and_wall + crates);
        write("after.yaml", head + floor_and_wall + ramp);
        write("extra.yaml", head + ramp);
        write("poses.csv", "x,y,z,yaw\n-1,1,0.1,0\n-1,-2,0.4,0\n-3,0,0.5,1\n0.5,1,0.2,0\n-4,3,0.1,0\n1.8,0,0.1,0\n");
        for (const std::string name : {"before", "after"})
            REQUIRE(
                run_program(*this, "bake " + name + ".yaml -o " + name + " --resolution 0.2 --bounds=-5,-4,-1,5,4,3")
                    .status == 0);
    }

    static constexpr const char* changes = " --without 'CRATE*' --with extra.yaml ";
};

const std::string robot = " --robot box:0.5,0.4,0.3 ";

}  // namespace

TEST_CASE("--with and --without give the files of a new bake")
{
    const Yard yard;
    for (const std::string command :
         {"check @ --poses poses.csv", "check @ --poses poses.csv --settle --repair 1", "raster @ --dims 2 --step 0.25",
          "raster @ --dims 3 --step 1 --step-z 0.3", "raster @ --dims 2 --step 0.7 --settle",
          "sample @ -n 20 --min-distance 0.7 --yaw random", "sample @ -n 40 --min-distance 0.5 --stance level",
          "sample @ -n 10 --island largest --reach-step 0.5", "sample @ -n 10 --floor 0",
          "search @ -n 10 --min-distance 0.5 --max-failures 1000", "heatmap @ -o - --format svg --size 300"}) {
        CAPTURE(command);
        const std::size_t at = command.find('@');
        const auto run = [&](const std::string& map, const std::string& options) {
            return run_program(yard, command.substr(0, at) + map + command.substr(at + 1) + robot + options);
        };
        const ProgramRun changed = run("before", Yard::changes), baked = run("after", "");
        CHECK(changed.status == baked.status);
        CHECK(!baked.out.empty());
        CHECK(changed.out == baked.out);
        CHECK(changed.out != run("before", "").out);
    }
}

TEST_CASE("results name the changes of a map")
{
    const Yard yard;
    const ProgramRun spawns = run_program(
        yard, "sample before -n 3 --format json --summary sums.json" + robot + Yard::changes);
    REQUIRE(spawns.status == 0);
    const Json changes = Json::parse(spawns.out)["map"]["changes"];
    REQUIRE(changes.size() == 2);
    CHECK(changes[0] == "without CRATE*");
    CHECK(changes[1].get<std::string>().starts_with("with extra.yaml ("));
    const Json summary = Json::parse(bytes_of(yard / "sums.json"));
    CHECK(summary["changes"] == changes);
    CHECK(summary["map_hash"] == Json::parse(spawns.out)["map"]["hash"]);

    const ProgramRun info = run_program(yard, "info before --json --islands --reach-step 0.5" + robot + Yard::changes),
                     baked = run_program(yard, "info after --json --islands --reach-step 0.5" + robot);
    REQUIRE(info.status == 0);
    const Json changed = Json::parse(info.out), after = Json::parse(baked.out);
    CHECK(changed["changes"] == changes);
    for (const char* const key : {"bounds", "layers", "floors", "parts", "labels", "reach"}) {
        CAPTURE(key);
        CHECK(changed[key] == after[key]);
    }
}

TEST_CASE("a robot of --with stands at rest on the ground, or level at its z")
{
    const Yard yard;
    const auto check = [&](const std::string& with) {
        return run_program(yard, "check before --poses poses.csv --robot box:0.1,0.1,0.1 --quiet --with " + with).out;
    };
    yard.write("poses.csv", "x,y,z\n-4,3.05,0.29\n-4,3.05,0.31\n-1,-2,0.55\n-1,-2,0.65\n");
    const std::string rows = check("box:0.4,0.4,0.3@-4,3,90deg");  // rests on the floor: its top is at 0.3
    CHECK(rows.find("\n-4,3.05,0.29,collision,0,0.29,box::0\n") != std::string::npos);
    CHECK(rows.find("\n-4,3.05,0.31,valid,0.3,") == std::string::npos);  // the ground below is a robot
    CHECK(rows.find("\n-4,3.05,0.31,off_terrain,0.3,") != std::string::npos);
    const std::string raised = check("box:0.4,0.4,0.3@-1,-2,0");  // on crate-2: its top is at 0.6
    CHECK(raised.find("\n-1,-2,0.55,collision,") != std::string::npos);
    CHECK(raised.find("\n-1,-2,0.65,off_terrain,0.6,") != std::string::npos);
    const std::string level = check("box:0.4,0.4,0.3@-4,3,0.2,0");  // from 0.2 to 0.5
    CHECK(level.find("\n-4,3.05,0.29,collision,") != std::string::npos);
    const std::string two = check("box:0.4,0.4,0.3@-4,-3,0 --with box:0.4,0.4,0.3@-4,3,0");
    CHECK(two.find("\n-4,3.05,0.29,collision,0,0.29,box_2::0\n") != std::string::npos);
}

TEST_CASE("--without takes globs with commas between them, unless a name matches as a whole")
{
    const Yard yard;
    const auto check = [&](const std::string& map, const std::string& options) {
        return run_program(yard, "check " + map + " --poses poses.csv" + robot + options);
    };
    const std::string two = check("before", "--without crate-1 --without crate-2").out;
    CHECK(two != check("before", "").out);
    for (const char* const options : {"--without crate-1,crate-2", "--without crate-1,crate-2 --without crate-1"})
        CHECK(check("before", options).out == two);
    CHECK_THAT(check("before", "--without 'crate-1,pallet*'").err,
               Contains("--without \"pallet*\" matches no part of the map"));
    CHECK_THAT(check("before", "--without crate-1,").err, Contains("--without \"\" matches no part of the map"));
    yard.write("comma.yaml", head + floor_and_wall +
                                 "- {name: 'a,b', label: obstacle, box: [1, 1, 1], xyz: [-1, 1, 0.5]}\n"
                                 "- {name: a, label: obstacle, box: [1, 1, 1], xyz: [-4, 3, 0.5]}\n");
    REQUIRE(run_program(yard, "bake comma.yaml -o comma").status == 0);
    const PoseTable table = parse_poses(check("comma", "--without 'a,b'").out, "verdicts");
    CHECK(column_of(table, "hit")[4] == "a");  // only the part with the comma is gone
    CHECK(column_of(table, "hit")[0].empty());
}

TEST_CASE("wrong changes are refused with a reason")
{
    const Yard yard;
    const auto complaint = [&](const std::string& options, int status) {
        const ProgramRun run = run_program(yard, "sample before -n 1 -o out.csv" + robot + options);
        CHECK(run.status == status);
        CHECK(!std::filesystem::exists(yard / "out.csv"));
        return run.err;
    };
    CHECK_THAT(complaint("--without 'pallet*'", 2), Contains("--without \"pallet*\" matches no part of the map; there "
                                                             "are floor, wall, crate-1, crate-2 (`spawnfield info"));
    yard.write("same.yaml", head + crates);
    CHECK_THAT(
        complaint("--with same.yaml", 4),
        Contains("same.yaml: part \"crate-1\" exists in the map already; give it another name, or remove the old "
                 "one first (--without)"));
    CHECK_THAT(complaint("--with missing.yaml", 4), Contains("missing.yaml"));
    CHECK_THAT(complaint("--with box:1,1,1", 2), Contains("is a robot without a pose; write ROBOT@x,y,yaw"));
    CHECK_THAT(complaint("--with box:1,1,1@2", 2), Contains("is a robot without a pose; write ROBOT@x,y,yaw"));
    CHECK_THAT(complaint("--with box:1,1,1@2,3,4,5,6", 2), Contains("has 5 numbers after the @, needs 3 or 4"));
    CHECK_THAT(complaint("--with box:1,1,1@1.5,3,0", 2), Contains("the robot cannot stand there: collision"));
    CHECK_THAT(complaint("--with box:1,1,1@20,3,0", 2), Contains("there is no terrain at x 20, y 3 for the robot"));
    const auto notices = [&](const std::string& options) {
        return run_program(yard, "check before --poses poses.csv" + robot + options).err;
    };
    yard.write("far.yaml", head + "- {name: far, label: obstacle, box: [1, 1, 1], xyz: [30, 0, 0]}\n");
    CHECK_THAT(notices("--with far.yaml"), Contains("far.yaml: part \"far\" lies off the map"));
    CHECK_THAT(notices("--without floor --without crate-2"), Contains("the changed map has no terrain"));
    const ProgramRun scene = run_program(yard, "info extra.yaml --without lake");
    CHECK(scene.status == 2);
    CHECK_THAT(scene.err, Contains("--without is only for maps; extra.yaml is not a map"));
}
