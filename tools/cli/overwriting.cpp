#include "overwriting.h"

#include "streams.h"

#include <spawnfield/error.h>
#include <spawnfield/input_file.h>
#include <spawnfield/map.h>
#include <spawnfield/map_export.h>
#include <spawnfield/output_file.h>
#include <spawnfield/scene.h>

#include <algorithm>
#include <exception>
#include <filesystem>

namespace spawnfield::cli {
namespace {

namespace fs = std::filesystem;

struct NamedPath {
    std::string option;  ///< as in messages
    std::string value;   ///< as it was given
    fs::path path;       ///< without links
};

fs::path without_links(const std::string& value)
{
    std::error_code error;
    const fs::path path = fs::weakly_canonical(fs::absolute(value, error), error);
    return error || path.has_filename() ? path : path.parent_path();
}

std::vector<std::string> values_of(const CLI::App& command, const std::string& option)
{
    const CLI::Option* const found = command.get_option_no_throw(option);
    return found == nullptr ? std::vector<std::string>() : found->results();
}

/// Returns the path in a value: that of husky.yaml@3,4,90deg is husky.yaml.
std::string path_in(const std::string& value) { return does_exist(value) ? value : value.substr(0, value.rfind('@')); }

bool is_map_folder(const fs::path& path) { return is_file(path / "map.yaml"); }

/// Returns an option's name for messages; positional ones have no dashes.
std::string words_for(const std::string& option)
{
    return option.starts_with("-") ? option : option == "what" ? "the input" : "the " + option;
}

/// Returns all files and folders that exist and are read.
std::vector<NamedPath> inputs_of(const CLI::App& command)
{
    std::vector<NamedPath> out;
    for (const char* const option : input_options) {
        if (command.get_name() == "sample" && std::string(option) == "--pairs") continue;  // a number
        const std::string label = words_for(option);
        for (const std::string& value : values_of(command, option)) {
            const std::string path = path_in(value);
            if (is_standard(value) || !does_exist(path)) continue;
            out.push_back({label, path, without_links(path)});
            if (!is_folder(path) || is_map_folder(path)) continue;
            try {
                out.push_back({label, path, without_links(scene_file_of(path).string())});  // of a model's folder
            } catch (const std::exception&) {  // it is refused when it is read
            }
        }
    }
    return out;
}

std::vector<NamedPath> outputs_of(const CLI::App& command)
{
    std::vector<NamedPath> out;
    for (const char* const option : output_options)
        for (const std::string& value : values_of(command, option)) {
            if (value.empty() || is_standard(value) || is_written_directly(value)) continue;
            out.push_back({option, value, without_links(value)});
        }
    if (values_of(command, "--format") != std::vector<std::string>{"nav2"}) return out;
    for (const std::string& value : values_of(command, "--out")) {
        const std::string ending = fs::path(value).extension().string();
        if (ending != ".yaml" && ending != ".yml") continue;  // refused later
        const std::string image = nav2_image_of(value).string();
        out.push_back({"the image of --out", image, without_links(image)});
    }
    return out;
}

bool is_same(const fs::path& a, const fs::path& b)
{
    std::error_code ignored;
    return a == b || fs::equivalent(a, b, ignored);  // equivalent: also two hard links
}

/// Returns whether the path lies in the folder, at any depth.
bool is_inside(const fs::path& path, const fs::path& folder)
{
    for (fs::path above = path.parent_path();; above = above.parent_path()) {
        if (is_same(above, folder)) return true;
        if (above == above.parent_path()) return false;
    }
}

/// Returns whether writing the folder removes this file in it. A bake keeps files that do not belong to the map.
bool is_removed_with(const CLI::App& command, const fs::path& folder, const fs::path& file)
{
    if (!is_folder(folder) || !is_inside(file, folder)) return false;
    if (command.get_name() != "bake") return true;
    const auto is_it = [&](const char* name) { return is_same(folder / name, file); };
    return is_it("map.yaml") || std::any_of(map_files.begin(), map_files.end(), is_it);
}

void check_pair(const CLI::App& command, const NamedPath& output, const NamedPath& input)
{
    const std::string start = output.option + " is " + output.value + ", ";
    if (is_same(output.path, input.path))
        throw ArgumentError(start + "the same " + (is_folder(input.path) ? "folder" : "file") + " as " + input.option +
                            ", which is read; choose another name for the output");
    if (is_map_folder(input.path) && is_inside(output.path, input.path))
        throw ArgumentError(start + "which lies in the folder " + input.value + " that is read as " + input.option +
                            "; choose a name outside of it");
    if (is_removed_with(command, output.path, input.path))
        throw ArgumentError(start + "a folder that contains " + input.value + ", which is read as " + input.option +
                            "; choose another name for the output");
}

}  // namespace

void check_overwriting(const CLI::App& command)
{
    const std::vector<NamedPath> in = inputs_of(command), out = outputs_of(command);
    for (const NamedPath& output : out)
        for (const NamedPath& input : in) check_pair(command, output, input);
    for (std::size_t i = 0; i < out.size(); ++i)
        for (std::size_t j = i + 1; j < out.size(); ++j)
            if (is_same(out[i].path, out[j].path))
                throw ArgumentError(out[i].option + " and " + out[j].option + " are the same file, " + out[j].value +
                                    "; choose another name for one of them");
}

}  // namespace spawnfield::cli
