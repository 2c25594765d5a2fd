#pragma once

#include <spawnfield/scene.h>

#include <filesystem>

/// Worlds that a program makes. The same seed gives the same world on every machine.
namespace worlds {

/// A region of a world that is worth a picture.
struct Landmark {
    std::string name;
    spawnfield::Bounds where;  ///< m; the upper z limit is the top of the highest thing there
};

struct World {
    spawnfield::Scene scene;
    std::vector<Landmark> landmarks = {};
};

/// Returns 10 x 10 x `heights` cubes of 0.5 m, 1 m apart, the first at the origin, without any ground. A robot whose
/// body is at least 0.5 m long collides at each integer position.
World benchmark_cubes(int heights = 500);

/// Returns the same with convex balls of 80 triangles and 0.5 m diameter.
World benchmark_balls(int heights = 500);

/// Whether the frames, pillars and railings of a bridge are one terrain part with its deck, or separate obstacles.
enum class Bridge { OneObject, DeckAlone };

/// Returns a partly flooded district on an island in 1280 x 1280 m of sea, after the "complex" environment of
/// Ropelato's thesis: houses, cars, fences, trunks, streets, and a bridge over a canal. 26.8 % of the square have no
/// terrain.
World complex_district(std::uint64_t seed = 1, Bridge bridge = Bridge::OneObject);

/// Returns 500 x 500 m of land with heights from 31 to 124 m, after the low-complexity environment of the MSc thesis
/// that spawnfield grew from (Ropelato): a lake, a small town, a dense and a thin forest. Obstacles are compounds of
/// boxes and capsules. The ground is one mesh that ends at 499.9 m. Landmarks: fountain, lake, dense_forest,
/// thin_forest, town.
World low_complexity(std::uint64_t seed = 1);

/// Writes scene.yaml, meshes/<part>.obj for parts that have triangles, and landmarks.csv (name,x0,y0,z0,x1,y1,z1) into
/// a folder, which is created if needed. Lengths are rounded to 0.01 mm. load_scene reads the world back. Throws
/// OutputError if a file cannot be written.
void write_world(const World& world, const std::filesystem::path& folder);

}  // namespace worlds
