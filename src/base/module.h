#pragma once

#include <filesystem>
#include <string>

namespace spawnfield {

/// Returns the folder that contains this library's file; empty if the system does not know it.
std::filesystem::path library_folder();

/// Returns the address of `symbol` in a module: a shared library `file_name` in the folder of this library, which is
/// loaded at the first call and never unloaded. Throws std::runtime_error if that fails; its text begins with `failure`
/// ("SDF cannot be read").
const void* module_symbol(const char* file_name, const char* symbol, const std::string& failure);

}  // namespace spawnfield
