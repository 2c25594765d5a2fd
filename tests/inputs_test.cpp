#include "arena.h"

#include "base/foreign_file.h"

#include <spawnfield/error.h>
#include <spawnfield/input_file.h>
#include <spawnfield/poses.h>
#include <spawnfield/region_file.h>
#include <spawnfield/robot.h>
#include <spawnfield/scene.h>

#include <nlohmann/json.hpp>

#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>

#include <numbers>

using namespace spawnfield;
namespace fs = std::filesystem;

namespace {

const std::string box = " --robot box:0.5,0.5,0.3 ";
const std::string usage_hint = "\nRun with --help for more information.\n";

void make_pipe(const fs::path& file)
{
    fs::create_directories(file.parent_path());
    REQUIRE(mkfifo(file.c_str(), 0600) == 0);
}

std::string pipe_complaint(const std::string& file)
{
    return "spawnfield: " + file +
           ": is a pipe, needs a regular file; write it to one first, or give - (standard input) if the option accepts "
           "it\n";
}

std::vector<Pose> poses_in(const fs::path& file) { return read_poses(file, true).poses; }

std::size_t nearer(const std::vector<Pose>& poses, const std::vector<Pose>& others, double distance)
{
    std::size_t count = 0;
    for (const Pose& pose : poses)
        for (const Pose& other : others) count += (pose.position - other.position).norm() < distance;
    return count;
}

}  // namespace

// ---- several robots one after another ----

TEST_CASE("robots are placed one after another, each away from the earlier ones")
{
    const Arena arena;
    REQUIRE(arena("sample map -n 6 --min-distance 2 --yaw random -o a.csv" + husky_option).status == 0);
    const ProgramRun second = arena(
        "sample map -n 10 --avoid a.csv --avoid-distance 3 --seed 1 -o b.csv --summary b.json" + box);
    CHECK(second.status == 0);
    CHECK_THAT(second.err, Contains(" near avoided poses"));
    const auto summary = nlohmann::json::parse(bytes_of(arena / "b.json"));
    CHECK(summary["draws"]["near_avoided"] > 0);
    CHECK(summary["draws"]["all"] >= summary["poses"]);
    const auto a = poses_in(arena / "a.csv"), b = poses_in(arena / "b.csv");
    CHECK(b.size() == 10);
    CHECK(nearer(b, a, 3) == 0);
    CHECK(arena("search map -n 10 --avoid a.csv --avoid b.csv --avoid-distance 1.5 --avoid-distance 2.5 -o c.csv" + box)
              .status == 0);
    const auto c = poses_in(arena / "c.csv");
    CHECK((nearer(c, a, 1.5) == 0 && nearer(c, b, 2.5) == 0));
    CHECK(nearer(c, a, 2.5) > 0);  // each distance applies to its own file
    const ProgramRun json = arena("sample map -n 2 --min-distance 1 --avoid a.csv --avoid b.csv --format json" + box);
    const auto avoid = nlohmann::json::parse(json.out)["settings"]["avoid"];
    CHECK(
        avoid ==
        nlohmann::json::parse(
            R"([{"poses": "a.csv", "count": 6, "distance": 1.0}, {"poses": "b.csv", "count": 10, "distance": 1.0}])"));
    CHECK(arena("sample map -n 2 --avoid a.csv --avoid-distance 1 --format thesis -o t" + box).status == 0);
    CHECK_THAT(bytes_of(arena / "t/Stats.txt"),
               Contains("a.csv: 6 poses, 1 m") && Contains("Draws near avoided poses"));
}

TEST_CASE("the commands for several robots in docs/input-files.md work")
{
    const Arena arena;
    fs::create_symlink(program_file(), arena / "spawnfield");
    fs::create_symlink(source_folder() + "/maps", arena / "maps");
    fs::create_symlink("map", arena / "training");
    const std::string doc = bytes_of(source_folder() + "/docs/input-files.md"), fence = "```\n";
    const std::size_t start = doc.find(fence, doc.find("## Several robots one after another")) + fence.size();
    std::string script = doc.substr(start, doc.find(fence, start) - start);
    for (std::size_t at = script.find("/tmp/"); at != std::string::npos; at = script.find("/tmp/")) script.erase(at, 5);
    REQUIRE_THAT(script, Contains("--avoid huskies.csv"));
    CHECK(arena("--version && set -e && PATH=$PWD:$PATH\n" + script).status == 0);
    const auto huskies = poses_in(arena / "huskies.csv"), boxes = poses_in(arena / "boxes.csv");
    CHECK(nearer(boxes, huskies, 1.5) == 0);
    CHECK(nearer(poses_in(arena / "carts.csv"), boxes, 3) == 0);
}

TEST_CASE("a map that avoided poses cover ends with 3 and a proof")
{
    const Arena arena;
    std::string grid = "x,y,z\n";
    for (double x = -10; x <= 10; x += 1)
        for (double y = -10; y <= 10; y += 1) grid += std::to_string(x) + "," + std::to_string(y) + ",0.05\n";
    arena.write("grid.csv", grid);
    const ProgramRun run = arena(
        "sample map -n 5 --stance level --avoid grid.csv --avoid-distance 4 --summary s.json -o s.csv" + box);
    CHECK(run.status == 3);
    CHECK_THAT(run.err, Contains("no spawn fits: it is proven that no pose is valid and far enough from the avoided "
                                 "poses; a smaller --avoid-distance, "));
    const auto summary = nlohmann::json::parse(bytes_of(arena / "s.json"));
    CHECK(summary["full"] == true);
    CHECK(summary["undecided_area"] == 0);
    CHECK(poses_in(arena / "s.csv").empty());
}

TEST_CASE("avoiding with distance 0 changes no byte, and options that do not fit together are refused")
{
    const Arena arena;
    arena.write("a.csv", "x,y,z\n0,3,0.1\n");
    const std::string sample = "sample map -n 5" + box;
    const ProgramRun plain = arena(sample);
    const ProgramRun none = arena(sample + "--avoid a.csv --avoid-distance 0");
    CHECK(none.out == plain.out);
    CHECK_THAT(none.err, Contains("notice: --avoid a.csv has no effect: its --avoid-distance is 0\n"));
    const auto refused = [&](const std::string& options) {
        const ProgramRun run = arena(sample + options);
        CHECK(run.status == 2);
        return run.err;
    };
    CHECK(refused("--avoid a.csv") ==
          "spawnfield: --avoid needs --avoid-distance M, or --min-distance > 0 (the default of --avoid-distance)\n");
    CHECK(refused("--avoid-distance 1") == "spawnfield: --avoid-distance needs --avoid FILE\n");
    CHECK(refused("--avoid a.csv --avoid-distance -1") == "spawnfield: --avoid-distance is -1, needs >= 0 m\n");
    CHECK(refused("--avoid a.csv --avoid a.csv --avoid a.csv --avoid-distance 1 --avoid-distance 2") ==
          "spawnfield: --avoid-distance is given 2 times, needs once or once for each --avoid (3)\n");
    arena.write("far.csv", "x,y,z\n500,3,0.1\n501,3,0.1\n");
    CHECK_THAT(arena(sample + "--avoid far.csv --avoid-distance 2").err,
               Contains("notice: --avoid far.csv: all of its 2 poses lie off the map, which is "));
}

TEST_CASE("a poses file given as a region is refused because of its header")
{
    const TempFolder folder;
    const auto complaint = [&](const std::string& header) {
        const fs::path file = folder.write("a.csv", header + "\n0,0,1,1\n1,0,1,1\n0,1,1,1\n");
        try {
            read_region(file);
        } catch (const FileError& error) {
            return std::string(error.what()).substr(file.string().size());
        }
        return std::string();
    };
    for (const std::string header : {"x,y,z,yaw", "x,y,id,yaw_deg", "x,y,a,verdict", "x,y,z,roll", "z,y,x,qx"})
        CHECK_THAT(complaint(header),
                   Contains(": line 1: has a column ") && Contains("--avoid FILE --avoid-distance M"));
    CHECK(complaint("x,y,a,b").empty());
    CHECK(complaint("x,y,z,polygon").empty());
}

// ---- angles ----

TEST_CASE("columns in degrees are degrees")
{
    const PoseTable table = parse_poses("x,y,z,roll_deg,pitch_deg,yaw_deg\n1,2,3,10,-20,90\n", "a");
    const double degree = std::numbers::pi / 180;
    CHECK((table.poses[0].rotation - rotation_from_rpy(10 * degree, -20 * degree, 90 * degree)).norm() < 1e-15);
    CHECK(table.notices.empty());
    const PoseTable mixed = parse_poses("yaw_deg,x,y,z,roll\n360,1,2,3,0.5\n", "a");
    CHECK((mixed.poses[0].rotation - rotation_from_rpy(0.5, 0, 0)).norm() < 1e-15);
    CHECK_THROWS_WITH(parse_poses("x,y,z,yaw,yaw_deg\n0,0,0,1,1\n", "a"),
                      "a: line 1: has columns yaw and yaw_deg, needs one of the two");
    CHECK_THROWS_WITH(parse_poses("x,y,z,qx,qy,qz,qw,yaw_deg\n0,0,0,0,0,0,1,1\n", "a"),
                      "a: line 1: has columns qx,qy,qz,qw beside roll,pitch,yaw, needs one of the two");
}

TEST_CASE("an angle of more than one turn gets one notice for its column")
{
    CHECK(parse_poses("x,y,z,yaw\n0,0,0,6.2831853\n0,0,0,-6.2831853\n", "a").notices.empty());
    CHECK(
        parse_poses("x,y,z,yaw\n0,0,0,1\n0,0,0,90\n", "a").notices ==
        std::vector<std::string>{
            "a: line 3: column yaw is 90, which is more than a turn of 2 pi rad; for degrees name the column yaw_deg"});
    CHECK(parse_poses("x,y,z,pitch,yaw\n0,0,0,-10,1\n0,0,0,9,1\n0,0,0,0,1\n", "a").notices ==
          std::vector<std::string>{"a: line 2: column pitch is -10 (the first of 2 rows), which is more than a turn of "
                                   "2 pi rad; for degrees name the column pitch_deg"});
}

TEST_CASE("--yaw takes degrees in every command that has it")
{
    const Arena arena;
    arena.write("p.csv", "x,y,z\n0,3,0.1\n");
    const std::string raster = " --dims 2 --step 2 ";
    const auto same = [&](const std::string& arguments) {
        const ProgramRun degrees = arena(arguments + " --yaw 90deg"),
                         radians = arena(arguments + " --yaw 1.5707963267948966");
        INFO(degrees.err);
        return degrees.status == 0 && degrees.out == radians.out;
    };
    CHECK(same("sample map -n 3" + husky_option));
    CHECK(same("search map -n 3" + husky_option));
    CHECK(same("raster map" + raster + husky_option));
    CHECK(same("export map --format ply --step 2" + husky_option));
    CHECK(same("heatmap map -o - --step 2" + husky_option));
    CHECK_THAT(arena("sample map -n 1 --yaw -30deg" + husky_option).out, Contains(",-0.5235987755982988,0,0.335\n"));
    CHECK(arena("experiment map --dims 2 --steps 2 --yaw 90deg -o e" + husky_option).status == 0);
    CHECK_THAT(arena("experiment map --dims 2 --steps 2 --yaw 90grad -o e" + husky_option).err,
               Contains("--yaw is \"90grad\", needs radians such as 1.57 or degrees such as 90deg\n"));
    CHECK(arena("sample map -n 1 --yaw inf" + husky_option).status == 2);
    CHECK(arena("raster map --yaw random" + raster + husky_option).status == 2);
    const std::string hint = "notice: --yaw 90 is more than a turn of 2 pi rad; did you mean degrees? --yaw 90deg\n";
    for (const std::string& command :
         {std::string("sample map -n 1"), "raster map -o r.csv" + raster, std::string("heatmap map --step 2 -o h.png")})
        CHECK_THAT(arena(command + " --yaw 90" + husky_option).err, Contains(hint));
    CHECK_THAT(arena("sample map -n 1 --stance level --yaw 6.28" + husky_option).err, !Contains("notice"));
}

// ---- CSV ----

TEST_CASE("a CSV file without header, commas or poses is refused, with advice")
{
    const auto complaint = [](const std::string& text) {
        try {
            parse_poses(text, "a");
        } catch (const FileError& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    CHECK(complaint("1,2,3\n") == "a: line 1: has numbers, needs a header before them: add the line x,y,z");
    CHECK(complaint("1,2,3,4\n") ==
          "a: line 1: has numbers, needs a header before them: add the line x,y,z,yaw (or yaw_deg)");
    CHECK_THAT(complaint("1,2,3,0,0,0,1\n"), Contains("add the line x,y,z,qx,qy,qz,qw"));
    const std::string semicolons =
        "a: line 1: has fields separated by semicolons, needs commas, and points in "
        "decimals: tr ',;' '.,' < IN.csv > OUT.csv";
    CHECK(complaint("x;y;z\n1;2;3\n") == semicolons);
    CHECK(complaint("1,5;2,5;-0,1\n") == semicolons);
    CHECK(complaint("x\ty\tz\n1\t2\t3\n") ==
          "a: line 1: has fields separated by tabs, needs commas: tr '\\t' ',' < IN.csv > OUT.csv");
    CHECK(complaint("x,y,z,a;b\n1,2,3,\"c;d\"\n").empty());  // a semicolon inside a field
    CHECK(complaint("x,y,z\n") == "a: has a header but no pose; --allow-empty accepts that");
    CHECK(parse_poses("x,y,z\n", "a", true).notices == std::vector<std::string>{"a: has a header but no pose"});
    CHECK_THAT(complaint(""), Contains("a: is empty, needs a header with x,y,z;"));
    CHECK_THROWS_WITH(parse_region("0;0\n1;0\n0;1\n", "b"), Contains("b: line 1: has fields separated by semicolons"));
    CHECK_THROWS_WITH(parse_region("0,5;0\n1;0\n0;1\n", "b"),
                      Contains("b: line 1: has fields separated by semicolons"));
}

TEST_CASE("files without a pose are refused by every command that reads poses, unless --allow-empty is given")
{
    const Arena arena;
    arena.write("none.csv", "x,y,z\n");
    for (const std::string& command :
         {"check map --poses none.csv" + box, std::string("export map --format csv --poses none.csv"),
          std::string("export map --format glb --poses none.csv -o a.glb"),
          "heatmap map --step 2 -o h.png --spawns none.csv" + box,
          "sample map -n 1 --avoid none.csv --avoid-distance 1" + box,
          "search map -n 1 --avoid none.csv --avoid-distance 1" + box}) {
        CAPTURE(command);
        const ProgramRun refused = arena(command), allowed = arena(command + " --allow-empty");
        CHECK(refused.status == 4);
        CHECK(refused.err == "spawnfield: none.csv: has a header but no pose; --allow-empty accepts that\n");
        CHECK(allowed.status == 0);
        CHECK_THAT(allowed.err, Contains("notice: none.csv: has a header but no pose\n"));
    }
}

// ---- standard input and output ----

TEST_CASE("- is standard input for poses and regions")
{
    const Arena arena;
    arena.write("p.csv", "name,x,y,z,yaw\na,0,3,0.1,0.5\nb,1,3,0.1,0\n");
    arena.write("r.csv", "0,0\n3,0\n3,3\n");
    arena.write("r.geojson", R"( {"type": "Polygon", "coordinates": [[[0, 0], [3, 0], [3, 3], [0, 0]]]})");
    for (const auto& [with_file, with_stream] : std::vector<std::pair<std::string, std::string>>{
             {"check map --poses p.csv" + box, "check map --poses - < p.csv" + box},
             {"export map --format csv --poses p.csv", "export map --format csv --poses - < p.csv"},
             {"heatmap map -o - --step 2 --spawns p.csv" + box, "heatmap map -o - --step 2 --spawns - < p.csv" + box},
             {"sample map -n 4 --avoid-distance 2 --avoid p.csv" + box,
              "sample map -n 4 --avoid-distance 2 --avoid - < p.csv" + box},
             {"sample map -n 4 --region r.csv" + box, "sample map -n 4 --region - < r.csv" + box},
             {"sample map -n 4 --region r.geojson" + box, "sample map -n 4 --region - < r.geojson" + box},
             {"raster map --dims 2 --step 1 --keep-out r.csv" + box,
              "raster map --dims 2 --step 1 --keep-out - < r.csv" + box}}) {
        CAPTURE(with_stream);
        const ProgramRun file = arena(with_file), stream = arena(with_stream);
        CHECK(file.status == 0);
        CHECK(stream.status == 0);
        CHECK(stream.out == file.out);
        CHECK(file.out.size() > 10);
    }
    arena.write("bad.csv", "x,y,z\n1,2\n");
    CHECK(arena("check map --poses - < bad.csv" + box).err ==
          "spawnfield: standard input: line 2: has 2 fields, the header has 3\n");
    CHECK(arena.names().count("-") == 0);
}

TEST_CASE("- is standard output for results, pictures and summaries")
{
    const Arena arena;
    const std::string png = "\x89PNG";
    const ProgramRun picture = arena("heatmap map -o - --step 2" + box);
    CHECK(picture.status == 0);
    REQUIRE(arena("heatmap map -o h.png --step 2" + box).status == 0);
    CHECK(picture.out == bytes_of(arena / "h.png"));
    CHECK(arena("raster map --dims 2 --step 2 --heatmap - -o r.csv" + box).out.starts_with(png));
    CHECK(arena("raster map --dims 2 --step 2 --heatmap -" + box).out.starts_with(png));
    const ProgramRun summary = arena("sample map -n 1 -o s.csv --summary -" + box);
    CHECK(nlohmann::json::parse(summary.out)["command"] == "sample");
    CHECK(arena("sample map -n 1 -o -" + box).out == bytes_of(arena / "s.csv"));
    CHECK(arena("export map --format glb -o -").out.starts_with("glTF"));
    CHECK(nlohmann::json::parse(
              arena("bake " + training_scene + " -o new --resolution 1 --summary -").out)["command"] == "bake");
    CHECK(arena.names() == std::set<std::string>{"map", "h.png", "r.csv", "s.csv", "new"});
}

TEST_CASE("two streams of one kind, and - for a folder or a file that names others, are refused")
{
    const Arena arena;
    const auto refused = [&](const std::string& arguments) {
        const ProgramRun run = arena(arguments);
        CHECK(run.status == 2);
        CHECK(run.out.empty());
        return run.err;
    };
    CHECK(refused("sample map -n 1 --avoid - --region - --avoid-distance 1" + box) ==
          "spawnfield: --avoid and --region are both \"-\", but standard input can be read only once; give one of them "
          "a file\n");
    CHECK_THAT(refused("sample map -n 1 --region - --region -" + box),
               Contains("--region and --region are both \"-\""));
    const std::string both = " would both go to standard output; give one of them a file\n";
    CHECK(refused("raster map --dims 2 --step 2 --heatmap - -o -" + box) == "spawnfield: --out and --heatmap" + both);
    CHECK(refused("raster map --dims 2 --step 2 --heatmap - --summary -" + box) ==
          "spawnfield: --summary and --heatmap" + both);
    CHECK(refused("sample map -n 1 --summary -" + box) == "spawnfield: the result and --summary" + both);
    CHECK(refused("info map --summary -") == "spawnfield: the result and --summary" + both);
    CHECK(refused("info box:1,1,1 --picture -") == "spawnfield: the result and --picture" + both);
    for (const char* const arguments :
         {"bake - -o new", "info -", "check - --robot box:1,1,1 --poses p.csv", "check map --robot - --poses p.csv",
          "sample map -n 1 --format sdf --robot box:1,1,1 --robot-uri model://a --world -"})
        CHECK_THAT(refused(arguments),
                   Contains("spawnfield: \"-\" (standard input) cannot be a") && Contains("; give its path\n"));
    CHECK_THAT(refused("bake " + training_scene + " -o -"),
               Contains("the result of bake is a folder, which cannot go to standard output"));
    CHECK_THAT(refused("experiment map --dims 2 --steps 2 -o -" + box),
               Contains("the result of experiment is a folder, which cannot go to standard output"));
    CHECK_THAT(refused("sample map -n 1 --format isaaclab -o -" + box), Contains("needs -o FOLDER"));
    CHECK_THAT(refused("sample map -n 1 --format thesis -o -" + box), Contains("needs -o FOLDER"));
    CHECK_THAT(refused("export map --format geotiff -o -"), Contains("cannot go to standard output"));
    CHECK(arena.names() == std::set<std::string>{"map"});
}

// ---- files that are not regular files ----

TEST_CASE("a pipe is refused before it is opened, wherever a file is read")
{
    const Arena arena;
    arena.write("p.csv", "x,y,z\n0,3,0.1\n");
    for (const char* const name : {"pipe", "pipe.urdf", "pipe.yaml", "pipe.world", "pipe.obj", "pipe.glb", "pipe.asc",
                                   "pipe.bt", "pipe.xml", "pipe.geojson"})
        make_pipe(arena / name);
    const auto check = [&](const std::string& arguments, const std::string& file) {
        CAPTURE(arguments);
        const ProgramRun run = limited_program(arena, arguments);
        CHECK(run.status == 4);
        CHECK(run.err == pipe_complaint(file));
    };
    check("check map --poses pipe" + box, "pipe");
    check("export map --format csv --poses pipe", "pipe");
    check("heatmap map -o h.png --spawns pipe" + box, "pipe");
    check("sample map -n 1 --avoid pipe --avoid-distance 1" + box, "pipe");
    check("sample map -n 1 --region pipe.geojson" + box, "pipe.geojson");
    check("sample map -n 1 --keep-out pipe" + box, "pipe");
    check("raster map --dims 2 --step 1 --region pipe.yaml" + box, "pipe.yaml");
    check("sample map -n 1 --format sdf --robot-uri model://a --world pipe.world" + box, "pipe.world");
    check("sample map -n 1 --format sdf --robot-file pipe.urdf" + box, "pipe.urdf");
    check("sample pipe -n 1" + box, "pipe");
    for (const char* const robot : {"pipe", "pipe.urdf", "pipe.yaml", "pipe.world", "pipe.xml"})
        check("check map --poses p.csv --robot " + std::string(robot), robot);
    for (const char* const scene :
         {"pipe", "pipe.urdf", "pipe.yaml", "pipe.world", "pipe.obj", "pipe.glb", "pipe.asc", "pipe.bt", "pipe.xml"}) {
        check("bake -o new " + std::string(scene), scene);
        check("info " + std::string(scene), scene);
    }
    fs::remove(arena / "map/geometry.bin");
    make_pipe(arena / "map/geometry.bin");
    check("check map --poses p.csv" + box, "map/geometry.bin");
}

TEST_CASE("pipes that a scene or a robot names are refused too")
{
    const Arena arena;
    make_pipe(arena / "pipe");
    make_pipe(arena / "pipe.obj");
    make_pipe(arena / "pipe.world");
    const std::string scene =
        "format: spawnfield-scene/1\nparts: [{name: a, label: terrain, box: [9, 9, 1]}, {name: m, ";
    arena.write("mesh.yaml", scene + "mesh: pipe.obj}]\n");
    arena.write("height.yaml", scene + "heightmap: {file: pipe, size: [2, 2], z: [0, 1]}}]\n");
    arena.write("tree.yaml", scene + "octomap: pipe}]\n");
    arena.write(
        "map2d.yaml",
        "image: pipe\nresolution: 0.1\norigin: [0, 0, 0]\noccupied_thresh: 0.65\nfree_thresh: 0.2\nnegate: 0\n");
    arena.write("include.world",
                "<sdf version='1.6'><world name='w'><include><uri>pipe.world</uri></include></world></sdf>");
    for (const char* const file : {"mesh.yaml", "height.yaml", "tree.yaml", "map2d.yaml", "include.world"}) {
        CAPTURE(file);
        const ProgramRun run = limited_program(arena, "bake -q -o new " + std::string(file));
        CHECK(run.status == 4);
        CHECK_THAT(run.err, Contains("is a pipe, needs a regular file"));
    }
    arena.write("robot.yaml", "format: spawnfield-robot/1\nparts: [{mesh: pipe.obj}]\n");
    CHECK_THAT(limited_program(arena, "info robot.yaml").err, Contains("pipe.obj: is a pipe, needs a regular file"));
    // The file of a material has no effect, so the mesh is read without it.
    arena.write("material.obj", "mtllib pipe\nusemtl a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    CHECK(limited_program(arena, "info -q material.obj").status == 0);
    arena.write("buffer.gltf", R"({"asset": {"version": "2.0"}, "buffers": [{"uri": "pipe", "byteLength": 36}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}], "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}], "nodes": [{"mesh": 0}], "scenes": [{"nodes": [0]}], "scene": 0})");
    CHECK(limited_program(arena, "info -q buffer.gltf").status == 4);
}

TEST_CASE("folders, devices, sockets and circles of links are refused, and the message names the kind")
{
    const Arena arena;
    fs::create_symlink("circle", arena / "circle");
    sockaddr_un address{AF_UNIX, "socket"};
    const int descriptor = socket(AF_UNIX, SOCK_STREAM, 0);
    const fs::path before = fs::current_path();
    fs::current_path(arena.path());  // the name of a socket must be short
    const bool is_bound = bind(descriptor, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
    fs::current_path(before);
    REQUIRE(is_bound);
    const auto said = [&](const std::string& file) {
        const ProgramRun run = limited_program(arena, "check map --poses " + file + box);
        CHECK(run.status == 4);
        return run.err;
    };
    CHECK(said("/dev/zero") == "spawnfield: /dev/zero: is a device, needs a regular file\n");
    CHECK(said("map") == "spawnfield: map: is a folder, needs a file\n");
    CHECK(said("socket") == "spawnfield: socket: is a socket, needs a regular file\n");
    CHECK(said("circle") == "spawnfield: circle: cannot be reached: Too many levels of symbolic links\n");
    CHECK(said("none") == "spawnfield: none: does not exist; is the path right?\n");
    CHECK(limited_program(arena, "check map --poses p.csv --robot circle").status == 4);
    CHECK(limited_program(arena, "check map --poses p.csv --robot /dev/zero").status == 4);
    close(descriptor);
}

TEST_CASE("a name that is too long for the system is that of a missing file")
{
    const Arena arena;
    const std::string name(300, 'n');
    CHECK(!does_exist(name));
    CHECK(!is_file(name));
    CHECK(!is_folder(name));
    CHECK(is_missing(name));
    fs::create_symlink("circle", arena / "circle");
    CHECK(!does_exist(arena / "circle"));
    CHECK(!is_missing(arena / "circle"));

    const auto scene_with = [&](const std::string& mesh) {
        return arena.write("scene.yaml",
                           "format: spawnfield-scene/1\nparts: [{name: a, label: terrain, box: [9, 9, 1]}, "
                           "{name: m, mesh: " +
                               mesh + "}]\n");
    };
    const Scene scene = load_scene(scene_with(name + ".obj"), {.allow_missing = true});
    REQUIRE(scene.missing.size() == 1);
    CHECK_THAT(scene.missing[0], Contains("part \"m\": mesh: ") && Contains(name + ".obj is not found: it is ignored"));
    CHECK_THROWS_WITH(load_scene(arena / "scene.yaml"),
                      Contains("part \"m\": mesh cannot be used: ") && Contains("File name too long"));
    CHECK_THROWS_WITH(load_scene(scene_with("circle"), {.allow_missing = true}),
                      Contains("mesh cannot be used: ") && Contains("Too many levels of symbolic links"));

    const ProgramRun bake = limited_program(arena, "bake " + training_scene + " -o " + name);
    CHECK(bake.status == 1);
    CHECK_THAT(bake.err, Contains(name + ": cannot be created: File name too long"));
    arena.write("p.csv", "x,y,z\n0,3,0.1\n");
    CHECK_THAT(limited_program(arena, "check map --poses p.csv --robot " + name).err,
               Contains("does not exist; a robot is"));

    // What cannot be reached is not missing, and ends a run before its work.
    const std::string reason = "Too many levels of symbolic links";
    const auto said = [&](const std::string& arguments) {
        const ProgramRun run = limited_program(arena, arguments);
        CHECK(run.status != 0);
        return run.err;
    };
    CHECK(said("bake " + training_scene + " -o circle") == "spawnfield: circle: cannot be created: " + reason + "\n");
    CHECK_THAT(said("sample map -n 1 --format sdf --robot-file circle" + box), Contains(reason));
    fs::create_directory(arena / "other");
    fs::create_symlink("map.yaml", arena / "other/map.yaml");
    CHECK_THAT(said("info other"), Contains(reason));
    arena.write("heights.asc", "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2\n3 4\n");
    fs::create_symlink("heights.prj", arena / "heights.prj");
    CHECK_THAT(said("bake heights.asc -o new"), Contains("heights.prj: cannot be reached: " + reason));

    // These options take a file or a text that names no file.
    const std::string zeros(300, '0');
    CHECK(limited_program(arena, "sample map -n 1 --region -2,-2,2,2." + zeros + box).status == 0);
    CHECK(limited_program(arena, "check map --poses p.csv --with box:1,1,1@1,1,0." + zeros + box).status == 0);
    CHECK(limited_program(arena, "sample map -n 1 --format sdf --robot-uri model://" + name + box).status == 0);
}

// ---- kinds of files ----

TEST_CASE("files of other programs are recognised, with advice how to import the data")
{
    const TempFolder folder;
    const auto scene_complaint = [&](const fs::path& file) {
        try {
            load_scene(file);
        } catch (const FileError& error) {
            return std::string(error.what()).substr(file.string().size());
        }
        return std::string();
    };
    const auto robot_complaint = [&](const fs::path& file) {
        try {
            load_robot(file.string());
        } catch (const FileError& error) {
            return std::string(error.what()).substr(file.string().size());
        }
        return std::string();
    };
    const std::string mujoco =
        "<?xml version=\"1.0\"?>\n<!-- not a <robot> -->\n<mujoco model='m'><worldbody/></mujoco>";
    struct Kind {
        std::string file, text, name, scene, robot;
    };
    for (const Kind& kind :
         {Kind{"a.usd", "", "a USD file", "GLB", "URDF"}, Kind{"a.usda", "", "a USD file", "GLB", "URDF"},
          Kind{"a.USDC", "", "a USD file", "GLB", "URDF"}, Kind{"a.usdz", "", "a USD file", "GLB", "URDF"},
          Kind{"a.unity", "", "a Unity scene", "GLB in Unity", "URDF"},
          Kind{"a.umap", "", "an Unreal Engine file", "GLB in Unreal", "URDF"},
          Kind{"a.blend", "BLENDER-v300", "a Blender file", "GLB in Blender", "STL"},
          Kind{"a.urdf.xacro", "", "a xacro file", "xacro a.urdf.xacro > scene.urdf",
               "xacro a.urdf.xacro > robot.urdf"},
          Kind{"a.rviz", "", "an RViz configuration", "no geometry", "URDF"},
          Kind{"a.xml", mujoco, "a MuJoCo model (MJCF)", "scene.yaml", "URDF"},
          Kind{"a.mjcf", "", "a MuJoCo model (MJCF)", "scene.yaml", "robot.yaml"}}) {
        CAPTURE(kind.file);
        const fs::path file = folder.write(kind.file, kind.text);
        CHECK_THAT(scene_complaint(file),
                   Contains(": is " + kind.name + ", which cannot be read here; ") && Contains(kind.scene));
        CHECK_THAT(robot_complaint(file),
                   Contains(": is " + kind.name + ", which cannot be read here; ") && Contains(kind.robot));
    }
    CHECK_NOTHROW(refuse_foreign_robot(folder.write("b.xml", "<robot name='mujoco'/>")));
}

TEST_CASE("a file or folder that is not a map is refused, and the message names what it is")
{
    const Arena arena;
    const auto said = [&](const std::string& file) {
        const ProgramRun run = arena("sample " + file + " -n 1" + box);
        CHECK(run.status == 4);
        return run.err;
    };
    arena.write("scene.yaml", "format: spawnfield-scene/1\nparts: []\n");
    arena.write("robot.yaml", "format: spawnfield-robot/1\nparts: []\n");
    arena.write("a.usd", "");
    CHECK(said("scene.yaml") ==
          "spawnfield: scene.yaml: is a file, and a map is a folder; bake a scene first: "
          "spawnfield bake scene.yaml -o MAP\n");
    CHECK(said("robot.yaml") ==
          "spawnfield: robot.yaml: is a robot, not a map; give it as --robot robot.yaml, and a map folder before it\n");
    CHECK(said("map/map.yaml") == "spawnfield: map/map.yaml: is a file of a map; give its folder, map\n");
    CHECK_THAT(said("a.usd"), Contains("is a USD file"));
    CHECK(said("none") == "spawnfield: none: does not exist; is the path right?\n");
}

TEST_CASE("a robot that is probably in millimetres, or larger than the map, gets a notice")
{
    const Arena arena;
    arena.write("p.csv", "x,y,z\n0,3,0.1\n");
    arena.write("mm.yaml", "format: spawnfield-robot/1\nparts: [{box: [990, 670, 390]}]\n");
    const ProgramRun run = arena("check map --poses p.csv --robot mm.yaml");
    CHECK(run.status == 0);
    CHECK_THAT(run.err, Contains("notice: mm.yaml: is 990 x 670 x 390 m; if it is in millimetres or centimetres, "
                                 "divide lengths and positions by 1000 "
                                 "or 100, ") &&
                            Contains("notice: the robot is 990 x 670 m, larger than the map (20.2 x 20.2 m); "));
    CHECK_THAT(arena("info mm.yaml").err, Contains("if it is in millimetres"));
    CHECK_THAT(arena("check map --poses p.csv --robot box:60,1,1").err,
               Contains("if it is in millimetres or centimetres, divide its lengths by 1000 or 100"));
    CHECK_THAT(arena("check map --poses p.csv --robot box:20,20,1").err, !Contains("notice"));
    CHECK_THAT(arena("check map --poses p.csv --robot box:3000,1,1").err,
               Contains("needs at most 1000 m; is it in millimetres or centimetres?"));
}

// ---- spelling ----

TEST_CASE("misspelled options, values and commands get a suggestion")
{
    const Arena arena;
    const auto said = [&](const std::string& arguments) {
        const ProgramRun run = arena(arguments);
        CHECK(run.status == 2);
        return run.err;
    };
    const std::string sample = "sample map -n 1" + box;
    CHECK(said(sample + "--min-dist 2") ==
          "spawnfield: --min-dist is not an option of sample; did you mean --min-distance?" + usage_hint);
    CHECK(said(sample + "--min-distnace=2") ==
          "spawnfield: --min-distnace is not an option of sample; did you mean --min-distance?" + usage_hint);
    CHECK(said("sample --min-dist 2 map -n 1" + box) ==
          "spawnfield: --min-dist is not an option of sample; did you mean --min-distance?" + usage_hint);
    CHECK(said(sample + "--distance 2") ==
          "spawnfield: --distance is not an option of sample; did you mean --min-distance, --distance-to or "
          "--avoid-distance?" +
              usage_hint);
    CHECK(said("check map --robt box:1,1,1 --poses p.csv") ==
          "spawnfield: --robt is not an option of check; did you mean --robot?" +
              usage_hint);  // although --robot is missing, too
    CHECK(said(sample + "--frobnicate") == "spawnfield: --frobnicate is not an option of sample" + usage_hint);
    CHECK_THAT(said(sample + "--format ros2"), Contains("\"ros2\" is not one of csv, json, ") &&
                                                   Contains("; did you mean ros2-launch-py or ros2-launch-xml?"));
    CHECK_THAT(said(sample + "--format cvs"), Contains("; did you mean csv?"));
    CHECK_THAT(said(sample + "--format xyz"), !Contains("did you mean"));
    CHECK_THAT(said("export map --format geotif -o a.tif"), Contains("; did you mean geotiff?"));
    CHECK_THAT(said("heatmap map -o a.png --quantity clearence" + box), Contains("; did you mean clearance?"));
    CHECK_THAT(said("raster map --dims 4 --step 1" + box), Contains("\"4\" is not one of 2, 3"));
    CHECK_THAT(said("smaple map"), Contains("smaple is not a command") && Contains("; did you mean sample?"));
    CHECK_THAT(said("--vesion"), Contains("--vesion is not an option of spawnfield; did you mean --version?"));
}
