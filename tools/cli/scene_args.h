#pragma once

#include "common_args.h"
#include "model_path.h"

#include <spawnfield/scene.h>

#include <optional>
#include <string>
#include <vector>

namespace spawnfield::cli {

/// Options of commands that read a scene: `bake` and `info`.
struct SceneArgs {
    std::string up, heightmap, unknown;
    double scale = 1;
    std::optional<double> wall_height;
    std::vector<std::string> labels;
    std::string auto_label;
    bool strict = false, allow_missing = false;
};

/// Adds --label and --auto-label.
void add_label_options(CLI::App& command, SceneArgs& args);

/// Adds the other options, in a group of their own.
void add_scene_options(CLI::App& command, SceneArgs& args);

/// The names of all these options, for commands that have to refuse them.
inline const std::vector<std::string> scene_option_names{"--up",         "--scale",       "--heightmap",
                                                         "--unknown",    "--wall-height", "--label",
                                                         "--auto-label", "--strict",      "--allow-missing"};

/// Throws ArgumentError.
SceneOptions scene_options(const SceneArgs& args, const ModelPathArgs& paths);

}  // namespace spawnfield::cli
