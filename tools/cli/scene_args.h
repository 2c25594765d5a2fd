#pragma once

#include "cli.h"
#include "model_path.h"

#include <spawnfield/scene.h>

namespace spawnfield::cli {

/// Options of whatever reads a scene: `bake` and `info`.
struct SceneArgs {
    std::string up, heightmap, unknown;
    double scale = 1;
    std::optional<double> wall_height;
    std::vector<std::string> labels;
    std::string auto_label;
    bool strict = false, allow_missing = false;
};
void add_scene_options(CLI::App& command, SceneArgs& args);

/// Their names, to tell that they say nothing elsewhere.
inline const std::vector<std::string> scene_option_names{"--up",         "--scale",       "--heightmap",
                                                         "--unknown",    "--wall-height", "--label",
                                                         "--auto-label", "--strict",      "--allow-missing"};

/// Throws ArgumentError.
SceneOptions scene_options(const SceneArgs& args, const ModelPathArgs& paths);

}  // namespace spawnfield::cli
