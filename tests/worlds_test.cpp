#include "catch.h"
#include "temp_folder.h"
#include "worlds/world.h"

#include <spawnfield/scene.h>

#include <cmath>

using namespace spawnfield;

namespace {

Scene read_back(const worlds::World& world)
{
    const TempFolder folder;
    worlds::write_world(world, folder.path());
    return load_scene(folder / "scene.yaml");
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
