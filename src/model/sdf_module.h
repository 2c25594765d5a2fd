#pragma once

#include "model/jointed_model.h"
#include "model/sdf_model.h"

/// The interface of the module src/sdf: a shared library that contains all code that uses libsdformat, and that is
/// loaded when the first SDF file is read. Loading libsdformat takes 50 ms, because it compiles many regular
/// expressions at its start. Without the module, each start of a program would take that time.
namespace spawnfield::sdf_module {

SdfContent read_file(const std::filesystem::path& file, ModelPaths& paths, const std::optional<std::string>& text);
JointedModel read_model(const std::filesystem::path& file, ModelPaths& paths, const std::vector<JointPosition>& joints);

/// The functions that the module exports.
struct Functions {
    static constexpr const char *module = "sdf", *failure = "SDF cannot be read";
    decltype(&read_file) file;
    decltype(&read_model) model;
};

}  // namespace spawnfield::sdf_module
