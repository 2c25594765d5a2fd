#pragma once

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace spawnfield::cli {

/// How models are found and read, for scenes and robots.
struct ModelPathArgs {
    std::vector<std::string> model_paths;
    bool any_mesh = false;
};

/// Adds --model-path and --any-mesh.
inline void add_model_path(CLI::App& command, ModelPathArgs& args)
{
    command
        .add_option("--model-path,--package-path", args.model_paths,
                    "Folder with models or ROS packages, for model:// and package:// in SDF and URDF (repeatable). "
                    "GZ_SIM_RESOURCE_PATH, GAZEBO_MODEL_PATH and the folders above the file are searched after it")
        ->allow_extra_args(false)
        ->check(CLI::ExistingDirectory);
    command.add_flag("--any-mesh", args.any_mesh,
                     "Read meshes in all formats that assimp reads, not only 3ds, 3mf, dae, fbx, glb, gltf, obj, off, "
                     "ply and stl");
}

}  // namespace spawnfield::cli
