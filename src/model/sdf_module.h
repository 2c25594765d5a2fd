#pragma once

#include "model/jointed_model.h"
#include "model/sdf_model.h"

/// The code that uses libsdformat is a module of its own (src/sdf), which is loaded when the first SDF file is read.
/// Loading libsdformat takes 50 ms, because it compiles a regular expression in each of its files; every start of a
/// program would pay for that.
namespace spawnfield::sdf_module {

SdfContent read_file(const std::filesystem::path& file, ModelPaths& paths, const std::optional<std::string>& text);
JointedModel read_model(const std::filesystem::path& file, ModelPaths& paths, const std::vector<JointPosition>& joints);

/// The module's functions. Its only exported symbol has this type.
struct Functions {
    decltype(&read_file) file;
    decltype(&read_model) model;
};
inline constexpr const char* symbol = "spawnfield_sdf_functions";

}  // namespace spawnfield::sdf_module
