#pragma once

#include "worlds/world.h"

#include <spawnfield/query.h>

#include <filesystem>
#include <functional>
#include <optional>

namespace experiments {

struct Settings {
    std::filesystem::path folder;  ///< of all results
    bool quick = false;            ///< coarse steps and maps, few repetitions: whether it works, and the invariants
    int threads = 0;               ///< 0: all cores
    std::function<void(const std::string&)> tell = [](const std::string&) {};  ///< what goes on
};

/// A world, written, baked and read.
struct Environment {
    std::string name;
    spawnfield::Map map;
    std::vector<worlds::Landmark> landmarks = {};
    std::uint64_t seed = 0;
    double make_seconds = 0, bake_seconds = 0, read_seconds = 0;
};

/// Makes the world, writes it to FOLDER/worlds/NAME, bakes that at a resolution (m) to FOLDER/maps/NAME and reads the
/// map.
Environment environment(const Settings& settings, const std::string& name,
                        const std::function<worlds::World(std::uint64_t)>& make, double resolution);

/// Nothing at all within bounds of 10 x 10 x `heights` positions, 1 m apart.
Environment empty_environment(int heights);

/// The thesis's Husky: "box", its base of 0.99 x 0.67 x 0.39 m, or "hull", the convex hull of a mesh of that size with
/// rounded edges, which goes to FOLDER/robots: 196 triangles.
spawnfield::Robot robot(const Settings& settings, const std::string& name);

}  // namespace experiments
