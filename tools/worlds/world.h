#pragma once

#include <spawnfield/scene.h>

#include <filesystem>

/// Worlds made by program: the same seed gives the same world everywhere.
namespace worlds {

/// A place worth a look.
struct Landmark {
    std::string name;
    spawnfield::Bounds where;  ///< m; z as high as what stands there
};

struct World {
    spawnfield::Scene scene;
    std::vector<Landmark> landmarks = {};
};

/// Cubes of 0.5 m, 1 m apart, the first at the origin: 10 x 10 x 500 of them, and no ground. A robot's body of 0.5 m or
/// more meets one at each integer position.
World benchmark_cubes(int heights = 500);

/// The same of convex balls of 80 triangles and 0.5 m across.
World benchmark_balls(int heights = 500);

/// Whether frames, pillars and railings of a bridge are one part with its deck, terrain like it, or obstacles of their
/// own.
enum class Bridge { OneObject, DeckAlone };

/// A partly flooded district on an island in 1280 m x 1280 m of sea, after the "complex" environment of Ropelato's
/// thesis: houses, cars, fences, trunks, streets, and a bridge over a canal. 26.8 % of the square have no terrain at
/// all.
World complex_district(std::uint64_t seed = 1, Bridge bridge = Bridge::OneObject);

/// 500 x 500 m of heights from 31 to 124 m, after the low-complexity environment of the MSc thesis that spawnfield grew
/// from (Ropelato): a lake, a small town, a dense and a thin forest. Obstacles are compounds of boxes and capsules. The
/// ground, one mesh, ends at 499.9 m. Landmarks: fountain, lake, dense_forest, thin_forest, town.
World low_complexity(std::uint64_t seed = 1);

/// Writes scene.yaml, meshes/<part>.obj for parts of triangles, and landmarks.csv (name,x0,y0,z0,x1,y1,z1) into a
/// folder that is made where missing. Lengths are rounded to 0.01 mm. load_scene reads the world back. Throws
/// OutputError if a file can't be written.
void write_world(const World& world, const std::filesystem::path& folder);

}  // namespace worlds
