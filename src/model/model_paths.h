#pragma once

#include <spawnfield/export.h>

#include <filesystem>
#include <set>
#include <string>
#include <vector>

namespace spawnfield {

/// Returns the folders of models that the user has named: these, and then those of GZ_SIM_RESOURCE_PATH,
/// IGN_GAZEBO_RESOURCE_PATH and GAZEBO_MODEL_PATH.
std::vector<std::filesystem::path> named_model_folders(const std::vector<std::filesystem::path>& given);

/// Returns the folders in which Gazebo keeps the models that it has downloaded. They need not exist.
std::vector<std::filesystem::path> fuel_caches();

/// Finds the files that URIs in SDF and URDF files name: model://, package://, file://, Fuel's https://, and relative
/// paths.
class ModelPaths {
public:
    using Path = std::filesystem::path;

    /// Sets the order of the search: first the given folders, then those of GZ_SIM_RESOURCE_PATH,
    /// IGN_GAZEBO_RESOURCE_PATH and GAZEBO_MODEL_PATH, then the folders above `file` and the `models` folders in them,
    /// and last the built-in models (built_in_models.h).
    SPAWNFIELD_MODULE_API ModelPaths(const std::vector<Path>& given, const Path& file);

    /// Returns the existing file or folder that the URI names, or an empty path. `folder` is that of the file that
    /// contains the URI.
    SPAWNFIELD_MODULE_API Path find(const std::string& uri, const Path& folder);

    /// Returns the URIs for which find() returned a built-in model, because nothing on disk has that name.
    const std::set<std::string>& built_in() const { return built_in_; }

    /// Returns the folders above the file's own folder in which find() found something, although the user did not name
    /// them.
    const std::set<Path>& guessed() const { return guessed_; }

private:
    Path find_on_disk(const std::string& uri, const Path& folder);

    std::vector<Path> named_, above_;
    std::set<Path> guessed_;
    std::set<std::string> built_in_;
};

/// Returns the SDF file of a model's folder: the file for the highest version in model.config, or else the only .sdf
/// file. Returns any other path unchanged. Throws FileError for a folder that is not a model's.
std::filesystem::path model_file_of(const std::filesystem::path& file_or_folder);

}  // namespace spawnfield
