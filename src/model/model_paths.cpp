#include "model/model_paths.h"

#include "base/input_watch.h"
#include "base/number.h"
#include "base/text.h"
#include "base/xml.h"
#include "model/built_in_models.h"

#include <spawnfield/error.h>
#include <spawnfield/input_file.h>

#include <cstdlib>

namespace spawnfield {
namespace {

namespace fs = std::filesystem;

/// Counts a file, or the files of a model's folder, as opened: libsdformat opens them itself.
void count_files(const fs::path& found)
{
    if (is_file(found)) return count_input(found);
    std::error_code impossible;
    for (const fs::directory_entry& entry : fs::directory_iterator(found, impossible))
        if (is_file(entry.path())) count_input(entry.path());
}

std::string without(const std::string& prefix, const std::string& text) { return text.substr(prefix.size()); }

void add_variable(const char* variable, std::vector<fs::path>& folders)
{
    const char* const value = std::getenv(variable);
    const std::string text = value != nullptr ? value : "";
    for (std::size_t start = 0; start < text.size();) {
        const std::size_t colon = std::min(text.find(':', start), text.size());
        if (colon > start) folders.emplace_back(text.substr(start, colon - start));
        start = colon + 1;
    }
}

/// Returns the path of `inside` in `folder`; empty if it does not exist. `folder` contains models, or is itself the
/// model's folder: then its own name is the first part of `inside`.
fs::path found_in(const fs::path& folder, const fs::path& inside)
{
    if (does_exist(folder / inside)) return folder / inside;
    const bool is_own = !inside.empty() && folder.filename() == *inside.begin();
    return is_own && does_exist(folder.parent_path() / inside) ? folder.parent_path() / inside : fs::path();
}

/// Returns the folder of a Fuel model that Gazebo has downloaded; empty if there is none. Gazebo stores it in
/// ~/.gz/fuel/HOST/OWNER/models/NAME/VERSION, in lower case. The URI is
/// https://HOST/1.0/OWNER/models/NAME[/VERSION|/tip][/files/…], with %20 for spaces. The highest version on disk is
/// used.
fs::path found_in_fuel_cache(const std::string& uri)
{
    std::vector<std::string> words;
    for (const fs::path& word : fs::path(without("https://", uri))) words.push_back(word.string());
    if (words.size() < 5) return {};
    std::string name = lower_case(words[4]);
    for (std::size_t space = name.find("%20"); space != std::string::npos; space = name.find("%20"))
        name.replace(space, 3, " ");
    const std::string owner = lower_case(words[2]);
    for (const fs::path& cache : fuel_caches()) {
        const fs::path versions = cache / words[0] / owner / words[3] / name;
        double newest = 0;
        std::error_code none;
        for (const fs::directory_entry& entry : fs::directory_iterator(versions, none)) {
            double version = 0;
            if (parse_number(entry.path().filename().string(), version)) newest = std::max(newest, version);
        }
        if (newest > 0) return versions / number(newest);
    }
    return {};
}

fs::path sdf_file_of(const fs::path& folder)
{
    const fs::path config = folder / "model.config";
    if (is_file(config)) {
        const auto document = read_xml(config, "a <model> element");
        std::string name;
        double highest = -1;
        for_each_child(*document->RootElement(), "sdf", [&](const Xml& sdf) {
            const double version = sdf.DoubleAttribute("version", 0);
            // model.config often names files for old simulators that do not exist.
            if (sdf.GetText() == nullptr || version <= highest || !is_file(folder / sdf.GetText())) return;
            highest = version;
            name = sdf.GetText();
        });
        if (!name.empty()) return folder / name;
    }
    std::vector<fs::path> files;
    std::error_code unreadable;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, unreadable))
        if (entry.path().extension() == ".sdf") files.push_back(entry.path());
    if (unreadable) throw FileError(folder.string(), "cannot be read: " + unreadable.message());
    if (files.size() == 1) return files[0];
    if (is_file(folder / "model.sdf")) return folder / "model.sdf";
    throw FileError(
        folder.string(),
        files.empty()
            ? "is a folder without model.config and without a .sdf file, so it is not a model; give the folder of a "
              "model, or an SDF file"
            : "has several .sdf files, but no model.config that names one of them; give the .sdf file itself");
}

}  // namespace

std::vector<fs::path> named_model_folders(const std::vector<fs::path>& given)
{
    std::vector<fs::path> out = given;
    for (const char* const variable : {"GZ_SIM_RESOURCE_PATH", "IGN_GAZEBO_RESOURCE_PATH", "GAZEBO_MODEL_PATH"})
        add_variable(variable, out);
    return out;
}

std::vector<fs::path> fuel_caches()
{
    const char* const home = std::getenv("HOME");
    if (home == nullptr) return {};
    return {fs::path(home) / ".gz/fuel", fs::path(home) / ".ignition/fuel"};
}

ModelPaths::ModelPaths(const std::vector<Path>& given, const Path& file) : named_(named_model_folders(given))
{
    const Path absolute = fs::absolute(file).lexically_normal();
    for (Path folder = absolute.parent_path(); folder != folder.root_path(); folder = folder.parent_path()) {
        above_.push_back(folder);
        above_.push_back(folder / "models");
    }
}

ModelPaths::Path ModelPaths::find(const std::string& uri, const Path& folder)
{
    const Path found = find_on_disk(uri, folder);
    count_files(found);
    const std::string model = found.empty() ? built_in_model(uri) : "";
    if (model.empty()) return found;
    built_in_.insert(uri);
    return built_in_file(model);
}

ModelPaths::Path ModelPaths::find_on_disk(const std::string& uri, const Path& folder)
{
    if (uri.starts_with("https://") || uri.starts_with("http://")) return found_in_fuel_cache(uri);
    Path inside = uri;
    bool is_named = false;  // the URI begins with a model or package name, so it is not relative to `folder`
    for (const char* const scheme : {"model://", "package://", "file://"})
        if (uri.starts_with(scheme)) {
            inside = without(scheme, uri);
            is_named = std::string(scheme) != "file://";
        }
    if (inside.empty()) return {};
    if (inside.is_absolute()) return does_exist(inside) ? inside : Path();
    if (!is_named && does_exist(folder / inside)) return folder / inside;
    for (const Path& named : named_)
        if (const Path found = found_in(named, inside); !found.empty()) return found;
    for (const Path& above : above_)
        if (const Path found = found_in(above, inside); !found.empty()) {
            if (above != above_.front()) guessed_.insert(above);  // the folder of the file itself is not a guess
            return found;
        }
    return {};
}

fs::path model_file_of(const fs::path& file_or_folder)
{
    return is_folder(file_or_folder) ? sdf_file_of(file_or_folder) : file_or_folder;
}

}  // namespace spawnfield
