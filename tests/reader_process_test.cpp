#include "this_build.h"
#include "apart/scene_fields.h"
#include "catch.h"
#include "program.h"
#include "shared_scenes.h"

#include <spawnfield/error.h>
#include <spawnfield/reader_process.h>

#include <signal.h>

using namespace spawnfield;
namespace fs = std::filesystem;

namespace {

ReaderProcess this_program() { return {program_file()}; }

template <class T>
std::string bytes_of_value(T value)
{
    ArchiveWriter out;
    out(value);
    return out.take();
}

/// A shell script that takes the place of the program.
ReaderProcess script(const TempFolder& folder, const std::string& text)
{
    const fs::path file = folder.write("reader.sh", "#!/bin/sh\n" + text + "\n");
    fs::permissions(file, fs::perms::owner_all);
    return {file};
}

const std::string box_scene = "format: spawnfield-scene/1\nparts: [{name: floor, label: terrain, box: [8, 8, 1]}]\n";

std::string complaint(const fs::path& file, const ReaderProcess& process)
{
    try {
        load_scene_apart(file, {}, process);
    } catch (const FileError& error) {
        return error.what();
    }
    return "";
}

/// Returns the scene as bytes, or the text of the FileError.
template <class Load>
std::string outcome(Load load)
{
    try {
        return bytes_of_value(load());
    } catch (const FileError& error) {
        return error.what();
    }
}

void check_same(const fs::path& file, const SceneOptions& options = {})
{
    CAPTURE(file);
    const std::string apart = outcome([&] { return load_scene_apart(file, options, this_program()); });
    CHECK((apart == outcome([&] { return load_scene(file, options); })));
}

}  // namespace

TEST_CASE("a scene and a robot that another process reads are the same")
{
    const TempFolder folder;
    folder.write("crate.obj",
                 "o a\nusemtl m\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
    const fs::path scene = folder.write(
        "scene.yaml",
        "format: spawnfield-scene/1\nparts:\n- {name: floor, label: terrain, box: [8, 8, 1]}\n- {name: s, sphere: 1, "
        "xyz: [1, 2, 3], rpy_deg: [1, 2, 3]}\n- {name: m, mesh: crate.obj, solid: true}\n- {name: w, label: water, "
        "plane: [5, "
        "5]}\n");
    check_same(scene, {.labels = {{"m", Label::Terrain}}, .bounds = {Vec3(-9, -9, -9), Vec3(9, 9, 9)}});
    check_same(folder / "crate.obj", {.auto_slope = 0.5, .up = 'y', .scale = 2});
    const fs::path robot = folder.write("robot.yaml",
                                        "format: spawnfield-robot/1\ndrive: car\nturning_radius: 2\nparts: [{name: a, "
                                        "mesh: crate.obj}, {box: [1, 1, 1]}]\n"
                                        "contacts: [[0, 0, 0], [1, 0, 0], [0, 1, 0]]\nmass_center: [0.1, 0.2, 0.3]\n");
    CHECK(bytes_of_value(load_robot_apart(robot.string(), {.mesh_parts = 2}, this_program())) ==
          bytes_of_value(load_robot(robot.string(), {.mesh_parts = 2})));
}

TEST_CASE("real scenes and robots that another process reads are the same", "[real]")
{
    const std::optional<fs::path> scenes = shared_scenes();
    if (!scenes) return;
    const std::string husky = (*scenes / "robot_husky/husky_description/urdf/husky.urdf").string();
    CHECK(bytes_of_value(load_robot_apart(husky, {}, this_program())) == bytes_of_value(load_robot(husky, {})));
    for (const auto& entry : fs::recursive_directory_iterator(*scenes)) {
        const std::string extension = entry.path().extension().string();
        const bool is_scene = extension == ".bt" || extension == ".world" || extension == ".tif" || extension == ".asc";
        if (is_scene) check_same(entry.path(), {.allow_missing = true});
    }
}

TEST_CASE("errors of another process are the same")
{
    const TempFolder folder;
    const auto check = [&](const fs::path& file, const SceneOptions& options, auto error) {
        using Error = decltype(error);
        CAPTURE(file);
        std::string here = "nothing", apart;
        try {
            load_scene(file, options);
        } catch (const Error& caught) {
            here = caught.what();
        }
        try {
            load_scene_apart(file, options, this_program());
        } catch (const Error& caught) {
            apart = caught.what();
        }
        CHECK(here == apart);
    };
    const fs::path scene = folder.write("scene.yaml", box_scene);
    check(folder / "missing.yaml", {}, FileError("", ""));
    check(folder.write("bad.yaml", "parts: 3\n"), {}, FileError("", ""));
    check(folder.write("a: b.stl", "x"), {}, FileError("", ""));
    check(scene, {.scale = -1}, ArgumentError(""));
    check(scene, {.up = 'y'}, ArgumentError(""));
    CHECK_THROWS_WITH(load_robot_apart((folder / "mesh.yaml").string(), {}, this_program()),
                      Contains("mesh.yaml: does not exist"));
}

TEST_CASE("a process that crashes, ends, waits or sends rubbish gives an error with the name of the file")
{
    const TempFolder folder;
    const fs::path file = folder.write("scene.yaml", box_scene);
    const std::string start = file.string() + ": the reader ";
    CHECK_THAT(complaint(file, script(folder, "kill -SEGV $$")),
               Catch::Matchers::StartsWith(start + "crashed (signal 11, "));
    CHECK_THAT(complaint(file, script(folder, "exit 3")), Catch::Matchers::StartsWith(start + "ended with status 3"));
    CHECK_THAT(complaint(file, script(folder, "exit 0")), Catch::Matchers::StartsWith(start + "ended with status 0"));
    CHECK_THAT(complaint(file, script(folder, "kill -XCPU $$")),
               Catch::Matchers::StartsWith(start + "needs more than "));
    CHECK_THAT(complaint(file, script(folder, "head -c 5000 /dev/zero | tr '\\0' 'a' >&4")),
               Contains("the reader gave"));
    CHECK_THROWS_AS(load_scene_apart(file, {}, {folder / "missing"}), std::runtime_error);
    if (!is_slow_build()) CHECK_THAT(complaint(file, script(folder, "exec sleep 100")), Contains("waited for 15 s"));
}

TEST_CASE("a process ends when the caller stops waiting")
{
    const TempFolder folder;
    const fs::path file = folder.write("scene.yaml", box_scene), pid = folder / "pid";
    ReaderProcess process = script(folder, "echo $$ > '" + pid.string() + ".new'; mv '" + pid.string() + ".new' '" +
                                               pid.string() + "'; exec sleep 100");
    process.wait = [&] {
        if (fs::exists(pid)) throw std::domain_error("stop");
    };
    CHECK_THROWS_AS(load_scene_apart(file, {}, process), std::domain_error);
    const int number = std::stoi(bytes_of(pid));
    CHECK((kill(number, 0) == -1 && errno == ESRCH));
}

TEST_CASE("the mesh reader cannot crash the program, fill the memory or run for ever")
{
    const TempFolder folder;
    std::string deep = "; FBX 7.3.0 project file\nFBXHeaderExtension: {\nFBXVersion: 7300\n}\n";
    for (int k = 0; k < 100000; ++k) deep += "a: {\n";
    const fs::path file = folder.write("deep.fbx", deep);
    CHECK_THAT(complaint(file, this_program()), Catch::Matchers::StartsWith(file.string() + ": the mesh reader "));
    folder.write("robot.yaml", "format: spawnfield-robot/1\nparts: [{mesh: deep.fbx}]\n");
    const ProgramRun run = run_program(folder, "info robot.yaml");
    CHECK(run.status == 4);
    CHECK_THAT(run.err, Contains("deep.fbx: the mesh reader "));

    if (is_slow_build()) return;  // sanitizers have no limit of memory
    folder.write("loop.csm", "$FirstFrame 0\n$LastFrame 0\n$Order\nA\n0  1.0 2.0 3.0\n");
    folder.write("loop.ogex", "A {\n B (x = \"y\") { float { 1 } }\n P");
    const ProgramRun memory = run_program(folder, "bake loop.csm -o map --any-mesh");
    CHECK(memory.status == 4);
    CHECK_THAT(memory.err,
               Contains("loop.csm: the mesh reader needs more than 0.9 GB of memory, the limit for files of "
                        "this size"));
    const ProgramRun less = run_program(folder, "info loop.csm --any-mesh --max-memory 300MB");
    CHECK(less.status == 4);
    CHECK_THAT(less.err,
               Contains("loop.csm: the mesh reader needs more than 0.3 GB of memory, the limit that was given "
                        "(--max-memory)"));
    const ProgramRun time = run_program(folder, "bake loop.ogex -o map --any-mesh");
    CHECK(time.status == 4);
    CHECK_THAT(time.err, Contains("loop.ogex: the mesh reader needs more than 13 s of processor time"));
}

TEST_CASE("a scene or robot with wrong indices is refused, and bytes that are cut or altered give no undefined value")
{
    const TempFolder folder;
    folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
    const fs::path file = folder.write(
        "scene.yaml", "format: spawnfield-scene/1\nparts: [{name: a, mesh: a.obj}, {name: b, sphere: 1}]\n");
    const Scene good = load_scene(file);
    CHECK(fault_of(good) == "");
    const auto fault = [&](auto change) {
        Scene scene = good;
        change(scene);
        return fault_of(scene);
    };
    CHECK(fault([](Scene& s) { s.triangles[3][1] = 4; }) == "a triangle has a vertex that does not exist");
    CHECK(fault([](Scene& s) { s.triangle_labels.pop_back(); }) == "arrays of triangles differ in length");
    CHECK(fault([](Scene& s) { s.vertices[0].x() = NAN; }) == "a vertex is not finite");
    CHECK(fault([](Scene& s) { s.pieces[0].part = 2; }) == "a piece has a triangle or a part that does not exist");
    CHECK(fault([](Scene& s) { ++s.pieces[0].triangle_count; }) ==
          "a piece has a triangle or a part that does not exist");
    CHECK(fault([](Scene& s) { s.triangle_pieces[0] = 1; }) == "a triangle has a piece that does not exist");
    const std::string ignored = "an element has the label `ignore`, so it should have been left out";
    CHECK(fault([](Scene& s) { s.triangle_labels[0] = Label::Ignore; }) == ignored);
    CHECK(fault([](Scene& s) { s.primitives[0].label = Label::Ignore; }) == ignored);
    CHECK(fault([](Scene& s) { s.primitives[0].part = 2; }) ==
          "a primitive has no extent, or a part that does not exist");
    CHECK(fault([](Scene& s) { s.primitives[0].shape.size.x() = -1; }) ==
          "a primitive has no extent, or a part that does not exist");
    CHECK(fault([](Scene& s) { s.face_groups[0].part = 2; }) == "a group of faces has a part that does not exist");
    CHECK(fault([](Scene& s) { s.triangle_groups[0] = 2; }) == "a triangle has a group of faces that does not exist");
    Robot robot = load_robot("box:1,1,1");
    CHECK(fault_of(robot) == "");
    robot.parts[0].shape.size.x() = 0;
    CHECK(fault_of(robot) == "a part of a robot has no extent");
    robot.parts.clear();
    CHECK(fault_of(robot) == "a robot has no part");

    const std::string bytes = bytes_of_value(good);
    const auto read = [](const std::string& harmed) {
        Scene scene;
        try {
            ArchiveReader in(harmed);
            in(scene);
        } catch (const std::out_of_range&) {
            return false;
        }
        CHECK(std::all_of(scene.triangle_labels.begin(), scene.triangle_labels.end(),
                          [](Label label) { return label <= Label::Ignore; }));
        return true;
    };
    CHECK(read(bytes));
    for (std::size_t size = 0; size < bytes.size(); ++size) CHECK_FALSE(read(bytes.substr(0, size)));
    for (std::size_t at = 0; at < bytes.size(); ++at) {
        std::string harmed = bytes;
        harmed[at] = char(harmed[at] ^ 0xff);
        read(harmed);
    }
}

TEST_CASE("files outside of the folders of --confine are refused, also by links; others are listed")
{
    const TempFolder folder;
    const std::string mesh = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    folder.write("in/scene.yaml", "format: spawnfield-scene/1\nparts: [{name: a, label: terrain, mesh: a.obj}]\n");
    folder.write("in/a.obj", mesh);
    folder.write("in/up.yaml", "format: spawnfield-scene/1\nparts: [{name: a, label: terrain, mesh: ../b.obj}]\n");
    folder.write("in/link.yaml", "format: spawnfield-scene/1\nparts: [{name: a, label: terrain, mesh: link.obj}]\n");
    folder.write("b.obj", mesh);
    fs::create_symlink("../b.obj", folder / "in/link.obj");
    folder.write("in2/model.config",
                 "<?xml version='1.0'?><model><name>m</name><sdf version='1.6'>m.sdf</sdf></model>");
    folder.write("in2/m.sdf",
                 "<?xml version='1.0'?><sdf version='1.6'><model name='m'><link name='l'><collision name='c'>"
                 "<geometry><box><size>1 1 1</size></box></geometry></collision></link></model></sdf>");
    folder.write("in/w.world",
                 "<?xml version='1.0'?><sdf version='1.6'><world name='w'><include><uri>model://in2</uri>"
                 "</include></world></sdf>");
    folder.write("in/robot.yaml", "format: spawnfield-robot/1\nparts: [{mesh: ../b.obj}]\n");
    const std::string words =
        ", outside of the folders from which files may be read; move it there, or allow its folder, too (--confine)";
    const fs::path real = fs::canonical(folder.path());

    CHECK(run_program(folder, "info in/scene.yaml --confine in").status == 0);
    for (const std::string scene : {"up", "link"}) {
        const ProgramRun run = run_program(folder, "info in/" + scene + ".yaml --confine in");
        CAPTURE(run.err);
        CHECK(run.status == 4);
        CHECK_THAT(run.err, Contains((real / "b.obj").string() + words));
        CHECK(run_program(folder, "info in/" + scene + ".yaml --confine in --confine .").status == 0);
    }
    const ProgramRun world = run_program(folder, "info in/w.world --confine in");
    CHECK(world.status == 4);
    CHECK_THAT(world.err, Contains("in/w.world: line 1: <include> <uri> model://in2: cannot be used: ") &&
                              Contains(words.substr(2)));
    const std::string model =
        "<model name='m'><link name='l'><collision name='c'><geometry><mesh><uri>../b.obj</uri>"
        "</mesh></geometry></collision></link></model>";
    folder.write("in/mesh.sdf", "<?xml version='1.0'?><sdf version='1.6'>" + model + "</sdf>");
    folder.write("in/mesh.world",
                 "<?xml version='1.0'?><sdf version='1.6'><world name='w'>" + model + "</world></sdf>");
    CHECK_THAT(run_program(folder, "info in/mesh.world --confine in").err,
               Contains("in/mesh.world: \"m::l::c\": ") && Contains((real / "b.obj").string() + words));
    CHECK_THAT(run_program(folder, "info in/mesh.sdf --confine in").err,
               Contains("in/mesh.sdf: link \"l\": collision \"c\": <mesh> cannot be used: ") &&
                   Contains((real / "b.obj").string() + words));
    CHECK(run_program(folder, "info in/w.world --confine in --confine in2").status == 0);
    CHECK(run_program(folder, "info in/robot.yaml --confine in").status == 4);
    folder.write("own.yaml", "format: spawnfield-scene/1\nparts: [{name: a, label: terrain, mesh: in/a.obj}]\n");
    CHECK(run_program(folder, "info own.yaml --confine in").status == 0);  // the file of the command line is allowed
    folder.write("plane.world",
                 "<?xml version='1.0'?><sdf version='1.6'><world name='w'><include><uri>model://ground_plane</uri>"
                 "</include></world></sdf>");
    CHECK_THAT(run_program(folder, "info plane.world").out, !Contains("outside"));  // it is built in
    CHECK(run_program(folder, "info in/up.yaml --confine in --trusted").status == 2);

    CHECK_THAT(run_program(folder, "info in/up.yaml").out,
               Contains("files from outside of its folder: 1\n  " + (real / "b.obj").string() + "\n"));
    CHECK_THAT(run_program(folder, "info in/scene.yaml").out, !Contains("outside"));
    const ProgramRun bake = run_program(folder, "bake in/up.yaml -o map --summary s.json");
    CHECK_THAT(bake.err, Contains("1 file from outside of the scene's folder; "));
    CHECK_THAT(bytes_of(folder / "s.json"), Contains("\"outside_files\": [\n    \"" + (real / "b.obj").string()));
}

TEST_CASE("audit reads only files of the scene's project, of folders that are named, and downloaded models")
{
    const TempFolder folder;
    const std::string mesh = "v -2 -2 0\nv 2 -2 0\nv 2 2 0\nv -2 2 0\nf 1 2 3\nf 1 3 4\n";
    for (const std::string file : {"project/worlds/a.obj", "project/meshes/a.obj", "other/a.obj"})
        folder.write(file, mesh);
    const auto scene = [&](const std::string& name, const std::string& file) {
        folder.write("project/" + name,
                     "format: spawnfield-scene/1\nparts: [{name: a, label: terrain, mesh: " + file + "}]\n");
    };
    scene("worlds/own.yaml", "a.obj");
    scene("worlds/beside.yaml", "../meshes/a.obj");
    scene("worlds/beyond.yaml", "../../other/a.obj");
    scene("beyond.yaml", "../other/a.obj");
    const auto audit = [&](const std::string& words) {
        return run_program(folder, "audit project/" + words + " --robot box:0.3,0.2,0.2");
    };
    for (const std::string name : {"worlds/own", "worlds/beside"}) CHECK(audit(name + ".yaml").status == 0);
    for (const std::string name : {"worlds/beyond", "beyond"}) {
        const ProgramRun run = audit(name + ".yaml");
        CAPTURE(run.err);
        CHECK(run.status == 4);
        CHECK_THAT(run.err, Contains("other/a.obj, outside of the folders from which files may be read"));
        for (const std::string allowed : {"--confine .", "--confine /", "--trusted", "--model-path other"})
            CHECK(audit(name + ".yaml " + allowed).status == 0);
        CHECK(run_program(folder, "info project/" + name + ".yaml").status == 0);
    }
    CHECK(audit("worlds/beside.yaml --confine project/worlds").status == 4);
    folder.write("project/robot.yaml", "format: spawnfield-robot/1\nparts: [{mesh: ../other/a.obj}]\n");
    CHECK(run_program(folder, "audit project/worlds/own.yaml --robot project/robot.yaml").status == 4);
}
