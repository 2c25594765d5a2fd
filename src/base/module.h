#pragma once

#include <spawnfield/export.h>

#include <filesystem>

namespace spawnfield {

/// Returns the folder that contains this library's file; empty if the system does not know it.
std::filesystem::path library_folder();

/// Returns the address of the symbol spawnfield_NAME_functions in a module: the shared library libspawnfield_NAME.so in
/// the folder of this library, which is loaded at the first call and never unloaded. Throws std::runtime_error if that
/// fails, or if the module has another version than this library; its text begins with `failure` ("SDF cannot be
/// read").
const void* module_symbol(const char* name, const char* failure);

/// Returns the functions of a module, and loads it at the first call. The type Functions is the module's interface: it
/// has pointers to functions, and the constants `module` and `failure`, the arguments of module_symbol(). The module
/// exports them with SPAWNFIELD_MODULE.
///
/// A module contains all code that uses a foreign library which takes long to load. The types of its functions'
/// arguments and results must be plain values, or have functions that this library exports, or inline functions without
/// static variables: the library and the module each have a copy of these. Throws std::runtime_error as
/// module_symbol().
template <class Functions>
const Functions& module_functions()
{
    static const auto* const functions = static_cast<const Functions*>(
        module_symbol(Functions::module, Functions::failure));
    return *functions;
}

}  // namespace spawnfield

/// Defines all that the module `name` exports: its version, and its functions in the order of the fields of Functions.
/// The library looks both up by name after it has loaded the module.
#define SPAWNFIELD_MODULE(name, ...)                                                                    \
    extern "C" SPAWNFIELD_API const char* const spawnfield_##name##_version;                            \
    const char* const spawnfield_##name##_version = SPAWNFIELD_VERSION;                                 \
    extern "C" SPAWNFIELD_API const spawnfield::name##_module::Functions spawnfield_##name##_functions; \
    const spawnfield::name##_module::Functions spawnfield_##name##_functions { __VA_ARGS__ }
