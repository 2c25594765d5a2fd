#pragma once

#include <filesystem>
#include <string>

namespace spawnfield {

/// Returns the folder of this library's own file; empty if the system does not know it.
std::filesystem::path library_folder();

/// Returns the address of `symbol` in the module `file_name`, which lies beside this library. Opens the module at the
/// first call; it is never closed. Throws std::runtime_error, which begins with `failure` ("SDF cannot be read").
const void* module_symbol(const char* file_name, const char* symbol, const std::string& failure);

}  // namespace spawnfield
