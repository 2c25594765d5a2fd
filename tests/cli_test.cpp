#include "this_build.h"
#include "arena.h"

#include <spawnfield/map.h>
#include <spawnfield/poses.h>

#include <nlohmann/json.hpp>

#include <opencv2/imgcodecs.hpp>

namespace fs = std::filesystem;
using spawnfield::read_poses;

namespace {

const std::string &scene = training_scene, &husky = husky_option;
const std::vector<std::string> commands = {"bake",   "info",    "check",  "raster",    "search",
                                           "sample", "heatmap", "export", "experiment"};

std::size_t lines(const std::string& text) { return std::size_t(std::count(text.begin(), text.end(), '\n')); }

/// Returns the names in the header of a CSV text, followed by the fields of one row, counted from 1.
std::string row(const std::string& csv, std::size_t number)
{
    std::istringstream stream(csv);
    std::string line;
    for (std::size_t i = 0; i <= number; ++i) std::getline(stream, line);
    return line;
}

/// Reads a summary, and checks that it has all documented entries.
nlohmann::json summary(const fs::path& file, const std::string& command)
{
    const auto json = nlohmann::json::parse(bytes_of(file));
    CHECK(json["command"] == command);
    for (const char* key : {"poses", "exact_checks", "peak_memory_bytes", "threads", "seed"})
        CHECK(json.at(key).is_number_unsigned());
    for (const char* key : {"load", "query", "mask", "exact", "write", "total"}) {
        CHECK(json.at("seconds").at(key).is_number());
        CHECK(json["seconds"][key] >= 0.0);
    }
    CHECK(json["seconds"]["load"].get<double>() + json["seconds"]["query"].get<double>() +
              json["seconds"]["write"].get<double>() ==
          Approx(json["seconds"]["total"].get<double>()));
    CHECK(json.at("counts").is_object());
    CHECK(json.at("map_hash").is_string());
    CHECK(json.at("version") == spawnfield::version());
    CHECK(json["peak_memory_bytes"] > 1000000);
    return json;
}

}  // namespace

TEST_CASE("every command has help with an example, and the program prints its version")
{
    const TempFolder folder;
    for (const std::string& command : commands) {
        const ProgramRun run = run_program(folder, command + " --help");
        CHECK(run.status == 0);
        CHECK(run.err.empty());
        const std::size_t example = run.out.find("Example:");
        REQUIRE(example != std::string::npos);
        CHECK(run.out.find("spawnfield " + command + " ", example) != std::string::npos);
        const std::size_t group = run.out.find("\nOutput and run:\n");  // common options come before all groups
        CHECK(run.out.find("\nOptions:\n") < group);
        CHECK(group < run.out.find("--threads"));
        std::istringstream help(run.out.substr(0, example));
        for (std::string line; std::getline(help, line);) CHECK(line.size() <= 120);
    }
    CHECK(run_program(folder, "--help").status == 0);
    const ProgramRun version = run_program(folder, "--version");
    CHECK(version.status == 0);
    CHECK(version.out.starts_with(spawnfield::version() + "\n"));
}

TEST_CASE("every example works after the steps of the README, and does not change their files", "[slow]")
{
    const TempFolder folder;  // stands for /tmp and for the source folder
    fs::create_symlink(program_file(), folder / "spawnfield");
    fs::create_symlink(source_folder() + "/maps", folder / "maps");
    for (const char* const name : {"poses.csv", "spawns.csv", "raster.csv"}) folder.write(name, "mine");
    for (const std::string& command : commands) {
        const std::string help = run_program(folder, command + " --help").out;
        std::string script = help.substr(help.find("Example:") + 8);
        for (std::size_t at = script.find("/tmp/"); at != std::string::npos; at = script.find("/tmp/"))
            script.erase(at, 5);
        INFO(script);
        CHECK(run_program(folder, "--version && set -e && PATH=$PWD:$PATH\n" + script).status == 0);
    }
    for (const char* const name : {"poses.csv", "spawns.csv", "raster.csv"}) CHECK(bytes_of(folder / name) == "mine");
}

TEST_CASE("bake writes a map, prints what it made, and writes its summary")
{
    const TempFolder folder;
    const ProgramRun run = run_program(folder, "bake " + scene + " -o deep/map --resolution 0.25 --summary s.json");
    CHECK(run.status == 0);
    CHECK(run.out.empty());
    CHECK_THAT(run.err, Contains("spawnfield bake: deep/map; 2 layers, "));
    CHECK(lines(run.err) == 1);
    const auto json = summary(folder / "s.json", "bake");
    const spawnfield::Map map = spawnfield::read_map(folder / "deep/map");
    CHECK(json["map_hash"] == map.hash);
    CHECK(map.resolution == 0.25);
    for (const char* stage : {"geometry", "terrain", "occupancy"}) CHECK(json["seconds"].at(stage) >= 0.0);
}

TEST_CASE("bake passes its options to the library")
{
    const TempFolder folder;
    folder.write("a.obj", "o road\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\no house\nv 0 0 1\nv 1 0 1\nv 0 1 1\nf 4 5 6\n");
    CHECK(run_program(
              folder,
              "bake a.obj -o map --scale 2 --up y --label 'ro*=terrain' --resolution 0.5 --occupancy-resolution 0.5 "
              "--bounds -1,-4,-1,3,1,5")
              .status == 0);
    const spawnfield::Map map = spawnfield::read_map(folder / "map");
    CHECK(map.bounds.min == spawnfield::Vec3(-1, -4, -1));
    CHECK(map.bounds.max == spawnfield::Vec3(3, 1, 5));
    CHECK(map.occupancy_resolution == 0.5);
    // With y up and twice the size, the triangles are upright.
    const spawnfield::Column column = column_at(map.geometry, 0.2, -0.1);
    CHECK(column.spans.empty());
    CHECK(map.geometry.labels()[std::size_t(spawnfield::Label::Terrain)].triangles == 1);
    CHECK(map.geometry.labels()[std::size_t(spawnfield::Label::Obstacle)].triangles == 1);
    const spawnfield::CollisionChecker checker(map.geometry, spawnfield::load_robot("box:0.1,0.1,0.1@0,0,0"));
    CHECK_FALSE(checker.is_free({spawnfield::Vec3(1.9, 0, 0.05), spawnfield::Mat3::Identity()}));
    CHECK(checker.is_free({spawnfield::Vec3(2.1, 0, 0.05), spawnfield::Mat3::Identity()}));
    const ProgramRun plain = run_program(folder, "bake a.obj -o map --quiet");
    CHECK(plain.status == 0);
    CHECK(plain.err.empty());
    CHECK_THAT(run_program(folder, "bake a.obj -o map").err,
               Contains("notice: a.obj: no label is given, so everything is terrain"));
    CHECK_THAT(run_program(folder, "bake a.obj -o map --bounds 0.8,0.8,0,3,3,1").err,
               Contains("notice: no robot can stand in the bounds 0.8, 0.8, 0 to 3, 3, 1 m: there is no terrain at any "
                        "cell's centre; the scene is "
                        "0, 0, 0 to 1, 1, 1 m\n"));
    CHECK(run_program(folder, "bake a.obj -o map --label '*=obstacle'").status == 4);
    CHECK(run_program(folder, "bake a.obj -o map --label '*=obstacle' --allow-no-terrain").status == 0);
}

TEST_CASE("a bake over a map replaces it but keeps foreign files; a folder that is not a map stays as it is")
{
    const Arena arena;
    const std::string before = bytes_of(arena / "map/map.yaml");
    CHECK(arena("bake " + scene + " -o map --resolution 0.5").status == 0);
    CHECK(spawnfield::read_map(arena / "map").resolution == 0.5);
    CHECK(bytes_of(arena / "map/map.yaml") != before);
    CHECK(arena.names() == std::set<std::string>{"map"});

    arena.write("map/spawns.csv", "mine");
    arena.write("map/notes/today.txt", "mine too");
    arena.write("map/preview.png", "not mine");
    CHECK(arena("bake " + scene + " -o map --resolution 0.25").status == 0);
    CHECK(spawnfield::read_map(arena / "map").resolution == 0.25);
    CHECK(bytes_of(arena / "map/spawns.csv") == "mine");
    CHECK(bytes_of(arena / "map/notes/today.txt") == "mine too");
    CHECK(arena.names() == std::set<std::string>{"map"});
    CHECK_THAT(arena("info map --verify").out, Contains("all files match"));

    arena.write("work/thesis.tex", "years");
    const ProgramRun run = arena("bake " + scene + " -o work");
    CHECK(run.status == 1);
    CHECK(run.err == "spawnfield: work: exists and is not a map; choose another name or remove it\n");
    CHECK(bytes_of(arena / "work/thesis.tex") == "years");
    CHECK(arena.names() == std::set<std::string>{"map", "work"});
}

TEST_CASE("info describes maps, scenes and robots, as text or JSON")
{
    const Arena arena;
    const auto map = nlohmann::json::parse(arena("info map --json --verify").out);
    CHECK(map["kind"] == "map");
    CHECK(map["layers"] == 2);
    CHECK(map["verified"] == true);
    CHECK(map["hash"] == spawnfield::read_map(arena / "map").hash);
    CHECK(map["parts"].size() == 16);
    CHECK_THAT(arena("info map --verify").out, Contains("all files match their checksums"));

    const auto described = nlohmann::json::parse(arena("info " + scene + " --json").out);
    CHECK(described["kind"] == "scene");
    CHECK(described["labels"]["terrain"]["primitives"] == 5);
    CHECK(described["bounds"]["max"][0].get<double>() == Approx(10.1));
    const auto robot = nlohmann::json::parse(arena("info box:1,2,3 --json").out);
    CHECK(robot["kind"] == "robot");
    CHECK(robot["bounds"]["max"] == std::vector<double>{0.5, 1, 3});
    CHECK_THAT(arena("info '" + source_folder() + "/maps/robots/husky.yaml'").out,
               Contains("robot husky\n  from  -0.495, -0.335, 0 m"));
    CHECK(arena("info map --summary s.json").status == 0);
    summary(arena / "s.json", "info");
}

TEST_CASE("info reports that a house with a missing face is a shell")
{
    const TempFolder folder;
    const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n", faces = "f 1 3 2\nf 1 2 4\nf 2 3 4\n";
    folder.write("closed.obj", corners + faces + "f 1 4 3\n");
    folder.write("open.obj", corners + faces);
    CHECK_THAT(run_program(folder, "info closed.obj").out,
               Contains("\nparts: 1 solid\n  closed: mesh, terrain, 4 triangles, 1 solid\n"));
    CHECK_THAT(run_program(folder, "info open.obj").out,
               Contains("\nparts: 1 with shells (not filled)\n"
                        "  open: mesh, terrain, 3 triangles, 1 shell (without thickness, not filled; 3 open edges)\n"));
    run_program(folder, "bake closed.obj -o map");
    CHECK_THAT(run_program(folder, "info map").out, Contains(" m, 1 layer; voxels of "));
}

TEST_CASE("info lists nodes and materials of meshes with triangles and heights, those with the most triangles first")
{
    const TempFolder folder;
    folder.write("a.obj",
                 "o wall\nv 0 0 0.5\nv 1 0 0.5\nv 0 1 2.25\nusemtl brick\nf 1 2 3\no Floor 1\nv 0 0 -1\nv 1 0 "
                 "-1\nv 0 1 -1\nv 1 1 -1\nusemtl tar\nf 4 5 6\nf 6 5 7\n");
    const ProgramRun run = run_program(folder, "info a.obj --label 'floor*=terrain' --label 'bri*=ignore'");
    CHECK_THAT(
        run.out,
        Contains(
            "names in meshes, for --label\n  node \"Floor 1\", material \"tar\": 2 triangles, z -1 to -1 m, terrain\n"
            "  node \"wall\", material \"brick\": 1 triangle, z 0.5 to 2.25 m, ignore\n"));
    const auto json = nlohmann::json::parse(run_program(folder, "info a.obj --json").out);
    CHECK(json["parts"][0]["names"][0] ==
          nlohmann::json{{"node", "wall"}, {"material", "brick"}, {"triangles", {{"terrain", 1}}}, {"z", {0.5, 2.25}}});
    folder.write("two.yaml",
                 "format: spawnfield-scene/1\nname: two\nparts:\n  - {name: a, mesh: a.obj}\n  - {name: b, "
                 "mesh: a.obj, xyz: [0, 0, 10]}\n");
    CHECK_THAT(run_program(folder, "info two.yaml").out,
               Contains("  a: node \"wall\"") &&
                   Contains("  b: node \"wall\", material \"brick\": 1 triangle, z 10.5 to 12.25 m, obstacle\n"));
    std::string many;
    for (int i = 0; i < 63; ++i) many += "o n" + std::to_string(i) + "\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\n";
    folder.write("many.obj", many);
    CHECK_THAT(run_program(folder, "info many.obj").out,
               Contains("node \"n59\"") && Contains("\n  … and 3 more (--json lists all)\n"));
    CHECK(nlohmann::json::parse(run_program(folder, "info many.obj --json").out)["parts"][0]["names"].size() == 63);
}

TEST_CASE("notices of one kind are printed once, with a count; --json contains all of them")
{
    const TempFolder folder;
    std::string models = "<include><uri>model://ground_plane</uri></include>";
    for (int i = 0; i < 200; ++i)
        models += "<model name='m" + std::to_string(i) +
                  "'><link name='l'><collision name='c'><geometry><mesh><uri>model://lost/" + std::to_string(i) +
                  ".dae</uri></mesh></geometry></collision></link></model>";
    folder.write("a.world", "<sdf version='1.9'><world name='w'>" + models + "</world></sdf>");
    const ProgramRun run = run_program(folder, "info a.world --label 'lost*=terrain' --label 'gone*=water'");
    const auto lines = [](const std::string& text, const std::string& part) {
        std::size_t count = 0;
        for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
        return count;
    };
    CHECK(lines(run.err, "is not found: it is ignored") == 1);
    CHECK_THAT(run.err, Contains("\n  ... and 199 more like it: \"m") && Contains(", ... (`info --json` lists all)\n"));
    CHECK_THAT(run.err, Contains("label \"lost*\" matches no model, link, collision, node or material\n  ... and 1 "
                                 "more like it: \"gone*\"\n"));
    CHECK_THAT(run.err, Contains("the built-in ground plane replaces it\n"));
    CHECK(lines(run.err, "\n") <= 8);
    CHECK(nlohmann::json::parse(run_program(folder, "info a.world --json").out)["notices"].size() > 200);
    CHECK(run_program(folder, "info a.world --quiet").err.empty());
}

TEST_CASE("the program refuses a world with missing includes, and a map of 1 x 1 m gets a notice")
{
    const TempFolder folder;
    folder.write("a.world",
                 "<sdf version='1.9'><world name='w'><include><uri>model://house</uri></include><model "
                 "name='rock'><link name='l'><collision name='c'><geometry>"
                 "<box><size>1 1 1</size></box></geometry></collision></link></model></world></sdf>");
    const ProgramRun refused = run_program(folder, "bake a.world -o map");
    CHECK(refused.status == 4);
    CHECK(refused.err ==
          "spawnfield: a.world: 1 model that it includes is not found; give the folder that contains it "
          "with --model-path, or ignore it with --allow-missing:\n"
          "  line 1: <include> <uri> model://house is not found\n");
    const ProgramRun obstacle = run_program(folder, "bake a.world -o map --allow-missing");
    CHECK(obstacle.status == 4);
    CHECK_THAT(obstacle.err,
               Contains("none of it becomes terrain") && Contains("has no terrain, so no robot can stand anywhere"));
    const ProgramRun small = run_program(folder, "bake a.world -o map --allow-missing --label 'rock=terrain'");
    CHECK(small.status == 0);
    const std::string tiny = "notice: the map is only 1 x 1 m; is a part of the scene missing or in the wrong unit?\n";
    CHECK_THAT(small.err, Contains(tiny));
    CHECK_THAT(
        run_program(folder, "bake a.world -o map --allow-missing --label 'rock=terrain' --bounds -0.5,-0.5,0,0.5,0.5,1")
            .err,
        !Contains(tiny));
    CHECK(run_program(folder, "bake a.world -o map --allow-missing --strict").status == 2);
}

TEST_CASE("info counts solid parts, parts with shells, sheets and parts that are left out, of scenes and maps")
{
    const TempFolder folder;
    folder.write("open.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\n");
    std::string text = "format: spawnfield-scene/1\nname: many\nparts:\n";
    for (int i = 1; i <= 2; ++i) text += "  - {name: s" + std::to_string(i) + ", label: terrain, sphere: 1}\n";
    text += "  - {name: floor, label: terrain, plane: [4, 4]}\n  - {name: old, label: ignore, sphere: 1}\n";
    const auto heading = [&](const std::string& what) {
        const std::string out = run_program(folder, "info " + what).out;
        const std::size_t start = out.find("\nparts: ") + 1;
        return out.substr(start, out.find('\n', start) - start);
    };
    folder.write("few.yaml", text + "  - {name: house, mesh: open.obj}\n");
    const std::string few = "parts: 2 solid, 1 with shells (not filled), 1 sheet, 1 left out";
    CHECK(heading("few.yaml") == few);
    REQUIRE(run_program(folder, "bake few.yaml -o map --resolution 0.5").status == 0);
    CHECK(heading("map") == few);
    for (int i = 3; i <= 60; ++i) text += "  - {name: s" + std::to_string(i) + ", label: terrain, sphere: 1}\n";
    for (int i = 1; i <= 6; ++i) text += "  - {name: h" + std::to_string(i) + ", mesh: open.obj}\n";
    folder.write("many.yaml", text);
    CHECK(heading("many.yaml") ==
          "parts: 60 solid, 6 with shells (not filled: h1, h2, h3, h4, h5, …), 1 sheet, 1 left out");
}

TEST_CASE("info lists the first 60 of many parts")
{
    const TempFolder folder;
    std::string text = "format: spawnfield-scene/1\nname: many\nparts:\n";
    for (int i = 1; i <= 63; ++i) text += "  - {name: part" + std::to_string(i) + ", label: terrain, sphere: 1}\n";
    folder.write("scene.yaml", text);
    const std::string listing = run_program(folder, "info scene.yaml").out;
    CHECK_THAT(listing, Contains("\n  part60: sphere, terrain, 1 solid\n  … and 3 more (--json lists all)\n"));
    CHECK(nlohmann::json::parse(run_program(folder, "info scene.yaml --json").out)["parts"].size() == 63);
}

TEST_CASE("check adds verdicts to its poses, on standard output or in a file")
{
    const Arena arena;
    arena.write("poses.csv",
                "id,x,y,z,yaw\n1,0,0,0.1,0\n2,0,0,5,0\n3,99,0,0.1,0\n4,7.5,-7.5,0.1,0\n5,-2,0,0.1,0\n6,6.5,0,4,0\n7,0,"
                "9.9,0.1,0\n");
    const ProgramRun run = arena("check map --poses poses.csv --max-height 2 --summary s.json" + husky);
    CHECK(run.status == 0);
    CHECK(row(run.out, 0) == "id,x,y,z,yaw,verdict,ground,height_above,hit");
    CHECK(row(run.out, 1) == "1,0,0,0.1,0,valid,-0.05,0.15000000000000002,");
    CHECK(row(run.out, 2) == "2,0,0,5,0,aerial,-0.05,5.05,");
    CHECK_THAT(row(run.out, 3), Contains("3,99,0,0.1,0,outside,,,"));
    CHECK_THAT(row(run.out, 4), Contains(",submerged,-0.05,"));
    CHECK(row(run.out, 5).ends_with(",collision,-0.05,0.15000000000000002,diagonal_wall"));
    CHECK_THAT(row(run.out, 6), Contains(",off_terrain,2.95,"));
    CHECK(row(run.out, 7).ends_with(",wall_north"));
    CHECK_THAT(run.err, Contains("spawnfield check: 7 poses: 1 valid, 2 collision, 1 submerged, 1 off_terrain, 1 "
                                 "aerial, 1 outside; 2 exact checks; "));
    const auto json = summary(arena / "s.json", "check");
    CHECK(json["poses"] == 7);
    CHECK(json["counts"]["collision"] == 2);
    CHECK(json["exact_checks"] == 2);
    CHECK(json["map_hash"] == spawnfield::read_map(arena / "map").hash);

    const ProgramRun file = arena("check map --poses poses.csv --max-height 2 -o out.csv" + husky);
    CHECK(file.out.empty());
    CHECK(bytes_of(arena / "out.csv") == run.out);
    CHECK(arena("check map --poses poses.csv --max-height 2 -o - --quiet --threads 1" + husky).out == run.out);
    const ProgramRun voxels = arena("check map --poses poses.csv --max-height 2 --collision octree" + husky);
    CHECK(voxels.status == 0);
    CHECK(row(voxels.out, 5).ends_with(",occupancy"));
}

TEST_CASE("raster writes the layers of each column, and its counts are those of the rows")
{
    const Arena arena;
    const ProgramRun run = arena("raster map --dims 2 --step 0.5 --offset 0.5 --bounds -10,-10,10,10 --summary s.json" +
                                 husky);
    CHECK(run.status == 0);
    const auto json = summary(arena / "s.json", "raster");
    CHECK(lines(run.out) == json["poses"].get<std::size_t>() + 1);
    CHECK(json["poses"] > 41 * 41);
    std::size_t valid = 0;
    for (std::size_t at = run.out.find(",valid\n"); at != std::string::npos; at = run.out.find(",valid\n", at + 1))
        ++valid;
    CHECK(json["counts"]["valid"] == valid);
    CHECK(valid > 100);
    CHECK(row(run.out, 1).starts_with("-10,-10,0.45,0,0,"));

    CHECK(arena("raster map --dims 2 --step 1 --heatmap a.png" + husky).out.empty());
    CHECK(cv::imread((arena / "a.png").string()).cols > 200);
    const ProgramRun aerial = arena("raster map --dims 3 --step 2 --step-z 0.5 --write-aerial" + husky);
    CHECK(lines(aerial.out) == 1 + 11 * 11 * 13);
    CHECK_THAT(aerial.out, Contains(",aerial\n"));
    CHECK(arena("raster map --dims 2 --step 1 --layers 7" + husky).out == "x,y,z,yaw,layer,verdict\n");
}

TEST_CASE("raster --snap gives each layer a pose at --offset above it")
{
    const Arena arena;
    const std::string command = "raster map --dims 3 --step 2 --step-z 2.5 --bounds -10,-10,-0.1,10,10,5 ";
    const ProgramRun run = arena(command + "--snap --offset 0.25" + husky);
    CHECK(run.status == 0);
    CHECK_THAT(run.err, !Contains("notice"));
    CHECK_THAT(run.out, Contains(",0.2,0,0,valid\n"));  // the floor is at -0.05
    CHECK_THAT(arena(command + husky).out, !Contains(",valid"));
    CHECK_THAT(arena(command + "--snap --offset 0.26 --robot box:0.5,0.5,0.5@0,0,0").err,
               !Contains("collides with all flat ground"));
    CHECK_THAT(arena(command + "--snap --robot box:0.5,0.5,0.5@0,0,0").err, Contains("offset 0.35 m (auto)"));
    CHECK_THAT(arena(command + "--snap --offset 0.25 --robot box:0.5,0.5,0.5@0,0,0").err,
               Contains("notice: at --offset 0.25 m the robot collides with all flat ground"));
}

TEST_CASE("sample and search find as many spawns as requested, the same with any number of threads")
{
    const Arena arena;
    for (const std::string command : {"sample map -n 40 --min-distance 0.5 --yaw random --seed 9 --stance level",
                                      "search map -n 40 --min-distance 0.1 --max-failures 100000 --seed 9"}) {
        const ProgramRun run = arena(command + " --threads 1 -o spawns.csv --summary s.json" + husky);
        CHECK(run.status == 0);
        CHECK(run.out.empty());
        CHECK_THAT(run.err, Contains("40 of 40 spawns"));
        CHECK(read_poses(arena / "spawns.csv").poses.size() == 40);
        CHECK(row(bytes_of(arena / "spawns.csv"), 0) == "x,y,z,roll,pitch,yaw");
        CHECK(arena(command + " --threads 2" + husky).out == bytes_of(arena / "spawns.csv"));
        const auto json = summary(arena / "s.json", command.substr(0, 6));
        CHECK(json["seed"] == 9);
        CHECK(json["threads"] == 1);
        CHECK(json["counts"]["valid"] == 40);
        const ProgramRun checked = arena("check map --poses spawns.csv --quiet" + husky);
        CHECK(lines(checked.out) == 41);
        CHECK(checked.out.find(",collision") == std::string::npos);
    }
    const auto json = nlohmann::json::parse(arena("sample map -n 3 --format json" + husky).out);
    CHECK(json["poses"].size() == 3);
    CHECK(json["full"] == false);
    CHECK(json["undecided_area"] == 0.0);
}

TEST_CASE("fewer spawns than requested end with status 3, and those found are written")
{
    const Arena arena;
    const ProgramRun run = arena("sample map -n 50 --min-distance 15 --stance level -o spawns.csv --summary s.json" +
                                 husky);
    CHECK(run.status == 3);
    const std::size_t found = read_poses(arena / "spawns.csv").poses.size();
    CHECK(found > 0);
    CHECK(found < 10);
    CHECK_THAT(run.err, Contains(std::to_string(found) + " of 50 spawns"));
    const auto report = summary(arena / "s.json", "sample");
    CHECK(report["counts"]["valid"] >= found);
    CHECK(report["full"] == true);
    const double mask = report["seconds"]["mask"], exact = report["seconds"]["exact"],
                 query = report["seconds"]["query"];
    CHECK((mask > 0 && exact > 0 && mask + exact <= query));
    CHECK(report["undecided_area"] == 0.0);
    CHECK(nlohmann::json::parse(
              arena("sample map -n 50 --min-distance 15 --stance level --format json" + husky).out)["full"] == true);
    CHECK(arena("search map -n 5 --min-distance 100 --max-failures 50 --summary s.json" + husky).status == 3);
    CHECK_FALSE(summary(arena / "s.json", "search").contains("full"));
}

TEST_CASE("sample gives a notice if many poses are where the scene has ground twice")
{
    const TempFolder folder;
    const auto sample = [&](const std::string& upper, const std::string& options) {
        folder.write("scene.yaml",
                     "format: spawnfield-scene/1\nparts:\n  - {name: low, label: terrain, plane: [10, 10]}\n"
                     "  - {name: high, label: terrain, plane: " +
                         upper + "}\n");
        REQUIRE(run_program(folder, "bake scene.yaml -o map --resolution 0.5").status == 0);
        const ProgramRun run = run_program(folder, "sample map -n 200 --robot box:0.4,0.4,0.3 --stance " + options);
        CHECK(run.status == 0);
        return run.err;
    };
    const std::string cause =
        " judged poses are on a layer with another layer at most 0.1 m above it (ground twice in one place); there a "
        "robot collides";
    const std::string remedy = "; --layers top uses only the highest layer of each place, which takes less time\n",
                      notice = cause + ", or is less than --offset above the ground" + remedy;
    const std::string twice = "[10, 10], xyz: [0, 0, 0.06]";
    CHECK_THAT(sample(twice, "level"), Contains(notice) && Contains(" 200 valid; "));
    CHECK_THAT(sample(twice, "level --offset 0.02"), Contains(notice) && Contains(" collision; "));
    CHECK_THAT(sample(twice, "settled"), Contains(cause + remedy) && Contains(" collision; "));
    CHECK_THAT(sample(twice, "level --layers top"), !Contains("notice"));
    CHECK_THAT(sample("[10, 10], xyz: [0, 0, 0.3]", "level"), !Contains("notice"));  // a deck with a low space below it
    CHECK_THAT(sample("[2, 2], xyz: [0, 0, 0.06]", "level"), !Contains("notice"));   // few poses
}

TEST_CASE("an option that has no effect gets a notice, and changes nothing")
{
    const Arena arena;
    const std::array<std::string, 2> idle[] = {{"raster map --dims 2 --step 2", "--step-z 1"},
                                               {"raster map --dims 3 --step 2", "--offset 0.7"}};
    for (const auto& [command, option] : idle) {
        INFO(command + " " + option);
        const ProgramRun run = arena(command + " " + option + husky);
        CHECK(run.err.starts_with("notice: " + option.substr(0, option.find(' ')) + " has no effect: "));
        CHECK(run.status == 0);
        CHECK(run.out == arena(command + husky).out);
    }
    CHECK_THAT(arena("raster map --dims 3 --step 2 --no-height-check --layers 0" + husky).err,
               Contains("notice: --layers has no effect: "));
    CHECK_THAT(arena("raster map --dims 3 --step 2 --no-height-check --max-slope 9" + husky).err,
               Contains("notice: --max-slope has no effect: "));
}

TEST_CASE("with --max-slope every command examines how valid poses stand, without it none does")
{
    const TempFolder folder;
    folder.write("scene.yaml",
                 "format: spawnfield-scene/1\nname: steps\nparts:\n  - {name: floor, label: terrain, box: [10, 10, 1], "
                 "xyz: [0, 0, -0.5]}\n"
                 "  - {name: beam, label: terrain, box: [6, 0.3, 0.2], xyz: [0, 0, 3]}\n"
                 "  - {name: ramp, label: terrain, box: [3, 8, 0.1], xyz: [3, 0, 0.5], rpy_deg: [0, -20, 0]}\n");
    folder.write("poses.csv", "x,y,z\n-3,3,0.1\n3,3,1.1\n-1,0,3.2\n");
    CHECK(run_program(folder, "bake scene.yaml -o map").status == 0);
    const ProgramRun asked = run_program(folder, "check map --poses poses.csv --max-slope 15 --summary s.json" + husky);
    CHECK_THAT(row(asked.out, 1), Contains(",valid,"));
    CHECK_THAT(row(asked.out, 2), Contains(",steep,"));
    CHECK_THAT(row(asked.out, 3), Contains(",unstable,"));
    CHECK_THAT(asked.err, Contains(" 3 poses: 1 valid, 1 unstable, 1 steep; "));
    CHECK(summary(folder / "s.json", "check")["counts"]["steep"] == 1);
    CHECK_THAT(run_program(folder, "check map --poses poses.csv" + husky).err, Contains(" 3 poses: 3 valid; "));
    CHECK_THAT(run_program(folder, "check map --poses poses.csv --max-slope 21" + husky).err,
               Contains(" 3 poses: 2 valid, 1 unstable; "));

    for (const std::string command :
         {"raster map --dims 2 --step 0.2 --offset 0.6", "raster map --dims 3 --step 0.4 --step-z 0.1",
          "heatmap map --step 0.2 --stance level --offset 0.6 -o map.png",
          "sample map -n 200 --stance level --offset 0.6", "search map -n 50 --max-failures 3000"}) {
        INFO(command);
        CHECK_THAT(run_program(folder, command + " --max-slope 15" + husky).err,
                   Contains(" steep") && Contains(" unstable"));
        CHECK_THAT(run_program(folder, command + husky).err, !Contains(" steep") && !Contains(" unstable"));
    }
    const auto json = nlohmann::json::parse(
        run_program(folder, "sample map -n 1 --stance level --format json --max-slope 15" + husky).out);
    CHECK(json["settings"]["max_slope"].get<double>() == Approx(15 * M_PI / 180));
    CHECK(json["counts"].contains("unstable"));
}

TEST_CASE("bounds beyond the map, and a layer that it does not have, get a notice")
{
    const Arena arena;
    const std::string off = " 50, 50 to 60, 60 m lies off the map, which is -10.1, -10.1 to 10.1, 10.1 m\n";
    const std::string query[] = {
        "sample map -n 1 --region 50,50,60,60", "raster map --dims 2 --step 2 --bounds 50,50,60,60",
        "raster map --dims 3 --step 2 --bounds 50,50,0,60,60,1", "heatmap map --step 2 -o a.png --bounds 50,50,60,60",
        "search map -n 1 --max-failures 9 --bounds 50,50,0,60,60,1"};
    for (const std::string& command : query) {
        INFO(command);
        const std::string option = command.starts_with("sample") ? "--region" : "--bounds";
        CHECK(arena(command + husky).err.starts_with("notice: " + option + off));
    }
    CHECK_THAT(arena("raster map --dims 2 --step 2 --bounds 9,9,60,60" + husky).err, !Contains("notice"));
    const std::string layers =
        "notice: --layers 2 does not exist: a cell of the map has at most 2 layers (0 is the highest)\n";
    for (const std::string command : {"sample map -n 1", "raster map --dims 2 --step 2", "raster map --dims 3 --step 2",
                                      "heatmap map --step 2 -o a.png"}) {
        INFO(command);
        CHECK(arena(command + " --layer 2" + husky).err.starts_with(layers));
        CHECK_THAT(arena(command + " --layer 1" + husky).err, !Contains("notice: --layers"));
    }
}

TEST_CASE("the output of check can be checked again")
{
    const Arena arena;
    arena.write("poses.csv", "x,y,z,name\n0,0,0.1,\"a, \"\"b\"\"\"\n-2,0,0.1,c\n");
    CHECK(arena("check map --poses poses.csv -o once.csv" + husky).status == 0);
    const ProgramRun again = arena("check map --poses once.csv" + husky);
    CHECK(again.out == bytes_of(arena / "once.csv"));
    CHECK_THAT(again.err,
               Contains("notice: once.csv: new columns replace the old ones: verdict, ground, height_above, hit\n"));
    arena.write("mixed.csv", "hit,x,verdict,y,z\nlamp,0,\"1,2\",0,0.1\n");
    CHECK(arena("check map --poses mixed.csv" + husky).out ==
          "x,y,z,verdict,ground,height_above,hit\n0,0,0.1,valid,-0.05,0.15000000000000002,\n");
}

TEST_CASE("columns whose names differ from known ones only in case get a notice")
{
    const Arena arena;
    arena.write("poses.csv", "x,y,z,Yaw\n0,0,0.1,1\n");
    const std::string yaw =
        "notice: poses.csv: column Yaw is copied but not read, because names of columns are lower case (yaw)\n";
    const ProgramRun run = arena("check map --poses poses.csv" + husky);
    CHECK(run.err.starts_with(yaw));
    CHECK(row(run.out, 0).starts_with("x,y,z,Yaw,verdict"));
    CHECK_THAT(arena("heatmap map -o a.png --step 2 --spawns poses.csv" + husky).err, Contains(yaw));
}

TEST_CASE("heatmap draws a picture")
{
    const Arena arena;
    const ProgramRun run = arena("heatmap map -o a.png --size 400 --step 0.5 --quantity clearance" + husky);
    CHECK(run.status == 0);
    const cv::Mat picture = cv::imread((arena / "a.png").string());
    CHECK(std::max(picture.cols, picture.rows) == 400);
}

TEST_CASE("--quiet silences everything except errors")
{
    const Arena arena;
    arena.write("poses.csv", "x,y,z\n0,0,0.1\n");
    for (const std::string& arguments :
         {"bake " + scene + " -o new -q", std::string("info map -q"), "check map -q --poses poses.csv" + husky,
          "raster map -q --dims 2 --step 2" + husky, "sample map -q -n 2" + husky,
          "search map -q -n 2 --min-distance 0 --max-failures 9999" + husky, "heatmap map -q --step 2 -o a.png" + husky,
          "experiment map -q --dims 2 --steps 2 -o steps" + husky}) {
        INFO(arguments);
        const ProgramRun run = arena(arguments);
        CHECK(run.status == 0);
        CHECK(run.err.empty());
    }
    CHECK(arena("info none -q").err == "spawnfield: none: does not exist; is the path right?\n");
}

TEST_CASE("a pipe and /dev/null are written directly")
{
    const Arena arena;
    CHECK(arena("sample map -n 2 -o /dev/null" + husky).status == 0);
    CHECK(fs::is_character_file("/dev/null"));
    CHECK(lines(arena("sample map -n 2 -q -o /dev/stdout" + husky + "| cat").out) == 3);
    CHECK(lines(arena("sample map -n 2 -q -o /proc/self/fd/1" + husky).out) == 3);
    CHECK(fs::is_symlink("/dev/stdout"));  // written through, not replaced
    const std::string both = arena("sample map -n 2 -q --summary /dev/stdout" + husky).out;
    CHECK(both.starts_with("x,y,z,"));
    CHECK(nlohmann::json::parse(both.substr(both.find('{')))["command"] == "sample");
}

TEST_CASE("a link is written through, and stays a link")
{
    const Arena arena;
    arena.write("far/spawns.csv", "old");
    fs::create_symlink("far/spawns.csv", arena / "near.csv");
    CHECK(arena("sample map -n 2 -o near.csv" + husky).status == 0);
    CHECK(fs::is_symlink(arena / "near.csv"));
    CHECK(lines(bytes_of(arena / "far/spawns.csv")) == 3);
    CHECK(std::distance(fs::directory_iterator(arena / "far"), {}) == 1);
}

TEST_CASE("Ctrl-C ends a search for spawns with status 130, and writes those that were found")
{
    const Arena arena;
    const std::string wanted = " -n 100000000 --yaw random --seed 3 -o ";
    const ProgramRun run = interrupt_program(arena, "sample map" + wanted + "part.csv --stance level" + husky);
    CHECK(run.status == 130);
    const std::string part = bytes_of(arena / "part.csv");
    const long found = lines(part) - 1;
    CHECK(found > 0);
    CHECK_THAT(run.err, Catch::Matchers::EndsWith("spawnfield: interrupted: " + std::to_string(found) +
                                                  " spawns of 100000000 were found and written\n"));
    const std::string whole =
        arena("sample map --yaw random --seed 3 --stance level -n " + std::to_string(found) + husky).out;
    CHECK(part == whole);
}

TEST_CASE("an interrupted sample, search or list of pairs says so in its summary and in JSON")
{
    const Arena arena;
    // This also keeps the drivable graph, so that below, the first pairs are found soon.
    for (const std::string& options : {std::string("-n 3"), std::string("--pairs 3 --reach-step 0.4")}) {
        const std::string out = arena("sample map --format json --summary s.json " + options + husky).out;
        CHECK_FALSE(nlohmann::json::parse(out).contains("interrupted"));
        CHECK_FALSE(nlohmann::json::parse(bytes_of(arena / "s.json")).contains("interrupted"));
    }
    const std::string cases[] = {
        "sample map -n 100000000 --stance level",
        "sample map -n 100000000",
        "search map -n 100000000 --min-distance 0 --max-failures 2000000000",
        "sample map --pairs 3000 --min-path 1 --reach-step 0.4",
    };
    for (const std::string& arguments : cases) {
        CAPTURE(arguments);
        const bool is_pairs = arguments.find("--pairs") != std::string::npos;
        fs::remove(arena / "out.json");
        const ProgramRun run = interrupt_program(arena,
                                                 arguments + " --format json -o out.json --summary s.json" + husky,
                                                 SIGINT, is_pairs ? "sample [#" : " %");
        CHECK(run.status == 130);
        CHECK_THAT(run.err, Contains(": interrupted; ") && Contains(" were found and written"));
        const auto report = nlohmann::json::parse(bytes_of(arena / "s.json")),
                   json = nlohmann::json::parse(bytes_of(arena / "out.json"));
        CHECK(report["interrupted"] == true);
        CHECK(json["interrupted"] == true);
        for (const auto* const out : {&report, &json})
            if (out->contains("undecided_area")) CHECK((*out)["undecided_area"].is_null());
    }
}

TEST_CASE("a second Ctrl-C while the result is written leaves no part of a file")
{
    const Arena arena;
    const auto is_writing = [&] {
        for (const std::string& name : arena.names())
            if (name.starts_with("part.csv.tmp-")) return true;
        return false;
    };
    const ProgramRun run = interrupt_program_twice(
        arena, "sample map -n 100000000 --yaw random --stance level -o part.csv" + husky, is_writing);
    CHECK(run.status == 130);
    if (run.err.find("nothing was written") != std::string::npos) {
        CHECK(arena.names() == std::set<std::string>{"map"});
    } else {  // it was complete before the second signal arrived
        CHECK(arena.names() == std::set<std::string>{"map", "part.csv"});
        CHECK_THAT(run.err, Contains(std::to_string(lines(bytes_of(arena / "part.csv")) - 1) + " spawns"));
    }
}

TEST_CASE("Ctrl-C ends long work with status 130 and does not change old files")
{
    const Arena arena;
    arena.write("out.csv", "old");
    const std::string before = bytes_of(arena / "map/map.yaml");
    const std::string cases[] = {
        "raster map --dims 3 --step 0.02 --no-height-check -o out.csv" + husky,
        "search map -n 5 --min-distance 0 --max-failures 2000000000 --bounds 0,0,50,1,1,60 -o out.csv" + husky,
        "experiment map --dims 3 --steps 0.02 --no-height-check -o steps" + husky,
        "bake " + scene + " -o map --resolution 0.0025"};
    for (const std::string& arguments : cases) {
        INFO(arguments);
        const bool is_bake = arguments.starts_with("bake");
        const ProgramRun run = interrupt_program(arena, arguments,
                                                 is_bake ? SIGHUP : SIGINT);  // a closed terminal counts like Ctrl-C
        CHECK(run.status == 130);
        CHECK_THAT(run.err, Catch::Matchers::EndsWith("\rspawnfield: interrupted; nothing was written\n"));
        CHECK(bytes_of(arena / "out.csv") == "old");
        CHECK(bytes_of(arena / "map/map.yaml") == before);
        CHECK(arena.names() == std::set<std::string>{"map", "out.csv"});
    }
}
