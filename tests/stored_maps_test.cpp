#include "this_build.h"
#include "catch.h"
#include "program.h"

#include <spawnfield/map.h>

using namespace spawnfield;
namespace fs = std::filesystem;

namespace {

const fs::path stored_maps = source_folder() + "/tests/data/maps";

constexpr std::array versions{2, 3, 4, 5, 6, 7, 9};  // stored; 8 has only an occupancy_origin more than 7

/// A folder with `map`, as a program wrote it that had this format version. Files that are the same in an older
/// version, from 3 on, are stored there only.
struct StoredMap : TempFolder {
    explicit StoredMap(int version)
    {
        // Without `recursive`, copy() ignores folders if another option is given.
        constexpr auto overwrite = fs::copy_options::recursive | fs::copy_options::overwrite_existing;
        const auto copy = [&](int from) {
            fs::copy(stored_maps / ("format-" + std::to_string(from)), *this / "map", overwrite);
        };
        for (const int from : versions)
            if (from >= 3 && from < version) copy(from);
        if (version < 3) copy(3);
        copy(version);
    }
};

}  // namespace

TEST_CASE("stored maps of all format versions that are read give the verdicts of their scene")
{
    const std::string poses = "'" + (stored_maps / "poses.csv").string() + "'";
    for (const int version : versions) {
        CAPTURE(version);
        const StoredMap stored(version);
        CHECK(
            bytes_of(stored / "map/map.yaml").starts_with("format: spawnfield-map/" + std::to_string(version) + "\n"));
        const ProgramRun info = run_program(stored, "info --verify map");
        CHECK(info.status == 0);
        CHECK_THAT(info.out, Contains("; voxels of 1.0 m; format " + std::to_string(version) + "\n"));
        const ProgramRun check = run_program(stored, "check map --robot box:0.1,0.1,0.1 --poses " + poses);
        const std::string notice = "notice: map has format " + std::to_string(version) + ", which is slow to open;";
        CHECK(check.err.starts_with(notice) == (version < 5));
        CHECK(check.out ==
              "name,x,y,z,verdict,ground,height_above,hit\n"
              "floor,-1,0,0.1,valid,0,0.1,\n"
              "on_deck,-6,0,1.6,valid,1.5,0.10000000000000009,\n"
              "under_deck,-6,0,0.1,valid,0,0.1,\n"
              "ball,1,0,0.1,collision,0,0.1,ball\n"
              "in_rock,2.1,-0.2,0.05,collision,0,0.05,rock\n"
              "pool,6,0,0.1,submerged,0,0.1,\n"
              "air,-1,0,3,aerial,0,3,\n"
              "beyond,9,0,0.1,outside,,,\n");
    }
}

TEST_CASE("a stored map of format version 1 is refused with the reason")
{
    const StoredMap stored(1);
    const ProgramRun run = run_program(stored, "info map");
    CHECK(run.status == 4);
    CHECK_THAT(run.err, Contains("map/map.yaml: has format version 1, this program reads 2 to 9; bake the map again"));
}
