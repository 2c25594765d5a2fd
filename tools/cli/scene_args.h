#pragma once

#include "cli.h"

#include <spawnfield/scene.h>

namespace spawnfield::cli {

/// Options of whatever reads a scene: `bake` and `info`.
struct SceneArgs {
    std::string up, heightmap;
    double scale = 1, wall_height = 0;
    std::vector<std::string> labels, model_paths;
    bool strict = false;
};
void add_scene_options(CLI::App& command, SceneArgs& args);

/// Their names, to tell that they say nothing elsewhere.
inline const std::vector<std::string> scene_option_names{"--up", "--scale", "--heightmap", "--wall-height", "--label", "--model-path", "--strict"};

/// Throws ArgumentError.
SceneOptions scene_options(const SceneArgs& args);

}  // namespace spawnfield::cli
