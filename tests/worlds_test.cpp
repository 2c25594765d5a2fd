#include "catch.h"
#include "temp_folder.h"
#include "test_map.h"
#include "worlds/world.h"

#include <spawnfield/scene.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

using namespace spawnfield;

namespace {

Scene read_back(const worlds::World& world)
{
    const TempFolder folder;
    worlds::write_world(world, folder.path());
    return load_scene(folder / "scene.yaml");
}

/// Returns the contents of all files that a world writes.
std::string bytes_of_all(const worlds::World& world)
{
    const TempFolder folder;
    worlds::write_world(world, folder.path());
    return bytes_of(folder / "scene.yaml") + bytes_of(folder / "meshes/ground.obj") +
           bytes_of(folder / "landmarks.csv");
}

Bounds where(const worlds::World& world, const std::string& landmark)
{
    for (const auto& [name, bounds] : world.landmarks)
        if (name == landmark) return bounds;
    return {};
}

/// Returns the number of primitives in a region whose names begin and end like this.
int count_in(const worlds::World& world, const Bounds& region, const std::string& kind, const std::string& element)
{
    const auto is_meant = [&](const Primitive& primitive) {
        const std::string& name = world.scene.parts[primitive.part].name;
        return name.starts_with(kind) && name.ends_with(element) && bounds_of(primitive.shape).meets(region);
    };
    return int(std::count_if(world.scene.primitives.begin(), world.scene.primitives.end(), is_meant));
}

/// Returns counts for a box of the size of the Husky, with the offset (2D) and the maximum height (3D) of the thesis.
VerdictCounts thesis_counts(const Map& map, int dims, double step, const Bounds& bounds)
{
    const Judge judge(map, load_robot("box:0.99,0.67,0.39"));
    RasterOptions options{.dims = dims, .step = step, .step_z = 0.5, .bounds = bounds, .offset = 1.0};
    return raster(judge, options).counts;
}

double share(const VerdictCounts& counts, Verdict verdict)
{
    const auto of = [&](Verdict v) { return double(counts[v]); };
    return of(verdict) / (of(Verdict::Valid) + of(Verdict::Collision) + of(Verdict::Submerged));
}

}  // namespace

TEST_CASE("a world of primitives is read back as it was made")
{
    const worlds::World world = worlds::benchmark_cubes(2);
    const Scene scene = read_back(world);
    REQUIRE(scene.primitives.size() == 200);
    CHECK(scene.triangles.empty());
    for (std::size_t i = 0; i < 200; ++i) {
        CHECK(scene.primitives[i].shape.size == Vec3(0.5, 0.5, 0.5));
        CHECK(scene.primitives[i].shape.pose.position == world.scene.primitives[i].shape.pose.position);
        CHECK(scene.primitives[i].label == Label::Obstacle);
    }
}

TEST_CASE("equal meshes share a file, each at its own place")
{
    const worlds::World world = worlds::benchmark_balls(2);
    const TempFolder folder;
    worlds::write_world(world, folder.path());
    const auto files = std::filesystem::directory_iterator(folder / "meshes");
    CHECK(std::distance(begin(files), end(files)) == 1);
    const Scene scene = load_scene(folder / "scene.yaml");
    REQUIRE(scene.triangles.size() == world.scene.triangles.size());
    REQUIRE(scene.pieces.size() == 200);
    double largest = 0;
    for (std::size_t t = 0; t < scene.triangles.size(); ++t)
        for (int corner = 0; corner < 3; ++corner)
            largest = std::max(largest, (scene.vertices[scene.triangles[t][corner]] -
                                         world.scene.vertices[world.scene.triangles[t][corner]])
                                            .norm());
    CHECK(largest < 2e-5);
    for (const Piece& piece : scene.pieces) CHECK(piece.solid);
}

namespace {

constexpr worlds::Bridge both_bridges[] = {worlds::Bridge::OneObject, worlds::Bridge::DeckAlone};

struct ComplexDistrict {
    TestMap map;  ///< map of the scene that was read back
    std::vector<worlds::Landmark> landmarks;
};

const ComplexDistrict& complex_district(worlds::Bridge bridge)
{
    static std::map<worlds::Bridge, ComplexDistrict> made;
    if (made.count(bridge) == 0) {
        const worlds::World world = worlds::complex_district(1, bridge);
        made[bridge] = {map_of(read_back(world), 2), world.landmarks};
    }
    return made[bridge];
}

/// Returns a 2D raster of the Husky's box, 1 m above each layer.
RasterResult husky_raster(const TestMap& map, const Bounds& bounds, double step)
{
    RasterOptions options{.step = step, .bounds = bounds, .offset = 1};
    return raster(Judge(map, load_robot("box:0.99,0.67,0.39")), options);
}

double count_of(const RasterResult& result, Verdict verdict) { return double(result.counts[verdict]); }

/// Returns the bounds of the triangles of each part whose name begins like this.
std::vector<Bounds> bounds_of(const Scene& scene, const std::string& beginning)
{
    std::map<std::uint32_t, Bounds> bounds;
    for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
        const std::uint32_t part = scene.pieces[scene.triangle_pieces[t]].part;
        if (!scene.parts[part].name.starts_with(beginning)) continue;
        for (const std::uint32_t v : scene.triangles[t]) bounds[part].extend(scene.vertices[v]);
    }
    std::vector<Bounds> list;
    for (const auto& [part, of_part] : bounds) list.push_back(of_part);
    return list;
}

}  // namespace

TEST_CASE("the complex district has the extents of its model, and only sea on its rim")
{
    const TestMap& map = complex_district(worlds::Bridge::OneObject).map;
    CHECK(map.bounds.min.head<2>() == Eigen::Vector2d(-128, -212));
    CHECK(map.bounds.max.head<2>() == Eigen::Vector2d(1152, 1068));
    CHECK(map.bounds.min.z() > -6);
    CHECK(map.bounds.max.z() > 60);
    CHECK(map.bounds.max.z() <= 80);
    CHECK(map.scene.triangles.size() < 1500000);
    for (const char* sheet : {"ground", "streets"})
        for (const Bounds& bounds : bounds_of(map.scene, sheet)) {
            CHECK((bounds.min - map.bounds.min).head<2>().minCoeff() > 4);
            CHECK((map.bounds.max - bounds.max).head<2>().minCoeff() > 4);
        }
}

TEST_CASE("the complex district has as many valid, invalid and empty columns as its model")
{
    const TestMap& map = complex_district(worlds::Bridge::OneObject).map;
    const RasterResult result = husky_raster(map, {}, 10);
    const double columns = double(result.grid.cols) * result.grid.rows;
    const double valid = count_of(result, Verdict::Valid);
    const double invalid = count_of(result, Verdict::Submerged) + count_of(result, Verdict::Collision);
    CHECK(valid / columns == Approx(0.377).margin(0.01));
    CHECK(invalid / columns == Approx(0.355).margin(0.01));
    CHECK((valid + invalid) / columns == Approx(0.732).margin(0.01));
    CHECK(count_of(result, Verdict::Collision) > 0.04 * columns);
}

TEST_CASE("the same seed gives the same complex district, another seed gives another")
{
    const auto files_of = [](std::uint64_t seed) {
        const TempFolder folder;
        worlds::write_world(worlds::complex_district(seed), folder.path());
        std::map<std::string, std::string> files;
        for (const auto& entry : std::filesystem::recursive_directory_iterator(folder.path()))
            if (entry.is_regular_file())
                files[std::filesystem::relative(entry.path(), folder.path()).string()] = bytes_of(entry.path());
        return files;
    };
    const auto files = files_of(5);
    CHECK(files.size() < 400);  // houses and cars share their files
    CHECK(files == files_of(5));
    CHECK(files != files_of(6));
}

TEST_CASE("houses, cars and the bridge are solid when they are read back")
{
    for (const worlds::Bridge bridge : both_bridges) {
        std::map<std::string, int> solids;
        for (const Part& part : complex_district(bridge).map.scene.parts) {
            const std::string kind = part.name.substr(0, part.name.find('-'));
            if (kind != "house" && kind != "car" && kind != "bridge") continue;
            INFO(part.name);
            CHECK(part.open_edges == 0);
            CHECK(part.sheet_pieces == 0);
            CHECK(part.solid_pieces > 0);
            ++solids[kind];
        }
        CHECK(solids["house"] > 500);
        CHECK(solids["car"] > 300);
        CHECK(solids["bridge"] == (bridge == worlds::Bridge::OneObject ? 1 : 11));
    }
}

TEST_CASE("a Husky fits on the deck of the bridge under its frames, which are layers only if they are terrain")
{
    const Scene& scene = complex_district(worlds::Bridge::DeckAlone).map.scene;
    const std::vector<Bounds> frames = bounds_of(scene, "bridge-frame");
    REQUIRE(frames.size() == 5);
    for (const worlds::Bridge bridge : both_bridges) {
        const TestMap& map = complex_district(bridge).map;
        const Judge judge(map, husky());
        for (const Bounds& frame : frames) {
            const Vec3 middle = (frame.min + frame.max) / 2;
            const double deck = frame.min.z() + 0.1;  // the feet of the frame reach into the deck
            const std::vector<double> layers = column_at(map.geometry, middle.x(), middle.y()).layers;
            REQUIRE(layers.size() == (bridge == worlds::Bridge::OneObject ? 3 : 2));
            CHECK(layers[layers.size() - 2] == Approx(deck).margin(1e-4));
            const Pose pose = {{middle.x(), middle.y(), deck + 0.1}, rotation_from_rpy(0, 0, 0.3)};
            CHECK(judge.is_valid(pose));
        }
    }
}

TEST_CASE("landmarks of the complex district contain what their names state")
{
    const auto& [map, landmarks] = complex_district(worlds::Bridge::OneObject);
    std::map<std::string, Bounds> regions;
    for (const auto& [name, where] : landmarks) regions[name] = where;
    REQUIRE(regions.size() == 5);
    const auto parts_in = [&, &map = map](const char* region, const char* kind) {
        const std::vector<Bounds> bounds = bounds_of(map.scene, kind);
        return std::count_if(bounds.begin(), bounds.end(),
                             [&](const Bounds& part) { return part.meets(regions.at(region)); });
    };
    const auto fences_in = [&, &map = map](const Bounds& region) {
        return std::count_if(map.scene.primitives.begin(), map.scene.primitives.end(), [&](const Primitive& primitive) {
            const Vec3& place = primitive.shape.pose.position;
            return primitive.shape.kind == ShapeKind::Box && region.contains_xy(place.x(), place.y(), 0);
        });
    };
    CHECK(parts_in("car", "car") >= 1);
    CHECK(parts_in("houses", "house") >= 8);
    CHECK(parts_in("bridge", "bridge") == 1);
    CHECK(fences_in(regions.at("fence_and_water")) >= 1);
    for (const auto& [name, region] : regions) {
        INFO(name);
        CHECK((region.max - region.min).head<2>().minCoeff() >= 15);
        CHECK((region.max - region.min).head<2>().maxCoeff() <= 80);
        const RasterResult result = husky_raster(map, region, 1);
        CHECK(count_of(result, Verdict::Valid) > 0);
        const bool has_water = name == "fence_and_water" || name == "bridge" || name == "shore";
        CHECK((count_of(result, Verdict::Submerged) > 0.2 * double(result.poses.size())) == has_water);
    }
}

TEST_CASE("the low-complexity world has the size of the one in the thesis, and consists of primitives")
{
    const worlds::World world = worlds::low_complexity();
    REQUIRE(world.scene.parts.front().kind == "heightmap");
    Bounds ground;
    for (std::uint32_t t = 0; t < world.scene.pieces.front().triangle_count; ++t)
        for (const std::uint32_t v : world.scene.triangles[t]) ground.extend(world.scene.vertices[v]);
    CHECK(ground.min.head<2>().norm() < 1e-9);
    CHECK(ground.max.x() == Approx(499.9));
    CHECK(ground.max.y() == Approx(499.9));
    CHECK((ground.min.z() >= 31 && ground.min.z() < 32));
    CHECK((ground.max.z() > 104 && ground.max.z() < 110));

    const Bounds all = world.scene.bounds();
    CHECK((all.min - Vec3(0, 0, 31)).norm() < 1e-9);
    CHECK((all.max - Vec3(500, 500, 124)).norm() < 1e-9);
    CHECK(world.scene.primitives.size() > 3000);
    CHECK(world.scene.primitives.size() < 15000);
    for (const Primitive& primitive : world.scene.primitives) {
        CHECK((primitive.shape.kind == ShapeKind::Box || primitive.shape.kind == ShapeKind::Capsule));
        CHECK(primitive.label == Label::Obstacle);
    }
}

TEST_CASE("the valid share of the low-complexity world is that of the thesis, for every seed")
{
    const std::uint64_t seed = GENERATE(1, 2);
    const TestMap map = map_of(worlds::low_complexity(seed).scene, 2.0);
    const VerdictCounts flat = thesis_counts(map, 2, 2.5, {});
    CHECK(share(flat, Verdict::Valid) == Approx(0.896).margin(0.01));
    CHECK(share(flat, Verdict::Submerged) == Approx(0.033).margin(0.01));
    CHECK(flat[Verdict::OffTerrain] < 100);
    const VerdictCounts tall = thesis_counts(map, 3, 2.5, {Vec3(0, 0, 31), Vec3(500, 500, 124)});
    CHECK(share(tall, Verdict::Valid) == Approx(0.870).margin(0.015));
}

TEST_CASE("a raster that reaches 500 m has no ground in its last row and column in the low-complexity world")
{
    const TestMap map = map_of(worlds::low_complexity().scene, 2.0);
    const auto poses = [&](double step) { return thesis_counts(map, 2, step, {}).total(); };
    CHECK(poses(4) == 125 * 125);    // of 126 x 126 columns
    CHECK(poses(4.5) == 112 * 112);  // the last column is at 499.5 m
}

TEST_CASE("the low-complexity world has the same bytes for the same seed, and others for another seed")
{
    const std::string bytes = bytes_of_all(worlds::low_complexity(7));
    CHECK(bytes == bytes_of_all(worlds::low_complexity(7)));
    CHECK(bytes != bytes_of_all(worlds::low_complexity(8)));
}

TEST_CASE("landmarks of the low-complexity world contain what their names state")
{
    const worlds::World world = worlds::low_complexity();
    const TestMap map = map_of(world.scene, 2.0);
    const Bounds everywhere = world.scene.bounds(), fountain = where(world, "fountain");
    CHECK(count_in(world, everywhere, "fountain-", "") == 15);
    CHECK(count_in(world, fountain, "fountain-", "") == 15);
    CHECK(count_in(world, fountain, "bench-", "-seat") == 8);
    CHECK(count_in(world, where(world, "town"), "house-", "-wall") >= 6);

    const int dense = count_in(world, where(world, "dense_forest"), "tree-", "-trunk");
    const int thin = count_in(world, where(world, "thin_forest"), "tree-", "-trunk");
    CHECK(dense > 100);
    CHECK(thin > 10);
    CHECK(thin * 4 < dense);

    const VerdictCounts lake = thesis_counts(map, 2, 2, where(world, "lake"));
    CHECK(share(lake, Verdict::Submerged) > 0.2);
    CHECK(share(lake, Verdict::Valid) > 0.4);
    for (const auto& [name, bounds] : world.landmarks) {
        CHECK((everywhere.meets(bounds) && !bounds.is_empty()));
        CHECK(bounds.max.z() > bounds.min.z());
    }
}
