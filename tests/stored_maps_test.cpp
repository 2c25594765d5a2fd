#include "paths.h"
#include "catch.h"
#include "program.h"

#include <spawnfield/map.h>

using namespace spawnfield;
namespace fs = std::filesystem;

namespace {

fs::path stored_maps() { return source_folder() + "/tests/data/maps"; }

std::string stored_map(int version)
{
    return "'" + (stored_maps() / ("format-" + std::to_string(version))).string() + "'";
}

}  // namespace

TEST_CASE("a stored map of every format version that is read gives the verdicts of its scene")
{
    const TempFolder folder;
    const std::string check_poses = " --robot box:0.1,0.1,0.1 --poses '" + (stored_maps() / "poses.csv").string() + "'";
    for (int version = 2; version <= map_format_version; ++version) {
        CAPTURE(version);
        CHECK(run_program(folder, "info --verify " + stored_map(version)).status == 0);
        CHECK(run_program(folder, "check " + stored_map(version) + check_poses).out ==
              "name,x,y,z,verdict,ground,height_above,hit\n"
              "floor,-1,0,0.1,valid,0,0.1,\n"
              "on_deck,-3,0,1.6,valid,1.5,0.10000000000000009,\n"
              "under_deck,-3,0,0.1,valid,0,0.1,\n"
              "ball,1,0,0.1,collision,0,0.1,ball\n"
              "in_rock,2.1,-0.2,0.05,collision,0,0.05,rock\n"
              "pool,4,0,0.1,submerged,0,0.1,\n"
              "air,-1,0,3,aerial,0,3,\n"
              "beyond,9,0,0.1,outside,,,\n");
    }
}

TEST_CASE("a stored map of format version 1 is refused with the reason")
{
    const TempFolder folder;
    const ProgramRun run = run_program(folder, "info " + stored_map(1));
    CHECK(run.status == 4);
    CHECK_THAT(run.err, Contains("map.yaml: has format version 1, this program reads 2 and 3; bake the map again"));
}
