#pragma once

#include <spawnfield/export.h>
#include <spawnfield/robot.h>
#include <spawnfield/scene.h>

#include <filesystem>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

namespace spawnfield {

/// A program that reads files for this one. The libraries that read meshes, SDF, OctoMaps and TIFF images were written
/// for files that one trusts: a hostile file can crash them, keep them busy for ever, or fill the memory. In a process
/// of their own, this ends that process alone, and the caller gets a FileError that names the file.
///
/// The process has limits, which grow with the size of all files that it opens: 900 MB of memory, and 900 MB more for
/// each MB above 1 MB, but at most max_memory; and, while one of those libraries reads, 12 s of processor time, and 5 s
/// more for each MB. It is killed if it waits for 15 s without doing anything, and if the caller's thread ends.
struct ReaderProcess {
    /// A program whose main() calls serve_reader() first; `/proc/self/exe` is the calling program itself.
    std::filesystem::path program;
    /// Called ten times per second while the process reads. May throw; this ends the process.
    std::function<void()> wait = {};
    double max_memory = std::numeric_limits<double>::infinity();  ///< bytes, > 0
    /// Only files in these folders may be read, at any depth, after links are resolved; empty: all files.
    std::vector<std::filesystem::path> confine = {};
    /// Gets the paths of all files that were read, without links, each once. Not called after an error, and for a robot
    /// that is read in the calling process.
    std::function<void(const std::vector<std::filesystem::path>&)> report = {};
};

/// Reads a scene as load_scene() does, in a process of its own. The process gets the environment of this one. Throws
/// what load_scene() throws; FileError if the process crashes or reaches a limit; std::runtime_error if it cannot be
/// started.
SPAWNFIELD_API Scene load_scene_apart(const std::filesystem::path& file, const SceneOptions& options,
                                      const ReaderProcess& process);

/// Reads a robot as load_robot() does, in a process of its own if the robot's file may name a mesh or is an SDF file.
/// Throws as load_scene_apart().
SPAWNFIELD_API Robot load_robot_apart(const std::string& robot, const RobotOptions& options,
                                      const ReaderProcess& process);

/// Returns folders for ReaderProcess::confine, for a scene or robot from anywhere: the folder of the file, or the one
/// above it if its name is usual inside of a project (worlds, urdf, …); `model_paths`, those of GZ_SIM_RESOURCE_PATH,
/// IGN_GAZEBO_RESOURCE_PATH and GAZEBO_MODEL_PATH, and the models that Gazebo has downloaded (~/.gz/fuel,
/// ~/.ignition/fuel). Folders that do not exist are left out.
SPAWNFIELD_API std::vector<std::filesystem::path> usual_folders(const std::filesystem::path& file,
                                                                const std::vector<std::filesystem::path>& model_paths);

/// If these are the arguments that load_scene_apart() and load_robot_apart() start a program with: reads what they ask
/// for, and returns the status with which main() must end. Otherwise returns nothing.
SPAWNFIELD_API std::optional<int> serve_reader(int argc, char** argv);

}  // namespace spawnfield
