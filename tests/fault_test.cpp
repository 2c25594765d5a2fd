#include "catch.h"
#include "geometry/geometry_impl.h"
#include "base/checksum.h"
#include "free_space/bounds_tile.h"
#include "map/bounds_file.h"
#include "map/geometry_file.h"
#include "mesh_text.h"
#include "scene_text.h"
#include "test_map.h"

#include <spawnfield/error.h>
#include <spawnfield/poses.h>

#include <opencv2/imgcodecs.hpp>

#include <xxhash.h>

#include <limits>

using namespace spawnfield;
namespace fs = std::filesystem;

namespace {

constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();

/// Returns what the call throws, with @ for the folder: "" if nothing, "…?" if it is not an error of the library.
template <class Call>
std::string complaint(const TempFolder& folder, const Call& call)
{
    std::string what;
    try {
        call();
    } catch (const FileError& error) {
        what = error.what();
    } catch (const ArgumentError& error) {
        what = error.what();
    } catch (const OutputError& error) {
        what = error.what();
    } catch (const std::exception& error) {
        what = std::string(error.what()) + "?";
    }
    const std::string path = folder.path().string();
    for (std::size_t at = what.find(path); at != std::string::npos; at = what.find(path))
        what.replace(at, path.size(), "@");
    return what;
}

std::string part_complaint(const TempFolder& folder, const std::string& part)
{
    return complaint(folder, [&] { load_parts(folder, "  - " + part + "\n"); });
}

/// Bakes a small map with a floor, a ball and a mesh.
void bake_small(const TempFolder& folder)
{
    folder.write("house.obj", mesh_text::obj(hand::without(hand::box({1, 1, 1}), 0, 2)));
    const Scene scene = load_parts(
        folder,
        "  - {name: floor, label: terrain, box: [6, 4, 0.1]}\n  - {name: ball, sphere: 1, xyz: [2, 0, 0]}\n"
        "  - {name: house, mesh: house.obj, xyz: [-2, 0, 0.5]}\n");
    BakeOptions options{.resolution = 0.5};
    bake(scene, folder / "scene.yaml", folder / "map", options);
}

/// Checks that a good file gives a result or a FileError if it is cut at every step-th byte, or if that byte is
/// altered.
enum class Harm { Cut, CutAndAltered };
template <class Read>
void check_harmed(const TempFolder& folder, const std::string& name, const std::string& good, std::size_t step,
                  const Read& read, Harm harm = Harm::CutAndAltered)
{
    std::size_t results = 0, refused = 0;
    const auto look = [&](const std::string& bytes) {
        folder.write(name, bytes);
        try {
            read(folder / name);
            ++results;
        } catch (const FileError& error) {
            ++refused;
            CHECK_THAT(error.what(), Contains(name));
        }
    };
    for (std::size_t size = 0; size < good.size(); size += step) look(good.substr(0, size));
    CHECK(refused > 0);
    for (std::size_t at = 0; harm == Harm::CutAndAltered && at < good.size(); at += step) {
        std::string bad = good;
        bad[at] = char(bad[at] ^ 0x41);
        look(bad);
    }
    look(good);
    CHECK(results > 0);
}

}  // namespace

TEST_CASE("a scene beyond the range of exact distances is refused, and the part is named")
{
    const TempFolder folder;
    const auto refused = [&](const std::string& part) {
        return folder.write(
            "scene.yaml",
            "format: spawnfield-scene/1\nparts:\n  - {name: floor, label: terrain, box: [1, 1, 1]}\n  - {name: far, " +
                part + "}\n");
    };
    const std::string far = (folder / "scene.yaml").string() + ": part \"far\" reaches from ";
    for (const char* const part : {"box: [1, 1, 1], xyz: [0, 0, 1e16]", "box: [1e300, 1, 1]",
                                   "capsule: {radius: 1e200, length: 1}", "sphere: 1, xyz: [-1.1e7, 0, 0]"})
        CHECK_THROWS_WITH(load_scene(refused(part)),
                          Catch::StartsWith(far) && Catch::Contains("needs to lie within 1e+07 m of 0, 0, 0"));
    CHECK(load_scene(refused("sphere: 1, xyz: [5e6, 0, 0]")).primitives.size() == 2);
    CHECK_THROWS_AS(load_scene(refused("sphere: 1"), {.bounds = {Vec3(-1e8, 0, 0), Vec3(1, 1, 1)}}), ArgumentError);
    fs::create_symlink(folder / "a.yaml", folder / "b.yaml");
    fs::create_symlink(folder / "b.yaml", folder / "a.yaml");
    CHECK_THROWS_WITH(load_scene(folder / "a.yaml"),
                      (folder / "a.yaml").string() + ": cannot be reached: Too many levels of symbolic links");
}

TEST_CASE("every mistake in a scene file is reported with file, part, key, value and limit")
{
    const TempFolder folder;
    folder.write("box.obj", mesh_text::obj(hand::box({1, 1, 1})));
    const std::pair<std::string, std::string> parts[] = {
        {"{name: tank, capsule: {radius: -1, length: 2}}", "capsule.radius is -1, needs > 0 (line 4)"},
        {"{name: tank, capsule: {radius: 1, length: 0}}", "capsule.length is 0, needs > 0 (line 4)"},
        {"{name: tank, cylinder: {radius: 1}}", "cylinder.length is missing"},
        {"{name: tank, cylinder: {radius: 1, length: 1, height: 1}}",
         "cylinder.height is not a known key; known keys: radius, length (line 4)"},
        {"{name: tank, cylinder: 3}", "cylinder is 3, needs a mapping (key: value) (line 4)"},
        {"{name: tank, box: [1, 1, 0]}", "box has 0, needs > 0 (line 4)"},
        {"{name: tank, box: [1, -1, 1]}", "box has -1, needs > 0 (line 4)"},
        {"{name: tank, box: [1, 1]}", "box has 2 numbers, needs 3 (line 4)"},
        {"{name: tank, box: 1}", "box is 1, needs a list (line 4)"},
        {"{name: tank, box: [1, 1, nan]}", "box is nan, needs a finite number (line 4)"},
        {"{name: tank, box: [1, .inf, 1]}", "box is .inf, needs a finite number (line 4)"},
        {"{name: tank, box: [1, banana, 1]}", "box is \"banana\", needs a number (line 4)"},
        {"{name: tank, box: [1, [2], 1]}", "box is \"a list\", needs a number (line 4)"},
        {"{name: tank, sphere: 0}", "sphere is 0, needs > 0 (line 4)"},
        {"{name: tank, sphere: big}", "sphere is \"big\", needs a number (line 4)"},
        {"{name: tank, sphere: }", "sphere is \"empty\", needs a number (line 4)"},
        {"{name: tank, plane: [1, 0]}", "plane has 0, needs > 0 (line 4)"},
        {"{name: tank, sphere: 1, xyz: [0, 0, .nan]}", "xyz is .nan, needs a finite number (line 4)"},
        {"{name: tank, sphere: 1, xyz: [0, 0]}", "xyz has 2 numbers, needs 3 (line 4)"},
        {"{name: tank, sphere: 1, rpy: [0, 0, 0], rpy_deg: [0, 0, 0]}",
         "rpy_deg is given together with rpy, needs only one of them (line 4)"},
        {"{name: tank, sphere: 1, colour: red}",
         "colour is not a known key; known keys: name, label, xyz, rpy, rpy_deg, sphere (line 4)"},
        {"{name: tank, sphere: 1, sides: up}",
         "sides is not a known key; known keys: name, label, xyz, rpy, rpy_deg, sphere (line 4)"},
        {"{name: tank, sphere: 1, box: [1, 1, 1]}",
         "sphere is given together with box, needs one geometry per part (line 4)"},
        {"{name: tank, label: terrain}",
         "has no geometry, needs one of box, sphere, cylinder, capsule, plane, mesh, heightmap, octomap (line 4)"},
        {"{name: tank, sphere: 1, label: grass}",
         "label is \"grass\", needs one of terrain, obstacle, water, ignore (line 4)"},
        {"{name: tank, plane: [1, 1], sides: down}", "sides is \"down\", needs one of both, up (line 4)"},
        {"{name: tank, mesh: box.obj, up: x}", "up is \"x\", needs one of y, z (line 4)"},
        {"{name: tank, mesh: box.obj, solid: perhaps}",
         "solid is \"perhaps\", needs one of auto, true, false (line 4)"},
        {"{name: tank, mesh: box.obj, scale: 0}", "scale is 0, needs > 0 (line 4)"},
        {"{name: tank, mesh: box.obj, scale: [1, 1, -1]}", "scale has -1, needs > 0 (line 4)"},
        {"{name: tank, mesh: box.obj, labels: terrain}", "labels is terrain, needs a list (line 4)"},
        {"{name: tank, mesh: box.obj, labels: [{node: a}]}", "labels: label is missing"},
        {"{name: tank, mesh: box.obj, labels: [{label: water}]}",
         "labels: has neither node nor material, needs one of them or both (then both must match) (line 4)"},
        {"{name: tank, mesh: box.obj, labels: [{node: a, label: sea}]}",
         "labels: label is \"sea\", needs one of terrain, obstacle, water, ignore (line 4)"},
        {"{name: tank, mesh: none.obj}",
         "mesh cannot be used: @/none.obj: does not exist; is the path right? (line 4)"},
        {"{name: tank, mesh: .}", "mesh cannot be used: @/.: is a folder, needs a file (line 4)"},
        {"{name: tank, mesh: [a]}", "mesh is a list, needs text (line 4)"},
        {"{name: tank, octomap: none.bt}",
         "octomap cannot be used: @/none.bt: does not exist; is the path right? (line 4)"},
    };
    for (const auto& [part, wanted] : parts)
        CHECK(part_complaint(folder, part) == "@/scene.yaml: part \"tank\": " + wanted);
    CHECK(part_complaint(folder, "{sphere: 1}") == "@/scene.yaml: part 1: name is missing");
    CHECK(part_complaint(folder, "{name: a, sphere: 1, sphere: 2}") ==
          "@/scene.yaml: part 1: sphere is given twice (line 4)");
    CHECK(part_complaint(folder, "tank") == "@/scene.yaml: part 1: is tank, needs a mapping (key: value) (line 4)");
    CHECK(part_complaint(folder, "{name: a, sphere: 1}\n  - {name: a, sphere: 1}") ==
          "@/scene.yaml: part \"a\": name is also the name of an earlier part, needs to be unique (line 5)");
}

TEST_CASE("a file that is not a scene file is refused with the reason")
{
    const TempFolder folder;
    const std::pair<std::string, std::string> files[] = {
        {"", "is empty, needs a mapping (key: value)"},
        {"- 1\n", "is a list, needs a mapping (key: value) (line 1)"},
        {"name: a\n", "format is missing"},
        {"format: spawnfield-scene/2\nparts: []\n",
         "format is \"spawnfield-scene/2\", needs spawnfield-scene/1 (line 1)"},
        {"format: spawnfield-robot/1\nparts: []\n",
         "format is \"spawnfield-robot/1\", needs spawnfield-scene/1 (line 1)"},
        {"format: spawnfield-scene/1\n", "parts is missing"},
        {"format: spawnfield-scene/1\nparts: []\n", "parts is empty, needs at least one part (line 2)"},
        {"format: spawnfield-scene/1\nparts: {a: 1}\n", "parts is a mapping, needs a list (line 2)"},
        {"format: spawnfield-scene/1\npart: []\n", "part is not a known key; known keys: format, name, parts (line 2)"},
        {"format: spawnfield-scene/1\nparts: [{name: a, label: ignore, sphere: 1}]\n",
         "has no geometry: all parts are ignored"},
        {"format: spawnfield-scene/1\nparts: [\n", "line 3: end of sequence flow not found"},
    };
    for (const auto& [text, wanted] : files) {
        const fs::path file = folder.write("scene.yaml", text);
        CHECK(complaint(folder, [&] { load_scene(file); }) == "@/scene.yaml: " + wanted);
    }
    CHECK(complaint(folder, [&] { load_scene(folder / "none.yaml"); }) ==
          "@/none.yaml: does not exist; is the path right?");
    CHECK(complaint(folder, [&] { load_scene(folder.path()); }) ==
          "@: is a folder without model.config and without a .sdf file, so it is not a model; give the folder of a "
          "model, or an SDF file");
    const fs::path good = folder.write("scene.yaml", "format: spawnfield-scene/1\nparts: [{name: a, sphere: 1}]\n");
    CHECK(complaint(folder, [&] { load_scene(good, {.up = 'y'}); }) ==
          "load_scene: up and scale are for a bare mesh; give them in @/scene.yaml (keys up, scale)");
    CHECK(complaint(folder, [&] { load_scene(good, {.scale = 0}); }) == "load_scene: scale is 0, needs > 0 m per unit");
    CHECK(complaint(folder, [&] { load_scene(good, {.scale = nan_value}); }) ==
          "load_scene: scale is nan, needs > 0 m per unit");
}

TEST_CASE("meshes that are empty, not finite or not meshes are refused by name")
{
    const TempFolder folder;
    const auto mesh_complaint = [&](const std::string& name, const std::string& bytes) {
        const fs::path file = folder.write(name, bytes);
        return complaint(folder, [&] { load_scene(file); });
    };
    const std::string start = "@/a.obj: cannot be read as a mesh: ";
    CHECK(mesh_complaint("a.obj", "").starts_with(start));
    CHECK(mesh_complaint("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n").starts_with("@/a.obj: "));
    CHECK(mesh_complaint("a.stl", "solid a\nendsolid a\n").starts_with("@/a.stl: "));
    CHECK(mesh_complaint("a.xyz", "hello").starts_with("@/a.xyz: has the extension \".xyz\", needs one of 3ds, "));
    CHECK(mesh_complaint("a.dae", "<COLLADA").starts_with("@/a.dae: cannot be read as a mesh: "));
    CHECK(mesh_complaint("a.obj", "v 0 0 0\nv 1 0 0\nv 1 0 0\nf 1 2 3\n") ==
          "@/a.obj: has no triangles, needs at least one");
    CHECK(mesh_complaint("a.obj", "o hill\nv 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n") ==
          "@/a.obj: node \"hill\": a vertex is (nan, 0, 0), needs finite coordinates");
    CHECK(mesh_complaint("a.obj", "o hill\nv 0 0 0\nv 1 0 0\nv 0 inf 0\nf 1 2 3\n") ==
          "@/a.obj: node \"hill\": a vertex is (0, inf, 0), needs finite coordinates");
}

TEST_CASE("options beyond their limits are refused with function, argument, value and limit")
{
    const TempFolder folder;
    const TestMap map = training_map();
    const Judge judge(map, husky());
    const auto raster_complaint = [&](auto change) {
        RasterOptions options;
        change(options);
        return complaint(folder, [&] { raster(judge, options); });
    };
    CHECK(raster_complaint([](auto& o) { o.step = 0; }) == "raster: step is 0, needs > 0 m");
    CHECK(raster_complaint([](auto& o) { o.step = nan_value; }) == "raster: step is nan, needs > 0 m");
    CHECK(raster_complaint([](auto& o) { o.step_z = -1; }) == "raster: step_z is -1, needs > 0 m");
    CHECK(raster_complaint([](auto& o) { o.dims = 4; }) == "raster: dims is 4, needs 2 or 3");
    CHECK(raster_complaint([](auto& o) { o.yaw = nan_value; }) == "raster: yaw is nan, needs a finite number, rad");
    CHECK(raster_complaint([](auto& o) { o.offset = nan_value; }) == "raster: offset is nan, needs a finite number, m");
    const auto judge_complaint = [&](const JudgeOptions& limits) {
        return complaint(folder, [&] { Judge(map, husky(), limits); });
    };
    for (const auto& [value, text] : {std::pair{-1.0, "-1"}, std::pair{nan_value, "nan"}}) {
        const std::string is_bad = std::string(" is ") + text + ", needs >= 0 m";
        CHECK(judge_complaint({.max_height = value}) == "Judge: max_height" + is_bad);
        CHECK(judge_complaint({.max_water_depth = value}) == "Judge: max_water_depth" + is_bad);
    }
    CHECK_THROWS_WITH(Judge(map, Robot{}), "Judge: the robot has no parts, needs at least one");
    CHECK(raster_complaint([](auto& o) {
              o.bounds = {{0, 5, 0}, {1, 4, 0}};
          }) == "raster: bounds.max.y is 4, needs at least bounds.min.y");
    CHECK(raster_complaint([](auto& o) {
              o.bounds = {{0, nan_value, 0}, {1, 4, 0}};
          }) == "raster: bounds.min.y is nan, needs a finite number, m");
    CHECK(raster_complaint([](auto& o) {
              o.bounds = {{0, 0, 1}, {1, 1, 0}};
          }).empty());  // in two dimensions z has no effect
    CHECK(raster_complaint([](auto& o) {
              o.dims = 3;
              o.bounds = {{0, 0, 1}, {1, 1, 0}};
          }) == "raster: bounds.max.z is 0, needs at least bounds.min.z");

    const auto spawn_complaint = [&](auto change) {
        SampleOptions options;
        change(options);
        return complaint(folder, [&] { sample(judge, options); });
    };
    CHECK(spawn_complaint([](auto& o) { o.count = 0; }) == "sample: count is 0, needs >= 1");
    CHECK(spawn_complaint([](auto& o) { o.min_distance = -1; }) == "sample: min_distance is -1, needs >= 0 m");
    CHECK(spawn_complaint([](auto& o) { o.yaw = nan_value; }) == "sample: yaw is nan, needs a finite number, rad");
    CHECK(spawn_complaint([](auto& o) {
              o.bounds = {{3, 0, 0}, {1, 4, 0}};
          }) == "sample: bounds.max.x is 1, needs at least bounds.min.x");
    SearchOptions search_options{.bounds = {{0, 0, 5}, {1, 1, 1}}};
    CHECK(complaint(folder, [&] { search(judge, search_options); }) ==
          "search: bounds.max.z is 1, needs at least bounds.min.z");
    search_options.bounds = {};
    search_options.max_failures = 0;
    CHECK(complaint(folder, [&] { search(judge, search_options); }) == "search: max_failures is 0, needs >= 1");
}

TEST_CASE("an error about an argument can be printed without the function")
{
    CHECK(std::string(ArgumentError("raster", "step", 0, "> 0 m").message()) == "step is 0, needs > 0 m");
    CHECK(std::string(ArgumentError("raster", "needs dims 3").message()) == "needs dims 3");
    CHECK(std::string(ArgumentError("--dims: 4").message()) == "--dims: 4");
}

TEST_CASE("a bake refuses bad options and a scene without terrain, and makes no folder")
{
    const TempFolder folder;
    const Scene floor = load_parts(folder, "  - {name: a, label: terrain, box: [1, 1, 1]}\n");
    const auto bake_complaint = [&](const Scene& scene, auto change) {
        BakeOptions options;
        change(options);
        const std::string what = complaint(folder,
                                           [&] { bake(scene, folder / "scene.yaml", folder / "map", options); });
        CHECK_FALSE(fs::exists(folder / "map"));
        CHECK(std::distance(fs::directory_iterator(folder.path()), {}) == 1);  // only the scene file
        return what;
    };
    CHECK(bake_complaint(floor, [](auto& o) { o.resolution = -0.1; }) ==
          "bake: resolution is -0.1, needs > 0 m (0: chosen)");
    CHECK(bake_complaint(floor, [](auto& o) { o.resolution = nan_value; }) ==
          "bake: resolution is nan, needs > 0 m (0: chosen)");
    CHECK(bake_complaint(floor, [](auto& o) { o.occupancy_resolution = -1; }) ==
          "bake: occupancy_resolution is -1, needs > 0 m (0: chosen)");
    CHECK(bake_complaint(floor, [](auto& o) {
              o.bounds = {{0, 0, 0}, {-1, 1, 1}};
          }) == "bake: bounds.max.x is -1, needs at least bounds.min.x");
    CHECK(bake_complaint(floor, [](auto& o) { o.resolution = 1e-6; }) ==
          "frame_around: columns at a cell of 1e-06 m is 1e+12, needs at most 1e+08; take a coarser resolution");
    CHECK(bake_complaint(floor,
                         [](auto& o) {
                             o.bounds = {{0, 0, 0.75}, {1, 1, 2}};
                         }) ==
          "@/scene.yaml: bounds are 0, 0, 0.75 to 1, 1, 2 m, need to meet the scene: -0.5, -0.5, -0.5 to 0.5, 0.5, 0.5 "
          "m");
    CHECK(bake_complaint(load_parts(folder, "  - {name: a, box: [1, 1, 1]}\n"), [](auto&) {}) ==
          "@/scene.yaml: has no terrain, so no robot can stand anywhere; label a part `terrain` (--label "
          "'GLOB=terrain') or pass "
          "--allow-no-terrain");
}

TEST_CASE("a map folder that is cut short, altered, newer or not a map is refused, and the file is named")
{
    const TempFolder folder;
    bake_small(folder);
    const fs::path map = folder / "map";
    const auto read = [&] { return complaint(folder, [&] { read_map(map); }); };
    CHECK(read().empty());
    for (const char* const name : {"geometry.bin", "heightmap.png", "occupancy.bt", "preview.png", "terrain.tiff"}) {
        const std::string good = bytes_of(map / name), file = std::string("map/") + name;
        folder.write(file, good.substr(0, good.size() / 2));
        const std::string cut = "@/" + file + ": has " + std::to_string(good.size() / 2) +
                                " bytes, but map.yaml lists " + std::to_string(good.size()) +
                                ": the file was cut short or altered; bake the map again";
        CHECK(read() == cut);
        CHECK(complaint(folder, [&] { verify_map(map); }) == cut);
        fs::remove(map / name);
        CHECK(read() == "@/" + file + ": is missing; bake the map again");
        std::string bad = good;
        bad[bad.size() / 2] = char(bad[bad.size() / 2] ^ 1);
        folder.write(file, bad);
        const std::string altered = "@/" + file +
                                    ": was altered: its checksum differs from the one in map.yaml; bake the map again";
        CHECK(complaint(folder, [&] { verify_map(map); }) == altered);
        if (std::string(name) == "geometry.bin") {
            const Map harmed = read_map(map);  // tiles that are not used are not read
            CHECK(complaint(folder, [&] { column_at(harmed.geometry, 0.1, 0.2); }) ==
                  "@/map/geometry.bin: is damaged (tile 0 of level 0 has another checksum than the head of the file "
                  "lists); bake the map again");
        }
        const Map opened = read_map(map);  // only the sizes of these two files are compared
        folder.write(file, good);          // another file of the same name: the opened one is read
        if (std::string(name) == "terrain.tiff") CHECK(complaint(folder, [&] { read_terrain(opened); }) == altered);
        if (std::string(name) == "occupancy.bt") CHECK(complaint(folder, [&] { read_occupancy(opened); }) == altered);
    }
    const std::string good = bytes_of(map / "map.yaml");
    folder.write("map/map.yaml", good.substr(0, good.size() / 2));
    CHECK(read() == "@/map/map.yaml: is cut short: its last line, hash, is missing; bake the map again");
    std::string bad = good;
    bad.replace(bad.find("resolution: 0.5"), 15, "resolution: 0.4");
    folder.write("map/map.yaml", bad);
    CHECK(read() == "@/map/map.yaml: differs from the hash in its last line: it was altered; bake the map again");
    bad = good;
    bad.replace(0, bad.find('\n'), "format: spawnfield-map/10");
    folder.write("map/map.yaml", bad);
    CHECK(read() ==
          "@/map/map.yaml: has format version 10, this program reads 2 to 9; bake the map again or use a newer "
          "spawnfield");
    folder.write("map/map.yaml", "image: map.pgm\n");
    CHECK(read() ==
          "@/map/map.yaml: is not a map.yaml of spawnfield (its first line is not `format: spawnfield-map/9`)");
    fs::remove(map / "map.yaml");
    CHECK(read() == "@/map: is not a map: it has no map.yaml; make a map with `spawnfield bake SCENE -o MAP`");
    CHECK(complaint(folder, [&] { read_map(folder / "none"); }) == "@/none: does not exist; is the path right?");
    CHECK(complaint(folder, [&] { read_map(folder / "scene.yaml"); }) ==
          "@/scene.yaml: is a file, and a map is a folder; bake a scene first: spawnfield bake @/scene.yaml -o MAP");
}

TEST_CASE("a folder of another program that also has a map.yaml is not replaced")
{
    const TempFolder folder;
    folder.write("map/map.yaml", "image: map.pgm\nresolution: 0.05\n");  // a file of nav2
    CHECK(complaint(folder, [&] { bake_small(folder); }) ==
          "@/map: exists and is not a map; choose another name or remove it");
    CHECK(bytes_of(folder / "map/map.yaml") == "image: map.pgm\nresolution: 0.05\n");
}

TEST_CASE("geometry.bin and map.yaml give a result or a FileError wherever they are cut or altered")
{
    const TempFolder folder;
    bake_small(folder);
    const fs::path map = folder / "map";
    check_harmed(folder, "map/geometry.bin", bytes_of(map / "geometry.bin"), 7, [&](const fs::path& file) {
        const std::string bytes = bytes_of(file);
        if (bytes.size() < 24) return;
        std::uint64_t head = 0;  // size of the head, bytes
        std::memcpy(&head, bytes.data() + 16, sizeof head);
        // The checksum is the one that map.yaml would have.
        const Geometry geometry = open_geometry(file, checksum(std::string_view(bytes).substr(0, head)));
        column_at(geometry, 0.1, 0.2);
    });
    check_harmed(folder, "map/map.yaml", bytes_of(map / "map.yaml"), 3, [&](const fs::path&) { read_map(map); });
}

TEST_CASE("input files give a result or a FileError wherever they are cut or altered")
{
    const TempFolder folder;
    folder.write("box.obj", mesh_text::obj(hand::box({1, 1, 1})));
    cv::imwrite((folder / "grey.png").string(), cv::Mat(9, 9, CV_8U, cv::Scalar(7)));
    cv::imwrite((folder / "float.tiff").string(), cv::Mat(9, 9, CV_32F, cv::Scalar(7)));
    const auto load = [](const fs::path& file) { load_scene(file); };
    check_harmed(
        folder, "scene.yaml",
        "format: spawnfield-scene/1\nname: a\nparts:\n  - {name: a, label: terrain, box: [1, 2, 3], rpy: [0, 0, 1]}\n"
        "  - name: b\n    mesh: box.obj\n    scale: [1, 2, 3]\n    labels:\n      - {node: \"n*\", label: water}\n"
        "  - {name: c, heightmap: {file: grey.png, size: [1, 1], z: [0, 1]}}\n",
        1, load);
    check_harmed(
        folder, "robot.yaml",
        "format: spawnfield-robot/1\nparts:\n  - {box: [1, 2, 3]}\n  - {mesh: box.obj}\ncontacts: [[1, 2, 3]]\n", 1,
        [](const fs::path& file) { load_robot(file.string()); });
    check_harmed(folder, "poses.csv", "x,y,z,yaw,name\n1,2,3,0.5,\"a, b\"\n4,5,6,-1,c\n", 1,
                 [](const fs::path& file) { read_poses(file); });
    check_harmed(folder, "mesh.obj", mesh_text::obj(hand::box({1, 1, 1})), 3, load);
    check_harmed(folder, "mesh.stl", mesh_text::stl(hand::box({1, 1, 1})), 17, load);
    check_harmed(folder, "mesh.dae", mesh_text::dae({{.mesh = hand::box({1, 1, 1})}}), 11, load);
    check_harmed(folder, "mesh.gltf", mesh_text::gltf({{.mesh = hand::box({1, 1, 1})}}), 11, load);
    check_harmed(folder, "grey.png", bytes_of(folder / "grey.png"), 1, [&](const fs::path&) {
        const Scene scene = load_parts(folder,
                                       "  - {name: a, heightmap: {file: grey.png, size: [1, 1], z: [0, 255]}}\n");
        CHECK(scene.bounds().min.z() == 7);  // either the whole picture or an error
        CHECK(scene.triangles.size() == 128);
    });
    check_harmed(
        folder, "float.tiff", bytes_of(folder / "float.tiff"), 1,
        [&](const fs::path&) {
            const Scene scene = load_parts(folder, "  - {name: a, heightmap: {file: float.tiff, size: [1, 1]}}\n");
            CHECK(scene.bounds().min.z() == 7);
            CHECK(scene.triangles.size() == 128);
        },
        Harm::Cut);
    bake_small(folder);
    check_harmed(folder, "tree.bt", bytes_of(folder / "map/occupancy.bt"), 3, load);
    const std::string link =
        "<link name=\"a\"><collision><origin xyz=\"0 0 1\"/><geometry><box size=\"1 2 "
        "3\"/></geometry></collision></link>";
    check_harmed(folder, "robot.urdf", "<robot name=\"r\">" + link + "</robot>", 1,
                 [](const fs::path& file) { load_robot(file.string()); });
}

TEST_CASE("a geometry file with invalid indices is refused, even if its checksums are right")
{
    const TempFolder folder;
    const Scene scene = load_parts(
        folder, "  - {name: a, label: terrain, plane: [1, 1]}\n  - {name: b, label: terrain, sphere: 1}\n");
    const auto complaint_of = [&](auto change) {
        const Geometry geometry(scene);
        Geometry::Impl changed;
        changed.elements = geometry.impl().elements;
        changed.parts = geometry.impl().parts;
        changed.part_hashes = geometry.impl().part_hashes;
        const Forest& forest = *geometry.impl().forests[0];
        std::vector<TileLevel> levels = forest.tiles.levels();
        std::string tiles(forest.tiles.bytes());
        TileEntry* entry = nullptr;  // the tile with the triangles and the sphere
        for (TileEntry& tile : levels[0].tiles)
            if (tile.size > 0) entry = &tile;
        char* const tile = tiles.data() + entry->offset;
        change(levels, tile, Tile({tile, entry->size}));
        entry->checksum = XXH64(tile, entry->size, 0);
        changed.forests = {std::make_shared<const Forest>(
            Forest{TileStore(std::move(levels), spawnfield::bytes_of(std::move(tiles))), forest.trees, forest.limits})};
        const fs::path file = folder / "geometry.bin";
        return complaint(folder, [&] {
            const ListedFile written = write_geometry(
                file, Geometry(std::make_shared<const Geometry::Impl>(std::move(changed))));
            column_at(open_geometry(file, written.head_checksum), 0.1, 0.2);
        });
    };
    const auto at = [](const auto& item) -> char* { return const_cast<char*>(reinterpret_cast<const char*>(&item)); };
    const std::string wanted =
        "@/geometry.bin: is not a valid map file: its values contradict each other; bake the map again";
    CHECK(complaint_of([](auto&, char*, const Tile&) {}).empty());
    CHECK(complaint_of([&](auto&, char*, const Tile& t) { *at(t.triangles[1].corners[2]) = 4; }) == wanted);
    CHECK(complaint_of([&](auto&, char*, const Tile& t) { *at(t.triangles[0].label) = 7; }) == wanted);
    CHECK(complaint_of([&](auto&, char*, const Tile& t) { *at(t.triangles[0].piece) = 1; }) == wanted);
    CHECK(complaint_of([&](auto&, char*, const Tile& t) { *at(t.pieces[0].part) = 2; }) == wanted);
    CHECK(complaint_of([&](auto&, char*, const Tile& t) { *at(t.primitives[0].part) = 9; }) == wanted);
    CHECK(complaint_of([&](auto&, char*, const Tile& t) { *at(t.primitives[0].kind) = char(ShapeKind::Hull); }) ==
          wanted);
    CHECK(complaint_of([&](auto&, char*, const Tile& t) { *at(t.head->primitives) = 64; }) == wanted);
    CHECK(complaint_of([&](auto&, char*, const Tile& t) { *at(t.head->triangles) += 1; }) == wanted);
    CHECK(complaint_of([&](auto& levels, char*, const Tile&) { levels[0].cell = 0; }) == wanted);
    CHECK(complaint_of([&](auto& levels, char*, const Tile&) { levels[0].tiles.back().offset = 1 << 20; }) == wanted);
    CHECK(complaint_of([&](auto& levels, char*, const Tile&) { levels[0].tiles.back().offset += 8; }) == wanted);
    CHECK(complaint_of([&](auto& levels, char*, const Tile&) { levels[0].tiles.back().size = 0; }) == wanted);
}

TEST_CASE("a changed byte in an old geometry file with right checksums is refused, or gives another geometry")
{
    const TempFolder folder;
    const std::string good = bytes_of(fs::path(source_folder()) / "tests/data/maps/format-3/geometry.bin");
    const auto number_at = [](const std::string& bytes, std::size_t place) {
        std::uint64_t out;
        std::memcpy(&out, bytes.data() + place, sizeof out);
        return out;
    };
    const std::size_t head_size = number_at(good, 16);
    const auto open_changed = [&](std::size_t place) {
        std::string bytes = good;
        bytes[place] ^= 0x55;
        for (std::size_t entry = 24; entry + 24 <= head_size; entry += 4) {  // offset, size and checksum of a tile
            const std::size_t tile = head_size + number_at(good, entry), size = number_at(good, entry + 8);
            if (size == 0 || tile > good.size() || size > good.size() - tile ||
                XXH64(good.data() + tile, size, 0) != number_at(good, entry + 16))
                continue;
            const std::uint64_t sum = XXH64(bytes.data() + tile, size, 0);
            std::memcpy(bytes.data() + entry + 16, &sum, sizeof sum);
        }
        folder.write("geometry.bin", bytes);
        return complaint(folder, [&] {
            column_at(open_geometry(folder / "geometry.bin", checksum(bytes.substr(0, head_size))), 1, 0);
        });
    };
    const std::string refusal =
        "@/geometry.bin: is not a valid map file: its values contradict each other; bake the map again";
    std::size_t refused = 0;
    for (std::size_t place = head_size; place < good.size(); ++place) {
        CAPTURE(place);
        const std::string text = open_changed(place);
        CHECK((text.empty() || text == refusal));
        refused += text == refusal;
    }
    CHECK(refused > 50);  // counts, indices, kinds, labels and numbers of elements
    CHECK(refused < good.size() - head_size);
}

TEST_CASE("a bounds file whose levels do not fit each other is refused, even if its checksums are right")
{
    const TempFolder folder;
    const Scene scene = load_parts(folder, "  - {name: a, label: terrain, plane: [9, 9]}\n");
    const auto complaint_of = [&](auto change) {
        const SolidBounds bounds(Geometry(scene), scene.bounds(), 0.5);
        auto changed = std::make_shared<SolidBounds::Impl>();
        changed->x0 = bounds.impl().x0;
        changed->y0 = bounds.impl().y0;
        std::vector<TileLevel> levels = bounds.impl().levels();
        REQUIRE(levels.size() > 2);
        change(*changed, levels);
        changed->tiles = TileStore(std::move(levels), spawnfield::bytes_of(std::string(bounds.impl().tiles.bytes())));
        const fs::path file = folder / "bounds.bin";
        return complaint(folder,
                         [&] { open_bounds(file, write_bounds(file, SolidBounds(std::move(changed))).head_checksum); });
    };
    const std::string wanted =
        "@/bounds.bin: is not a valid map file: its values contradict each other; bake the map "
        "again";
    CHECK(complaint_of([](auto&, auto&) {}).empty());
    CHECK(complaint_of([](auto&, auto& levels) { --levels[1].cols; }) == wanted);
    CHECK(complaint_of([](auto&, auto& levels) { ++levels[2].rows; }) == wanted);
    CHECK(complaint_of([](auto&, auto& levels) { levels[1].cell *= 1.5; }) == wanted);
    CHECK(complaint_of([](auto& impl, auto&) { impl.x0 = std::numeric_limits<double>::quiet_NaN(); }) == wanted);
    CHECK(complaint_of([](auto& impl, auto&) { impl.y0 = std::numeric_limits<double>::infinity(); }) == wanted);
}
