#include "model/built_in_models.h"

#include "base/module.h"
#include "base/text.h"

#include <spawnfield/input_file.h>

#include <stdexcept>
#include <vector>

namespace spawnfield {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> split_at_slashes(const std::string& text)
{
    std::vector<std::string> out;
    for (std::size_t start = 0; start < text.size();) {
        const std::size_t slash = std::min(text.find('/', start), text.size());
        if (slash > start) out.push_back(text.substr(start, slash - start));
        start = slash + 1;
    }
    return out;
}

/// Returns, for example, "groundplane" for "Ground%20Plane", "ground_plane" and "GroundPlane".
std::string plain_name(std::string name)
{
    for (std::size_t space = name.find("%20"); space != std::string::npos; space = name.find("%20"))
        name.erase(space, 3);
    std::erase_if(name, [](char c) { return c == ' ' || c == '_' || c == '-'; });
    return lower_case(name);
}

/// Returns NAME of `https://HOST/1.0/OpenRobotics/models/NAME[/VERSION]`, or "" for another address.
std::string name_on_fuel(const std::vector<std::string>& words)
{
    const bool is_model = words.size() >= 6 && words.size() <= 7 && lower_case(words[3]) == "openrobotics" &&
                          words[4] == "models";
    return is_model ? words[5] : "";
}

/// Returns NAME of `model://NAME`, `model://NAME/model.sdf` or NAME, or "" for another path.
std::string name_of_model(std::vector<std::string> words, bool has_scheme)
{
    if (has_scheme) words.erase(words.begin());
    if (words.size() == 2 && words[1] == "model.sdf") words.pop_back();
    return words.size() == 1 ? words[0] : "";
}

}  // namespace

std::string built_in_model(const std::string& uri)
{
    const bool is_web = uri.starts_with("https://") || uri.starts_with("http://"),
               has_scheme = uri.starts_with("model://");
    if (!is_web && !has_scheme && uri.find(':') != std::string::npos) return "";
    const std::vector<std::string> words = split_at_slashes(uri);
    const std::string name = plain_name(is_web ? name_on_fuel(words) : name_of_model(words, has_scheme));
    return name == "groundplane" ? "ground_plane" : name == "sun" ? "sun" : "";
}

fs::path built_in_folder() { return library_folder() / "spawnfield-models"; }

fs::path built_in_file(const std::string& model)
{
    const fs::path file = built_in_folder() / (model + ".sdf");
    if (!is_file(file)) throw std::runtime_error(file.string() + " is missing; install spawnfield again");
    return file;
}

}  // namespace spawnfield
