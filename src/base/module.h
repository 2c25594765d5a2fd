#pragma once

#include <filesystem>
#include <string>

namespace spawnfield {

/// Returns the folder of this library's own file; empty if the system does not know it.
std::filesystem::path library_folder();

/// What `symbol` points to in the module `file_name` beside this library. It is opened at the first call, and for good.
/// Throws std::runtime_error, which begins with `failure` ("SDF cannot be read").
const void* module_symbol(const char* file_name, const char* symbol, const std::string& failure);

}  // namespace spawnfield
