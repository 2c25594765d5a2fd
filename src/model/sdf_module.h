#pragma once

#include "model/jointed_model.h"
#include "model/sdf_model.h"

/// What asks libsdformat is a module of its own (src/sdf), loaded when the first SDF file is read: libsdformat compiles
/// a regular expression in each of its files when it is loaded, 50 ms that every start of a program would pay.
namespace spawnfield::sdf_module {

SdfContent read_file(const std::filesystem::path& file, ModelPaths& paths, const std::optional<std::string>& text);
JointedModel read_model(const std::filesystem::path& file, ModelPaths& paths, const std::vector<JointPosition>& joints);

/// What the module's only symbol points to.
struct Functions {
    decltype(&read_file) file;
    decltype(&read_model) model;
};
inline constexpr const char* symbol = "spawnfield_sdf_functions";

}  // namespace spawnfield::sdf_module
