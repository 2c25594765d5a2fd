#include "catch.h"
#include "compare.h"
#include "this_build.h"
#include "program.h"
#include "random_scene.h"

#include <spawnfield/bake.h>
#include <spawnfield/error.h>
#include <spawnfield/frames.h>

#include <algorithm>
#include <cstring>

using namespace spawnfield;
namespace fs = std::filesystem;

// bake --update gives the files of a full bake, byte for byte, or refuses.

namespace {

/// Moves all geometry of a part; its vertices are not shared with other parts.
void move_part(Scene& scene, std::uint32_t part, const Vec3& by)
{
    std::vector<bool> moved(scene.vertices.size());
    for (Piece& piece : scene.pieces) {
        if (piece.part != part) continue;
        piece.bottom += by.z();
        for (std::uint32_t t = piece.first_triangle; t < piece.first_triangle + piece.triangle_count; ++t)
            for (const std::uint32_t corner : scene.triangles[t]) {
                if (!moved[corner]) scene.vertices[corner] += by;
                moved[corner] = true;
            }
    }
    for (Primitive& primitive : scene.primitives)
        if (primitive.part == part) primitive.shape.pose.position += by;
}

void set_label(Scene& scene, std::uint32_t part, Label label)
{
    scene.parts[part].label = label;
    for (std::size_t t = 0; t < scene.triangles.size(); ++t)
        if (scene.pieces[scene.triangle_pieces[t]].part == part) scene.triangle_labels[t] = label;
    for (Primitive& primitive : scene.primitives)
        if (primitive.part == part) primitive.label = label;
}

/// Two states of a scene, and the names of the parts that differ.
struct Change {
    Scene before, after;
    std::vector<std::string> names;
};

/// Moves, relabels, removes, adds and reorders one to four parts of a random scene. The bounds stay those of the scene.
Change random_change(std::uint64_t seed)
{
    Scene all = random_scene(seed);
    for (std::size_t part = 0; part < all.parts.size(); ++part)
        all.parts[part].name = (part % 3 == 0 ? "yard::part-" : "part-") + std::to_string(part) + "x";
    Random random{seed + 9000};
    Change out;
    const auto count = std::uint32_t(all.parts.size());
    std::vector<std::uint32_t> before, after;
    for (std::uint32_t part = 0; part < count; ++part) before.push_back(part);
    after = before;
    const auto remove = [](std::vector<std::uint32_t>& parts, std::uint32_t part) {
        parts.erase(std::find(parts.begin(), parts.end(), part));
    };
    Scene changed = all;
    for (int changes = 1 + random.below(4); changes > 0; --changes) {
        const auto part = std::uint32_t(random.below(int(count)));
        const std::string name = "part-" + std::to_string(part) + "x";
        if (std::find(out.names.begin(), out.names.end(), name) != out.names.end()) continue;
        out.names.push_back(name);
        switch (random.below(part == 0 ? 2 : 5)) {
        case 0: {
            const double x = random.between(-1, 1), y = random.between(-1, 1);
            move_part(changed, part, {x, y, random.between(-0.3, 0.3)});
            break;
        }
        case 1: set_label(changed, part, Label(random.below(2))); break;
        case 2: remove(after, part); break;
        case 3: remove(before, part); break;
        default: remove(after, part); after.insert(after.begin() + random.below(int(after.size())), part);
        }
    }
    out.before = scene_of_parts(all, before);
    out.after = scene_of_parts(changed, after);
    out.before.map_bounds = out.after.map_bounds = all.bounds();
    return out;
}

/// Small cells, so that each file has many tiles.
BakeOptions fine(std::uint64_t seed, int threads = 2)
{
    return {.resolution = 0.06,
            .occupancy_resolution = 0.06,
            .z = seed % 5 == 0 ? ZRange{-0.5, 2} : ZRange{},
            .allow_no_terrain = true,
            .threads = threads};
}

/// Returns the names of the files that differ between two map folders.
std::vector<std::string> different_files(const fs::path& a, const fs::path& b)
{
    std::vector<std::string> out;
    std::vector<std::string> names(map_files.begin(), map_files.end());
    names.push_back("map.yaml");
    for (const std::string& name : names)
        if (bytes_of(a / name).empty() || bytes_of(a / name) != bytes_of(b / name)) out.push_back(name);
    return out;
}

/// A folder with a scene file whose content does not matter; maps are made from scenes in memory.
struct Workshop : TempFolder {
    fs::path file = write("scene.txt", "stands for the scene's file");
};

using Names = std::vector<std::string>;

}  // namespace

namespace {

const std::uint64_t step = compare::all_scenes() ? 1 : 6;

/// Makes random changes, each of them forth and back. Returns how many were baked in full.
std::size_t check_random_changes(std::uint64_t first, std::uint64_t last)
{
    const Workshop folder;
    std::size_t changed_heights = 0, changed_bounds = 0, full = 0;
    for (std::uint64_t seed = first; seed <= last; seed += step) {
        CAPTURE(seed);
        const Change change = random_change(seed);
        const BakeReport baked[] = {bake(change.before, folder.file, folder / "before", fine(seed)),
                                    bake(change.after, folder.file, folder / "after", fine(seed))};
        fs::remove_all(folder / "map");
        fs::copy(folder / "before", folder / "map");
        for (const bool back : {false, true}) {
            const int threads = (seed + back) % 3 == 0 ? 1 : (seed + back) % 3 == 1 ? 2 : 8;
            const BakeReport report = update_map(back ? change.before : change.after, folder.file, folder / "map",
                                                 change.names, fine(seed, threads));
            CHECK(different_files(folder / "map", folder / (back ? "before" : "after")) == Names{});
            const BakeReport& wanted = baked[back ? 0 : 1];
            CHECK(report.hash == wanted.hash);
            CHECK(report.layers == wanted.layers);
            CHECK(report.occupancy_leaves == wanted.occupancy_leaves);
            CHECK(report.bytes == wanted.bytes);
            full += report.notices.size();
        }
        const Names different = different_files(folder / "before", folder / "after");
        const auto differs = [&](const char* name) {
            return std::find(different.begin(), different.end(), name) != different.end();
        };
        changed_bounds += differs("bounds.bin");
        changed_heights += differs("heightmap.png");
    }
    if (step > 1) return full;
    CHECK(changed_bounds > (last - first) * 8 / 10);  // the changes mattered
    CHECK(changed_heights > (last - first) / 5);
    return full;
}

}  // namespace

// 100 changes, in four tests so that none of them takes long.
TEST_CASE("after random changes, an updated map has the files of a full bake")
{
    CHECK(check_random_changes(1, 13) < 3);  // only if there are filled meshes before or after, but not both
}
TEST_CASE("after random changes, an updated map has the files of a full bake: part 2")
{
    CHECK(check_random_changes(14, 26) < 3);
}
TEST_CASE("after random changes, an updated map has the files of a full bake: part 3")
{
    CHECK(check_random_changes(27, 38) < 3);
}
TEST_CASE("after random changes, an updated map has the files of a full bake: part 4")
{
    CHECK(check_random_changes(39, 50) < 3);
}

namespace {

/// A yard of boxes in a folder, with its map.
struct Yard : TempFolder {
    std::string crate = "[1, 1, 0.5]", lamp = "[-3, 2, 1]", extra;

    Yard()
    {
        write_scene();
        REQUIRE(run_program(*this, "bake yard.yaml -o map --resolution 0.2").status == 0);
    }

    void write_scene() const
    {
        write("yard.yaml",
              "format: spawnfield-scene/1\nname: yard\nparts:\n"
              "- {name: floor, label: terrain, box: [30, 20, 1], xyz: [0, 0, -0.5]}\n"
              "- {name: 'store::crate', box: [1, 1, 1], xyz: " +
                  crate + "}\n- {name: lamp, cylinder: {radius: 0.1, length: 2}, xyz: " + lamp + "}\n" + extra);
    }

    ProgramRun update(const std::string& options) const
    {
        return run_program(*this, "bake yard.yaml -o map " + options);
    }

    /// Returns the files that differ from those of a full bake.
    Names different(const std::string& options = "--resolution 0.2") const
    {
        fs::remove_all(*this / "full");
        REQUIRE(run_program(*this, "bake yard.yaml -o full " + options).status == 0);
        return different_files(*this / "map", *this / "full");
    }
};

}  // namespace

TEST_CASE("bake --update bakes moved, added and removed parts of a scene file")
{
    Yard yard;
    yard.write("map/notes.txt", "of the user");
    yard.write("map/reach-0123456789abcdef-0123456789abcdef.bin", "a graph of the old map");
    yard.crate = "[4, 1, 0.5]";
    yard.write_scene();
    REQUIRE(yard.update("--update CRATE --resolution 0.2").err.starts_with("spawnfield bake: map; 1 layer, "));
    CHECK(yard.different() == Names{});
    CHECK(bytes_of(yard / "map/notes.txt") == "of the user");
    CHECK_FALSE(fs::exists(yard / "map/reach-0123456789abcdef-0123456789abcdef.bin"));
    yard.extra =
        "- {name: shelf-1, box: [1, 3, 2], xyz: [-8, 0, 1]}\n- {name: shelf-2, box: [1, 3, 2], xyz: [-5, 0, 1]}\n";
    yard.lamp = "[9, 8, 1]";
    yard.write_scene();
    REQUIRE(yard.update("--update 'lamp,shelf-?' --resolution 0.2").status == 0);
    CHECK(yard.different() == Names{});
    yard.extra.clear();
    yard.write_scene();
    REQUIRE(yard.update("--update lamp --update 'shelf*' --resolution 0.2").status == 0);
    CHECK(yard.different() == Names{});
    REQUIRE(yard.update("--update '*' --resolution 0.2").status == 0);
    CHECK(yard.different() == Names{});
}

TEST_CASE("bake --update refuses a change that it does not name, and leaves the map as it is")
{
    Yard yard;
    const std::string before = bytes_of(yard / "map/map.yaml");
    yard.crate = "[4, 1, 0.5]";
    yard.lamp = "[-3, 3, 1]";
    yard.write_scene();
    const auto error = [&](const std::string& options) {
        const ProgramRun run = yard.update(options);
        CHECK(run.status != 0);
        CHECK(bytes_of(yard / "map/map.yaml") == before);
        return run.err;
    };
    CHECK(error("--update crate --resolution 0.2") ==
          "spawnfield: yard.yaml: a part differs from map, and --update does not name it: lamp; name all changed parts "
          "(--update '*' finds them), or bake in full (without --update)\n");
    CHECK_THAT(error("--update floor --resolution 0.2"),
               Contains("parts differ from map, and --update does not name them: store::crate, lamp; "));
    CHECK_THAT(error("--update '*'"), Contains("map was baked with a resolution of 0.2 m, not with 0.1 m; give "
                                               "--resolution as for that bake, or bake in full (without --update)"));
    CHECK_THAT(error("--update '*' --resolution 0.2 --occupancy-resolution 1"),
               Contains("map was baked with an occupancy resolution of 0.5 m, not with 1 m"));
    CHECK_THAT(error("--update '*' --resolution 0.2 --z 0:2"),
               Contains("map was baked with no z limits, not with z limits 0:2 m; give --z or --bounds"));
    CHECK_THAT(error("--update '*,crane' --resolution 0.2"),
               Contains("\"crane\" matches no part of the map; there are floor, store::crate, lamp"));
    CHECK_THAT(error("--update '*' --resolution 0.2 --label 'floor=obstacle'"), Contains("has no terrain"));
    CHECK_THAT(error("--update lamp --resolution 0.2 --label 'store::crate=terrain'"), Contains("store::crate"));
    CHECK_THAT(error("--update '' --resolution 0.2"), Contains("--update"));
}

TEST_CASE("bake --update bakes in full, with a notice, when the raster changes or the old map has no hashes")
{
    Yard yard;
    yard.crate = "[40, 1, 0.5]";
    yard.write_scene();
    CHECK_THAT(yard.update("--update crate --resolution 0.2").err,
               Contains("notice: the map is baked in full, because the bounds changed from -15, -10, -1 to 15, 10, 2 m "
                        "to -15, -10, -1 to 40.5, 10, 2 m"));
    CHECK(yard.different() == Names{});
    const std::string stored = source_folder() + "/tests/data/maps/";
    fs::copy(stored + "scene.yaml", yard / "scene.yaml");
    fs::copy(stored + "rock.obj", yard / "rock.obj");
    for (const std::string name : {"3", "4", "5"})
        fs::copy(stored + "format-" + name, yard / "old",
                 fs::copy_options::recursive | fs::copy_options::overwrite_existing);
    const std::string options = "--resolution 4 --occupancy-resolution 1";
    const ProgramRun other = run_program(yard, "bake scene.yaml -o old --update '*'");
    CHECK(other.status == 2);
    CHECK_THAT(other.err, Contains("old was baked with a resolution of 4 m, not with 0.1 m; give --resolution as for"));
    const ProgramRun run = run_program(yard, "bake scene.yaml -o old --update '*' " + options);
    CHECK_THAT(run.err, Contains("because the old map has format 5, and parts of format 9 only can be compared"));
    REQUIRE(run_program(yard, "bake scene.yaml -o new " + options).status == 0);
    CHECK(different_files(yard / "old", yard / "new") == Names{});
}

TEST_CASE("bake --update refuses a folder that is not a map, and a damaged map")
{
    Yard yard;
    yard.crate = "[4, 1, 0.5]";
    yard.write_scene();
    CHECK_THAT(run_program(yard, "bake yard.yaml -o none --update crate").err, Contains("none: does not exist"));
    for (const std::string file : {"terrain.tiff", "occupancy.bt", "heightmap.png", "bounds.bin", "geometry.bin"}) {
        CAPTURE(file);
        fs::remove_all(yard / "damaged");
        fs::copy(yard / "map", yard / "damaged");
        std::string bytes = bytes_of(yard / "map" / file);
        std::uint64_t head = 0;  // size of the head of bounds.bin; its first tile is not near the crate
        std::memcpy(&head, bytes.data() + 16, sizeof head);
        char& damaged = bytes[file == "bounds.bin" ? std::size_t(head) + 100 : bytes.size() - 20];
        damaged = char(damaged ^ 1);
        yard.write("damaged/" + file, bytes);
        const ProgramRun run = run_program(yard, "bake yard.yaml -o damaged --update crate --resolution 0.2");
        CHECK(run.status == 4);
        CHECK_THAT(run.err, Contains("damaged/" + file));
        CHECK((bytes_of(yard / "damaged" / file) == bytes));
    }
}

TEST_CASE("two parts of one name cannot be updated")
{
    const Workshop folder;
    Scene scene = random_scene(3);
    scene.parts[1].name = scene.parts[2].name = "twin";
    bake(scene, folder.file, folder / "map", {.resolution = 0.5});
    CHECK_THROWS_WITH(update_map(scene, folder.file, folder / "map", {"*"}, {.resolution = 0.5}),
                      Contains("two parts have the name \"twin\""));
    CHECK_THROWS_AS(update_map(scene, folder.file, folder / "map", {}, {.resolution = 0.5}), ArgumentError);
}
