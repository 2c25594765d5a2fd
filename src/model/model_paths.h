#pragma once

#include <spawnfield/export.h>

#include <filesystem>
#include <set>
#include <string>
#include <vector>

namespace spawnfield {

/// Where the URIs of SDF and URDF files lead: model://, package://, file://, Fuel's https://, and relative paths.
class ModelPaths {
public:
    using Path = std::filesystem::path;

    /// Looks into the given folders first, then into those of GZ_SIM_RESOURCE_PATH, IGN_GAZEBO_RESOURCE_PATH and
    /// GAZEBO_MODEL_PATH, then into the folders above `file` and the `models` folders in them, at last at the
    /// built-in models (built_in_models.h).
    SPAWNFIELD_MODULE_API ModelPaths(const std::vector<Path>& given, const Path& file);

    /// What the URI names, seen from a file in `folder`: a file or a folder that exists, or nothing.
    SPAWNFIELD_MODULE_API Path find(const std::string& uri, const Path& folder);

    /// URIs for which a built-in model was taken, as nothing on disk has the name.
    const std::set<std::string>& built_in() const { return built_in_; }

    /// Folders above the file's own in which something was found: nobody named them.
    const std::set<Path>& guessed() const { return guessed_; }

private:
    Path find_on_disk(const std::string& uri, const Path& folder);

    std::vector<Path> named_, above_;
    std::set<Path> guessed_;
    std::set<std::string> built_in_;
};

/// Returns the SDF file of a model's folder: the file that model.config names with the highest version, or else the
/// only .sdf file. Returns any other path unchanged. Throws FileError for a folder that is no model's.
std::filesystem::path model_file_of(const std::filesystem::path& file_or_folder);

}  // namespace spawnfield
