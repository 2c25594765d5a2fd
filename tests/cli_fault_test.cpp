#include "this_build.h"
#include "catch.h"
#include "program.h"

#include <set>

namespace fs = std::filesystem;

namespace {

/// What the program must print after `spawnfield `: all of standard error except the usage hint.
struct Refusal {
    std::string arguments, message;
};

const std::string husky = " --robot '" + source_folder() + "/maps/robots/husky.yaml' ";

/// A folder with a map, poses, and an old result that must not be touched.
class Desk : public TempFolder {
public:
    Desk()
    {
        write("scene.yaml",
              "format: spawnfield-scene/1\nparts: [{name: floor, label: terrain, box: [8, 8, 1]}, {name: b, sphere: "
              "1}]\n");
        write("poses.csv", "x,y,z\n3,3,0.6\n");
        write("out", "old");
        REQUIRE(run_program(*this, "bake scene.yaml -o map --resolution 0.5").status == 0);
        before_ = names();
    }

    void check(const Refusal& refusal, int status) const
    {
        CAPTURE(refusal.arguments);
        const ProgramRun run = run_program(*this, refusal.arguments);
        CHECK(run.status == status);
        CHECK(run.out.empty());
        CHECK(run.err == refusal.message + "\n");
        check_untouched();
    }

    void check_untouched() const
    {
        CHECK(bytes_of(*this / "out") == "old");
        CHECK(names() == before_);
    }

    /// Adds further files of a test to the files that must not change.
    void remember() { before_ = names(); }

private:
    /// Returns all files, without drivable graphs that queries keep in the map's folder.
    std::set<std::string> names() const
    {
        std::set<std::string> out;
        for (const auto& entry : fs::recursive_directory_iterator(path()))
            if (!entry.path().filename().string().starts_with("reach-")) out.insert(entry.path().string());
        return out;
    }
    std::set<std::string> before_;
};

const std::string hint = "\nRun with --help for more information.";

}  // namespace

TEST_CASE("wrong usage ends with status 2, and the message names option, value and limit")
{
    const Desk desk;
    const std::string raster = "raster map -o out --dims 2 --step 1" + husky,
                      raster3 = "raster map -o out --dims 3 --step 1" + husky, sample = "sample map -o out" + husky,
                      experiment = "experiment map -o out" + husky,
                      search = "search map -o out --min-distance 1" + husky,
                      steps_form = ", needs FROM:TO:BY, for example 0.5:2:0.5, or one number, m";
    const Refusal refusals[] = {
        {"", "A subcommand is required" + hint},
        {"bake", "scene is required" + hint},
        {"bake scene.yaml", "--out is required" + hint},
        {"check map --poses poses.csv -o out", "--robot is required" + hint},
        {"check map --poses poses.csv -o out --robot ''",
         "--robot: is empty; is a variable of the shell not set?" + hint},
        {"bake scene.yaml -o ''", "--out: is empty; is a variable of the shell not set?" + hint},
        {sample + " -n 3 --stance level --offset 1e300", "spawnfield: --offset is 1e+300, needs at most 1e7 m"},
        {"bake scene.yaml -o new --bounds -1e300,0,0,1,1,1",
         "spawnfield: --bounds is -1e+300, needs numbers between -1e7 and 1e7, m"},
        {"raster map -o out --dims 2" + husky, "--step is required" + hint},
        {"raster map -o out --step 1" + husky, "--dims is required" + hint},
        {"raster map -o out --dims 2 --step 0" + husky, "spawnfield: --step is 0, needs > 0"},
        {"raster map -o out --dims 3 --step 1 --step-z 0" + husky, "spawnfield: --step-z is 0, needs > 0"},
        {raster + "--layers low",
         "spawnfield: --layers is \"low\", needs all, top, bottom or a number (0 is the highest layer)"},
        {raster + "--bounds 0,0,-1,5",
         "spawnfield: --bounds: x1 is -1, needs at least x0; give the lower corner first"},
        {raster + "--bounds 0,0,1",
         "spawnfield: --bounds has 3 numbers, needs 6: x0,y0,z0,x1,y1,z1 (or 4: x0,y0,x1,y1)"},
        {"raster map -o out --dims 3 --step 1 --bounds 0,0,1,1" + husky,
         "spawnfield: --bounds has 4 numbers, needs 6: x0,y0,z0,x1,y1,z1"},
        {raster3 + "--max-height -1", "spawnfield: --max-height is -1, needs >= 0 m"},
        {raster + "--max-water-depth nan", "spawnfield: --max-water-depth is nan, needs >= 0 m"},
        {raster + "--max-slope 0", "spawnfield: --max-slope is 0, needs > 0 and < 90 degrees"},
        {sample + "-n 5 --max-slope 90", "spawnfield: --max-slope is 90, needs > 0 and < 90 degrees"},
        {search + "-n 5 --max-slope nan", "spawnfield: --max-slope is nan, needs > 0 and < 90 degrees"},
        {"check map --poses poses.csv -o out --max-slope inf" + husky,
         "spawnfield: --max-slope is inf, needs > 0 and < 90 degrees"},
        {"heatmap map -o out --max-slope -5" + husky, "spawnfield: --max-slope is -5, needs > 0 and < 90 degrees"},
        {raster + "--yaw inf", "spawnfield: --yaw is inf, needs a finite number, rad"},
        {raster + "--offset inf", "spawnfield: --offset: \"inf\" is not a finite number"},
        {raster + "--write-aerial",
         "spawnfield: --write-aerial is only for --dims 3: in 2D each pose stands on a layer"},
        {"raster map -o out --dims 2 --step 0.00001" + husky,
         "spawnfield: columns is 640001600001, needs at most 2147483647; take a larger step"},
        {raster3 + "--write-aerial --layers top",
         "spawnfield: --write-aerial needs --layers all: aerial poses do not belong to a layer"},
        {raster + "--no-height-check",
         "spawnfield: --no-height-check is only for --dims 3: in 2D each pose stands on a layer"},
        {raster + "--snap", "spawnfield: --snap is only for --dims 3: in 2D each pose stands on a layer"},
        {raster3 + "--snap --no-height-check",
         "spawnfield: --snap and --no-height-check do not go together: without the height check there is no layer to "
         "snap to"},
        {raster3 + "--snap --offset 0.6 --max-height 0.5",
         "spawnfield: --offset is 0.6, needs 0 .. --max-height (0.5 "
         "m) with --snap; otherwise poses on layers would be aerial"},
        {sample + "-n 0", "spawnfield: -n is 0, needs >= 1"},
        {sample + "-n 5 --min-distance -1", "spawnfield: --min-distance is -1, needs >= 0 m"},
        {sample + "-n 5 --yaw north",
         "spawnfield: --yaw is \"north\", needs radians such as 1.57 or degrees such as 90deg, or random, "
         "or facing:X,Y, downhill, uphill, all:K, any:K, best:K, best:K:clearance or along"},
        {sample + "-n 5 --region 1,1,0,0",
         "spawnfield: --region: x1 is 0, needs at least x0; give the lower corner first"},
        {search + "-n 5 --max-failures 0", "spawnfield: --max-failures is 0, needs >= 1"},
        {search + "-n 5 --max-failures 9 --bounds 0,0,5,1,1,4",
         "spawnfield: --bounds: z1 is 4, needs at least z0; give the lower corner first"},
        {"sample map -o out -n 5 --robot box:1,0,1", "spawnfield: robot \"box:1,0,1\": side length is 0, needs > 0 m"},
        {"sample map -o out -n 5 --robot box:1,1",
         "spawnfield: robot \"box:1,1\": has 2 side lengths, needs 3 (box:LX,LY,LZ[@x,y,z])"},
        {"bake scene.yaml -o new --resolution 0", "spawnfield: --resolution is 0, needs > 0"},
        {"bake scene.yaml -o new --bounds 0,0,0,1,1,-1",
         "spawnfield: --bounds: z1 is -1, needs at least z0; give the lower corner first"},
        {"bake scene.yaml -o new --label a=grass",
         "spawnfield: --label is \"a=grass\", needs GLOB=terrain, GLOB=obstacle, GLOB=water or GLOB=ignore"},
        {"bake scene.yaml -o new --scale 2",
         "spawnfield: up and scale are for a bare mesh; give them in scene.yaml (keys up, scale)"},
        {"bake scene.yaml -o new --scale 0", "spawnfield: --scale is 0, needs > 0"},
        {"bake scene.yaml -o new --resolution 0.00001",
         "spawnfield: columns at a cell of 1e-05 m is 6.4e+11, needs at most 1e+08; take a coarser resolution"},
        {"info map --up y", "spawnfield: --up is only for scenes; map is a map"},
        {"info map --model-path .", "spawnfield: --model-path is only for scenes and robots; map is a map"},
        {"info map --picture new.png", "spawnfield: --picture is only for robots; map is a map"},
        {"info scene.yaml --joints a=1", "spawnfield: --joints is only for robots; scene.yaml is not a robot"},
        {"info box:1,1,1 --joints a=1", "spawnfield: joint \"a\" is given, but box:1,1,1 has no joints"},
        {sample + "-n 5 --joints elbow",
         "spawnfield: --joints: \"elbow\" is not a joint; write name=value[,name=value…] in rad or m"},
        {sample + "-n 5 --joints elbow=1,wrist=x", "spawnfield: --joints: wrist: \"x\" is not a finite number"},
        {"info scene.yaml --verify", "spawnfield: --verify is only for maps; scene.yaml is not a map"},
        {"info box:1,1,1 --scale 1", "spawnfield: --scale is only for scenes; box:1,1,1 is a robot"},
        {experiment + "--dims 2", "spawnfield: --steps is missing; give for example --steps 0.5:2:0.5, or --search"},
        {experiment + "--steps 1", "spawnfield: --dims is missing; give --dims 2, --dims 3 or --search"},
        {experiment + "--dims 2 --steps 0.5:2", "spawnfield: --steps is \"0.5:2\"" + steps_form},
        {experiment + "--dims 2 --steps 0.5:two:1", "spawnfield: --steps: \"two\" is not a finite number" + steps_form},
        {experiment + "--dims 2 --steps 1,0.5", "spawnfield: --steps: \"1,0.5\" is not a finite number" + steps_form},
        {experiment + "--dims 2 --steps 0", "spawnfield: --steps is 0, needs > 0"},
        {experiment + "--dims 2 --steps 0:2:1", "spawnfield: --steps: FROM is 0, needs > 0"},
        {experiment + "--dims 2 --steps 1:2:0", "spawnfield: --steps: BY is 0, needs > 0"},
        {experiment + "--dims 2 --steps 2:1:0.5", "spawnfield: --steps: TO is 1, needs at least FROM"},
        {experiment + "--dims 2 --steps 1:2:0.00001",
         "spawnfield: --steps: number of steps is 100001, needs at most 10000"},
        {experiment + "--dims 3 --steps 1:3:1 --steps-z 1:2:1",
         "spawnfield: --steps-z has 2 steps, needs 1 or as many as --steps: 3"},
        {experiment + "--dims 2 --steps 1 --runs 0", "spawnfield: --runs is 0, needs >= 1"},
        {experiment + "--dims 2 --steps 1 --snap",
         "spawnfield: --snap is only for --dims 3: in 2D each pose stands on a layer"},
        {experiment + "--dims 2 --steps 1 -n 5", "spawnfield: -n needs --search"},
        {experiment + "--search", "spawnfield: --search needs -n, the number of spawns"},
        {experiment + "--search -n 5 --steps 1", "spawnfield: --steps is only for rasters, not for --search"},
        {experiment + "--search -n 5 --bounds 0,0,1,1",
         "spawnfield: --bounds has 4 numbers, needs 6: x0,y0,z0,x1,y1,z1"},
        {experiment + "--search -n 5 --max-failures 0", "spawnfield: --max-failures is 0, needs >= 1"},
        {"experiment map --dims 2 --steps 1" + husky, "--out is required" + hint},
        {"frob map",
         "spawnfield: frob is not a command; the commands are bake, info, check, raster, search, sample, heatmap, "
         "review, export, audit, experiment, clean, completion, man"},
        {sample + "-n 5 --seed -1", "--seed: -1 is not a whole number from 0 to 18446744073709551615" + hint},
    };
    for (const Refusal& refusal : refusals) desk.check(refusal, 2);
    for (const std::string arguments :
         {"fly map", "raster map --dims 4 --step 1", "raster map --dims 2 --step x", "sample map -n many",
          "sample map -n 5 --format xml", "info map --threads -1", "heatmap map -o out --size 20",
          "check map --poses poses.csv --collision guess"}) {
        CAPTURE(arguments);
        const ProgramRun run = run_program(
            desk, arguments + (arguments.starts_with("raster") || arguments.starts_with("sample") ||
                                       arguments.starts_with("heatmap") || arguments.starts_with("check")
                                   ? husky
                                   : ""));
        CHECK(run.status == 2);
        CHECK(run.err.size() > 20);
        CHECK(run.out.empty());
    }
    desk.check_untouched();
}

TEST_CASE("refused input ends with status 4, and the message names file, place, value and limit; no output changes")
{
    Desk desk;
    desk.write("no_terrain.yaml", "format: spawnfield-scene/1\nparts: [{name: b, sphere: 1}]\n");
    desk.write("typo.yaml", "format: spawnfield-scene/1\nparts:\n  - {name: b, spere: 1}\n");
    desk.write("label.yaml", "format: spawnfield-scene/1\nparts:\n  - {name: b, label: lava, sphere: 1}\n");
    desk.write("nan.obj", "o a\nv 0 0 nan\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    desk.write("robot.yaml", "format: spawnfield-robot/1\nparts: []\n");
    desk.write("word.csv", "x,y,z\n1,2,3\n1,two,3\n");
    desk.write("column.csv", "x,z\n1,2\n");
    desk.write("upper.csv", "X,Y,Z\n1,2,3\n");
    std::filesystem::create_symlink("/dev/zero", desk / "endless.yaml");
    desk.remember();
    const std::string keys =
        "box, sphere, cylinder, capsule, plane, mesh, heightmap, octomap, name, label, path, xyz, rpy, rpy_deg, up, "
        "scale, "
        "solid, "
        "sides, labels, auto_label, unknown";
    const std::string needed_header =
        ", needs a header with x,y,z; roll,pitch,yaw (or roll_deg,pitch_deg,yaw_deg, or qx,qy,qz,qw) are optional";
    const Refusal refusals[] = {
        {"bake none.yaml -o map", "spawnfield: none.yaml: does not exist; is the path right?"},
        {"bake no_terrain.yaml -o map",
         "spawnfield: no_terrain.yaml: has no terrain, so no robot can stand anywhere; label a part `terrain` "
         "(--label 'GLOB=terrain') or pass --allow-no-terrain"},
        {"bake typo.yaml -o map",
         "spawnfield: typo.yaml: part \"b\": spere is not a known key; known keys: " + keys + " (line 3)"},
        {"bake label.yaml -o new",
         "spawnfield: label.yaml: part \"b\": label is \"lava\", needs one of terrain, "
         "obstacle, water, ignore (line 3)"},
        {"bake nan.obj -q -o new",
         "spawnfield: nan.obj: node \"a\": a vertex is (0, 0, nan), needs finite coordinates"},
        {"bake scene.yaml -o new --bounds 90,0,-1,95,5,1",
         "spawnfield: scene.yaml: bounds are 90, 0, -1 to 95, 5, 1 m, need to meet the scene: -4, -4, -1 to 4, 4, 1 m"},
        {"check map --poses upper.csv -o out" + husky,
         "spawnfield: upper.csv: line 1: column x is missing (there is X, but names are lower case)" + needed_header},
        {"info typo.yaml",
         "spawnfield: typo.yaml: part \"b\": spere is not a known key; known keys: " + keys + " (line 3)"},
        {"info none", "spawnfield: none: does not exist; is the path right?"},
        {"info endless.yaml", "spawnfield: endless.yaml: is a device, needs a regular file"},
        {"bake endless.yaml -o new", "spawnfield: endless.yaml: is a device, needs a regular file"},
        {"check map --poses none.csv -o out" + husky, "spawnfield: none.csv: does not exist; is the path right?"},
        {"check map --poses word.csv -o out" + husky,
         "spawnfield: word.csv: line 3: column y is \"two\", needs a number"},
        {"check map --poses column.csv -o out" + husky,
         "spawnfield: column.csv: line 1: column y is missing" + needed_header},
        {"check map --poses poses.csv -o out --robot robot.yaml",
         "spawnfield: robot.yaml: parts is empty, needs at least one part (line 2)"},
        {"check none --poses poses.csv -o out" + husky, "spawnfield: none: does not exist; is the path right?"},
        {"raster none -o out --dims 2 --step 1" + husky, "spawnfield: none: does not exist; is the path right?"},
        {"sample none -o out -n 5" + husky, "spawnfield: none: does not exist; is the path right?"},
        {"search scene.yaml -o out -n 5 --min-distance 0" + husky,
         "spawnfield: scene.yaml: is a file, and a map is a folder; bake a scene first: spawnfield bake scene.yaml -o "
         "MAP"},
        {"experiment none -o new --dims 2 --steps 1" + husky, "spawnfield: none: does not exist; is the path right?"},
        {"heatmap none -o out" + husky, "spawnfield: none: does not exist; is the path right?"},
        {"heatmap map -o out --spawns word.csv" + husky,
         "spawnfield: word.csv: line 3: column y is \"two\", needs a number"},
        {"sample map -o out -n 5 --robot none.urdf",
         "spawnfield: none.urdf: does not exist; a robot is a robot.yaml, a .urdf, an SDF model (.sdf or its folder) "
         "or box:LX,LY,LZ[@x,y,z]"},
    };
    for (const Refusal& refusal : refusals) desk.check(refusal, 4);
}

TEST_CASE("every command refuses a damaged map and names the file")
{
    Desk desk;
    const std::string queries[] = {"info map",
                                   "check map --poses poses.csv -o out" + husky,
                                   "raster map -o out --dims 2 --step 1" + husky,
                                   "search map -o out -n 1 --min-distance 0" + husky,
                                   "sample map -o out -n 1" + husky,
                                   "heatmap map -o out" + husky};
    const std::string good = bytes_of(desk / "map/geometry.bin");
    std::string bad = good;
    bad[40] = char(bad[40] ^ 4);
    desk.write("map/geometry.bin", bad);
    for (const std::string& query : queries)
        desk.check({query,
                    "spawnfield: map/geometry.bin: is damaged (the checksum of its head differs from the one in "
                    "map.yaml); bake the map again"},
                   4);
    bad = good;
    bad[bad.size() / 2] = char(bad[bad.size() / 2] ^ 4);
    desk.write("map/geometry.bin", bad);
    desk.check({"raster map -o out --dims 2 --step 1" + husky,
                "spawnfield: map/geometry.bin: is damaged (tile 0 of level 0 has another checksum than the head of the "
                "file lists); bake the map again"},
               4);
    desk.check({"info map --verify",
                "spawnfield: map/geometry.bin: was altered: its checksum differs from the one in map.yaml; bake the "
                "map again"},
               4);
    desk.write("map/geometry.bin", good);

    const std::string tree = bytes_of(desk / "map/occupancy.bt");
    bad = tree;
    bad.back() = char(bad.back() ^ 1);
    desk.write("map/occupancy.bt", bad);
    const std::string altered =
        "spawnfield: map/occupancy.bt: was altered: its checksum differs from the one in map.yaml; bake the map again";
    desk.check({"check map --poses poses.csv -o out --collision octree" + husky, altered}, 4);
    desk.check({"info map --verify", altered}, 4);
    desk.write("map/occupancy.bt", tree);

    const std::string yaml = bytes_of(desk / "map/map.yaml");
    desk.write("map/map.yaml", "format: spawnfield-map/99" + yaml.substr(yaml.find('\n')));
    for (const std::string& query : queries)
        desk.check({query,
                    "spawnfield: map/map.yaml: has format version 99, this program reads 2 to 9; bake the map again "
                    "or use a newer spawnfield"},
                   4);
}

TEST_CASE("output that cannot be written ends with status 1, and nothing remains of it")
{
    Desk desk;
    const std::string sample = "sample map -n 1 -q" + husky;
    desk.check(
        {sample + "-o none/spawns.csv", "spawnfield: none/spawns.csv: cannot be written: No such file or directory"},
        1);
    fs::create_directory(desk / "empty");
    desk.remember();
    desk.check({sample + "-o empty", "spawnfield: empty: cannot be written: is a folder"}, 1);
    desk.check({sample + "-o /dev/full", "spawnfield: /dev/full: cannot be written: No space left on device"}, 1);
    const ProgramRun full = run_program(desk, sample + ">/dev/full 2>err || (cat err >&2; rm err; exit 1)");
    CHECK(full.status == 1);
    CHECK(full.err == "spawnfield: standard output: cannot be written: No space left on device\n");
    desk.check(
        {"bake scene.yaml -q -o out", "spawnfield: out: exists and is not a map; choose another name or remove it"}, 1);
    const std::string raster = "raster map -q --dims 2 --step 1" + husky;
    desk.check({raster + "-o /dev/full --heatmap new.png",
                "spawnfield: /dev/full: cannot be written: No space left on device"},
               1);
    desk.check({"experiment map -q --dims 2 --steps 1 -o out" + husky,
                "spawnfield: out: exists and is not a folder; choose another name or remove it"},
               1);
    desk.write("other/diary", "mine");
    desk.remember();
    desk.check({"experiment map -q --dims 2 --steps 1 -o other" + husky,
                "spawnfield: other: contains diary, which is not part of any former experiment; choose another name "
                "or remove it"},
               1);
    desk.check({raster + "-o new.csv --heatmap none/new.png",
                "spawnfield: none/new.png: cannot be written: No such file or directory"},
               1);
}

TEST_CASE("a summary that cannot be written is reported before all work, and nothing is written")
{
    const Desk desk;
    const std::string message = "spawnfield: none/s.json: cannot be written: No such file or directory";
    for (const std::string& arguments :
         {std::string("bake scene.yaml -o new"), std::string("info map"), "check map --poses poses.csv -o out" + husky,
          "raster map -o out --dims 2 --step 1" + husky, "sample map -o out -n 1" + husky,
          "search map -o out -n 1" + husky, "heatmap map -o out" + husky,
          "experiment map -o new --dims 2 --steps 1" + husky})
        desk.check({arguments + " --summary none/s.json", message}, 1);
}

TEST_CASE("control characters of files reach the terminal as codes, and unreachable files have status 4")
{
    const TempFolder folder;
    folder.write("a.obj", "o \x1b[31mred\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    const ProgramRun run = run_program(folder, "bake a.obj -o map --label none=terrain");
    CHECK_THAT(run.err, Contains("there are \\x1b[31mred, DefaultMaterial"));
    CHECK(run.err.find('\x1b') == std::string::npos);
    folder.write("names.yaml",
                 "format: spawnfield-scene/1\nname: \"w\\e[31m\\nfine\"\n"
                 "parts: [{name: \"a\\e[2J\\nb\", label: terrain, box: [1, 1, 1]}]\n");
    const std::string text = run_program(folder, "info names.yaml").out;
    CHECK_THAT(text, Contains("scene w\\x1b[31m\\x0afine\n"));
    CHECK_THAT(text, Contains("  a\\x1b[2J\\x0ab: box"));
    CHECK(text.find('\x1b') == std::string::npos);

    fs::create_symlink("loop", folder / "loop");
    const ProgramRun loop = run_program(folder, "info loop");
    CHECK(loop.status == 4);
    CHECK(loop.err == "spawnfield: loop: cannot be reached: Too many levels of symbolic links\n");
    const ProgramRun name = run_program(folder, "info " + std::string(300, 'a'));
    CHECK(name.status == 4);
    CHECK_THAT(name.err, Contains("aaa: cannot be reached: File name too long"));
    folder.write("a.yaml", "format: spawnfield-scene/1\nparts: [{name: a, label: terrain, box: [4, 4, 1]}]\n");
    const ProgramRun bake = run_program(folder, "bake a.yaml -q -o map --summary /dev/full");
    CHECK(bake.status == 1);
    CHECK(bake.err ==
          "spawnfield: --summary /dev/full: cannot be written: No space left on device; the result itself is "
          "complete\n");
    CHECK(run_program(folder, "info map").status == 0);
    for (const char* const answer : {"--help", "sample --help", "--version", "man"}) {
        const ProgramRun full = run_program(folder, std::string(answer) + " 2>err >/dev/full || (cat err >&2; exit 1)");
        CHECK(full.status == 1);
        CHECK(full.err == "spawnfield: standard output: cannot be written: No space left on device\n");
    }
}

TEST_CASE("an output that would destroy an input or another output is refused before all work")
{
    Desk desk;
    desk.write("rules.yaml", "max_islands: 9\n");
    desk.write("fleet.yaml", "robots: []\n");
    desk.write("kept/scene.yaml", bytes_of(desk / "scene.yaml"));
    desk.write("world.sdf", "<sdf/>");
    fs::create_symlink("poses.csv", desk / "link.csv");
    fs::create_hard_link(desk / "poses.csv", desk / "hard.csv");
    fs::copy(desk / "map", desk / "kept", fs::copy_options::recursive);
    desk.write("robot.yaml", bytes_of(source_folder() + "/maps/robots/husky.yaml"));
    desk.remember();
    const std::string sample = "sample map -n 1" + husky, check = "check map --poses poses.csv" + husky,
                      same = "the same file as ", other = ", which is read; choose another name for the output",
                      inside = ", which lies in the folder map that is read as the map; choose a name outside of it";
    const std::string before_poses = bytes_of(desk / "poses.csv"), before_map = bytes_of(desk / "map/map.yaml"),
                      before_kept = bytes_of(desk / "kept/occupancy.bt");
    const Refusal refusals[] = {
        {check + "-o poses.csv", "--out is poses.csv, " + same + "--poses" + other},
        {check + "-o link.csv", "--out is link.csv, " + same + "--poses" + other},
        {check + "-o hard.csv", "--out is hard.csv, " + same + "--poses" + other},
        {check + "-o ./map/../poses.csv", "--out is ./map/../poses.csv, " + same + "--poses" + other},
        {check + "-o out --repair 1 --repaired poses.csv", "--repaired is poses.csv, " + same + "--poses" + other},
        {check + "-o out --summary poses.csv", "--summary is poses.csv, " + same + "--poses" + other},
        {"check map --pairs poses.csv -o poses.csv" + husky, "--out is poses.csv, " + same + "--pairs" + other},
        {sample + "-o map/map.yaml", "--out is map/map.yaml" + inside},
        {sample + "-o map/new/spawns.csv", "--out is map/new/spawns.csv" + inside},
        {sample + "-o out --summary map/s.json", "--summary is map/s.json" + inside},
        {sample + "-o map", "--out is map, the same folder as the map" + other},
        {sample + "-o map/", "--out is map/, the same folder as the map" + other},
        {sample + "--avoid poses.csv -o poses.csv", "--out is poses.csv, " + same + "--avoid" + other},
        {sample + "--avoid hard.csv --avoid link.csv -o poses.csv", "--out is poses.csv, " + same + "--avoid" + other},
        {sample + "--region poses.csv -o poses.csv", "--out is poses.csv, " + same + "--region" + other},
        {sample + "--keep-out poses.csv -o poses.csv", "--out is poses.csv, " + same + "--keep-out" + other},
        {sample + "--with scene.yaml -o scene.yaml", "--out is scene.yaml, " + same + "--with" + other},
        {sample + "--with robot.yaml@1,1,0 -o robot.yaml", "--out is robot.yaml, " + same + "--with" + other},
        {sample + "--world world.sdf --format sdf -o world.sdf", "--out is world.sdf, " + same + "--world" + other},
        {sample + "--robot-file robot.yaml --format sdf -o robot.yaml",
         "--out is robot.yaml, " + same + "--robot-file" + other},
        {"sample map --robot robot.yaml -n 1 -o robot.yaml", "--out is robot.yaml, " + same + "--robot" + other},
        {"sample map --fleet fleet.yaml -o fleet.yaml", "--out is fleet.yaml, " + same + "--fleet" + other},
        {sample + "--pairs 1 -o out --path map/paths.csv", "--path is map/paths.csv" + inside},
        {sample + "-o out --summary out",
         "--out and --summary are the same file, out; choose another name for one of "
         "them"},
        {sample + "-o out --summary ./out",
         "--out and --summary are the same file, ./out; choose another name for one "
         "of them"},
        {"raster map --dims 2 --step 1 -o out --heatmap out" + husky,
         "--out and --heatmap are the same file, out; choose another name for one of them"},
        {"raster map --dims 2 --step 1 --heatmap map/preview.png" + husky, "--heatmap is map/preview.png" + inside},
        {"heatmap map --spawns poses.csv -o poses.csv" + husky, "--out is poses.csv, " + same + "--spawns" + other},
        {"export map --format nav2 -o map/map.yaml" + husky, "--out is map/map.yaml" + inside},
        {"export map --format nav2 -o new.yaml --summary new.pgm" + husky,
         "--summary and the image of --out are the same file, new.pgm; choose another name for one of them"},
        {"experiment map --dims 2 --steps 1 -o map" + husky, "--out is map, the same folder as the map" + other},
        {"experiment map --dims 2 --steps 1 -o ." + husky,
         "--out is ., a folder that contains map, which is read as the map; choose another name for the output"},
        {"audit scene.yaml --rules rules.yaml -o rules.yaml" + husky,
         "--out is rules.yaml, " + same + "--rules" + other},
        {"audit scene.yaml -o scene.yaml" + husky, "--out is scene.yaml, " + same + "the scene" + other},
        {"info robot.yaml --picture robot.yaml", "--picture is robot.yaml, " + same + "the input" + other},
        {"bake scene.yaml -o scene.yaml", "--out is scene.yaml, " + same + "the scene" + other},
        {"bake kept/occupancy.bt -o kept",
         "--out is kept, a folder that contains kept/occupancy.bt, which is read as "
         "the scene; choose another name for the output"},
    };
    for (const Refusal& refusal : refusals) desk.check({refusal.arguments, "spawnfield: " + refusal.message}, 2);
    CHECK(bytes_of(desk / "poses.csv") == before_poses);
    CHECK(bytes_of(desk / "map/map.yaml") == before_map);
    CHECK(bytes_of(desk / "kept/occupancy.bt") == before_kept);
}

TEST_CASE("outputs that destroy nothing are not refused")
{
    const Desk desk;
    desk.write("kept/scene.yaml", bytes_of(desk / "scene.yaml"));
    fs::copy(desk / "map", desk / "kept", fs::copy_options::recursive);
    const std::string scene = bytes_of(desk / "kept/scene.yaml");
    for (const std::string& arguments :
         {std::string("bake kept/scene.yaml -o kept --resolution 0.5"),
          std::string("bake kept/scene.yaml -o kept --resolution 0.5 --update '*'"),
          std::string("bake scene.yaml -o map --resolution 0.5 --update floor"),
          std::string("bake scene.yaml -o map --resolution 0.5 --summary map/s.json"),
          "check map --poses poses.csv -o /dev/null --summary /dev/null" + husky,
          "check map --poses poses.csv -o map.csv" + husky, "check map --poses poses.csv -o mapped/../o.csv" + husky}) {
        CAPTURE(arguments);
        const bool has_no_folder = arguments.find("mapped") != std::string::npos;
        CHECK(run_program(desk, arguments + " -q").status == (has_no_folder ? 1 : 0));
    }
    CHECK(bytes_of(desk / "kept/scene.yaml") == scene);
    CHECK(bytes_of(desk / "map/s.json").starts_with("{"));
}
