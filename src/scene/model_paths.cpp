#include "scene/model_paths.h"

#include <cstdlib>

namespace spawnfield {
namespace {

namespace fs = std::filesystem;

void add_folders_of(const char* variable, std::vector<fs::path>& out)
{
    const char* const value = std::getenv(variable);
    const std::string list = value == nullptr ? "" : value;
    for (std::size_t start = 0; start < list.size();) {
        const std::size_t colon = std::min(list.find(':', start), list.size());
        if (colon > start) out.emplace_back(list.substr(start, colon - start));
        start = colon + 1;
    }
}

}  // namespace

std::vector<fs::path> model_folders(const std::vector<fs::path>& given, const fs::path& file)
{
    std::vector<fs::path> out = given;
    for (const char* const variable : {"GZ_SIM_RESOURCE_PATH", "IGN_GAZEBO_RESOURCE_PATH", "GAZEBO_MODEL_PATH"}) add_folders_of(variable, out);
    const fs::path absolute = fs::absolute(file).lexically_normal();
    for (fs::path folder = absolute.parent_path(); folder != folder.root_path(); folder = folder.parent_path()) out.push_back(folder);
    return out;
}

fs::path find_uri(const std::string& uri, const fs::path& base, const std::vector<fs::path>& folders)
{
    const auto if_there = [](const fs::path& path) { return fs::exists(path) ? path : fs::path(); };
    const std::string local = "file://";
    if (uri.starts_with(local)) return if_there(base / uri.substr(local.size()));
    for (const std::string scheme : {"model://", "package://"}) {
        if (!uri.starts_with(scheme)) continue;
        for (const fs::path& folder : folders)
            if (fs::exists(folder / uri.substr(scheme.size()))) return folder / uri.substr(scheme.size());
        return {};
    }
    return if_there(base / uri);
}

}  // namespace spawnfield
