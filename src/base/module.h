#pragma once

#include <string>

namespace spawnfield {

/// What `symbol` points to in the module `file_name` beside this library. It is opened at the first call, and for good.
/// Throws std::runtime_error, which begins with `failure` ("SDF cannot be read").
const void* module_symbol(const char* file_name, const char* symbol, const std::string& failure);

}  // namespace spawnfield
