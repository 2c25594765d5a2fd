#pragma once

#include "worlds/world.h"

#include <spawnfield/query.h>

#include <filesystem>
#include <functional>
#include <optional>

namespace experiments {

struct Settings {
    std::filesystem::path folder;  ///< folder of all results
    bool quick = false;  ///< coarse steps and maps, few repetitions: only shows that everything works and that the
                         ///< invariants hold
    int threads = 0;     ///< 0: all cores
    std::function<void(const std::string&)> on_step = [](const std::string&) {
    };  ///< is called with a text for each step
};

/// A world that was written, baked and read.
struct Environment {
    std::string name;
    spawnfield::Map map;
    std::vector<worlds::Landmark> landmarks = {};
    std::uint64_t seed = 0;
    double make_seconds = 0, bake_seconds = 0, read_seconds = 0;
};

/// Makes the world, writes it to FOLDER/worlds/NAME, bakes it at a resolution (m) to FOLDER/maps/NAME and reads the
/// map.
Environment environment(const Settings& settings, const std::string& name,
                        const std::function<worlds::World(std::uint64_t)>& make, double resolution);

/// Returns an environment without any part, with bounds of 10 x 10 x `heights` positions, 1 m apart.
Environment empty_environment(int heights);

/// Returns the Husky of the thesis. "box" is its base of 0.99 x 0.67 x 0.39 m. "hull" is the convex hull (196
/// triangles) of a mesh of that size with rounded edges. Writes its files to FOLDER/robots.
spawnfield::Robot robot(const Settings& settings, const std::string& name);

}  // namespace experiments
