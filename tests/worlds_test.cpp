#include "catch.h"
#include "temp_folder.h"
#include "test_map.h"
#include "worlds/world.h"

#include <spawnfield/scene.h>

#include <algorithm>
#include <cmath>
#include <numeric>

using namespace spawnfield;

namespace {

Scene read_back(const worlds::World& world)
{
    const TempFolder folder;
    worlds::write_world(world, folder.path());
    return load_scene(folder / "scene.yaml");
}

/// All that a world writes, file after file.
std::string bytes_of_all(const worlds::World& world)
{
    const TempFolder folder;
    worlds::write_world(world, folder.path());
    return bytes_of(folder / "scene.yaml") + bytes_of(folder / "meshes/ground.obj") + bytes_of(folder / "landmarks.csv");
}

Bounds where(const worlds::World& world, const std::string& landmark)
{
    for (const auto& [name, bounds] : world.landmarks)
        if (name == landmark) return bounds;
    return {};
}

/// Primitives in a region whose names begin and end so.
int count_in(const worlds::World& world, const Bounds& region, const std::string& kind, const std::string& element)
{
    const auto is_meant = [&](const Primitive& primitive) {
        const std::string& name = world.scene.parts[primitive.part].name;
        return name.starts_with(kind) && name.ends_with(element) && bounds_of(primitive.shape).meets(region);
    };
    return int(std::count_if(world.scene.primitives.begin(), world.scene.primitives.end(), is_meant));
}

/// Of a box of the Husky's size, at the thesis's offset (2D) and greatest height (3D).
VerdictCounts thesis_counts(const Map& map, int dims, double step, const Bounds& bounds)
{
    const CollisionChecker checker(map.geometry, load_robot("box:0.99,0.67,0.39"));
    RasterOptions options;
    options.dims = dims;
    options.step = step;
    options.step_z = 0.5;
    options.offset = 1.0;
    options.bounds = bounds;
    return raster(map, checker, options).counts;
}

double share(const VerdictCounts& counts, Verdict verdict)
{
    const auto of = [&](Verdict v) { return double(counts[std::size_t(v)]); };
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
            largest = std::max(largest, (scene.vertices[scene.triangles[t][corner]] - world.scene.vertices[world.scene.triangles[t][corner]]).norm());
    CHECK(largest < 2e-5);
    for (const Piece& piece : scene.pieces) CHECK(piece.solid);
}

TEST_CASE("the low-complexity world is as high, as wide and as primitive as the thesis's")
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

TEST_CASE("of the low-complexity world the thesis's share is valid, whatever the seed")
{
    const std::uint64_t seed = GENERATE(1, 2);
    const TestMap map = map_of(worlds::low_complexity(seed).scene, 2.0);
    const VerdictCounts flat = thesis_counts(map, 2, 2.5, {});
    CHECK(share(flat, Verdict::Valid) == Approx(0.896).margin(0.01));
    CHECK(share(flat, Verdict::Submerged) == Approx(0.033).margin(0.01));
    CHECK(flat[std::size_t(Verdict::OffTerrain)] < 100);
    const VerdictCounts tall = thesis_counts(map, 3, 2.5, {Vec3(0, 0, 31), Vec3(500, 500, 124)});
    CHECK(share(tall, Verdict::Valid) == Approx(0.870).margin(0.015));
}

TEST_CASE("a raster that reaches 500 m leaves the low-complexity ground in its last row and column")
{
    const TestMap map = map_of(worlds::low_complexity().scene, 2.0);
    const auto poses = [&](double step) {
        const VerdictCounts counts = thesis_counts(map, 2, step, {});
        return std::accumulate(counts.begin(), counts.end(), std::uint64_t(0));
    };
    CHECK(poses(4) == 125 * 125);    // of 126 x 126
    CHECK(poses(4.5) == 112 * 112);  // the last column is at 499.5 m
}

TEST_CASE("the low-complexity world is the same bytes for the same seed, and others for another")
{
    const std::string bytes = bytes_of_all(worlds::low_complexity(7));
    CHECK(bytes == bytes_of_all(worlds::low_complexity(7)));
    CHECK(bytes != bytes_of_all(worlds::low_complexity(8)));
}

TEST_CASE("the low-complexity landmarks hold what they say")
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
