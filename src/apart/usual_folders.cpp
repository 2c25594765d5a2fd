#include "model/model_paths.h"

#include <spawnfield/input_file.h>
#include <spawnfield/reader_process.h>

#include <algorithm>
#include <array>
#include <string_view>

namespace spawnfield {
namespace {

namespace fs = std::filesystem;

/// Names of folders inside of ROS packages and Gazebo projects whose files name others beside these folders.
constexpr std::array<std::string_view, 8> inner_folders{"worlds", "world", "urdf",   "sdf",
                                                        "robots", "robot", "scenes", "launch"};

bool is_inner(const fs::path& folder)
{
    return std::find(inner_folders.begin(), inner_folders.end(), folder.filename().string()) != inner_folders.end();
}

}  // namespace

std::vector<fs::path> usual_folders(const fs::path& file, const std::vector<fs::path>& model_paths)
{
    std::vector<fs::path> out = named_model_folders(model_paths);
    const std::vector<fs::path> downloaded = fuel_caches();
    out.insert(out.end(), downloaded.begin(), downloaded.end());
    std::error_code none;
    std::erase_if(out, [&](const fs::path& folder) { return !is_folder(folder); });
    const fs::path path = fs::weakly_canonical(file, none), own = is_folder(path) ? path : path.parent_path();
    out.push_back(is_inner(own) ? own.parent_path() : own);
    return out;
}

}  // namespace spawnfield
