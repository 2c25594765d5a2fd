#include "base/module.h"

#include <spawnfield/types.h>

#include <dlfcn.h>
#include <link.h>

#include <stdexcept>
#include <string>

namespace spawnfield {

std::filesystem::path library_folder()
{
    Dl_info here{};
    void* object = nullptr;  // a link_map
    if (dladdr1(reinterpret_cast<const void*>(&library_folder), &here, &object, RTLD_DL_LINKMAP) == 0) return {};
    // A program that contains the library has no name there, and `here` has what it was called, which may be found in
    // PATH only.
    const bool is_program = *static_cast<const link_map*>(object)->l_name == '\0';
    const std::filesystem::path file = is_program ? std::filesystem::read_symlink("/proc/self/exe")
                                                  : std::filesystem::path(here.dli_fname);
    return file.parent_path();
}

const void* module_symbol(const char* name, const char* failure)
{
    const std::string module = std::string("spawnfield_") + name;
    const std::filesystem::path file = library_folder() / ("lib" + module + ".so");
    void* const loaded = dlopen(file.c_str(), RTLD_LAZY | RTLD_LOCAL);  // RTLD_NOW would take 1.5 times as long
    const auto find = [&](const char* symbol) {
        const void* const found = loaded == nullptr ? nullptr : dlsym(loaded, (module + symbol).c_str());
        if (found != nullptr) return found;
        const char* const reason = dlerror();
        throw std::runtime_error(std::string(failure) + ": " + file.string() +
                                 " cannot be loaded: " + (reason != nullptr ? reason : "no reason is known"));
    };
    const void* const functions = find("_functions");
    const std::string of_module = *static_cast<const char* const*>(find("_version"));
    if (of_module != version())
        throw std::runtime_error(std::string(failure) + ": " + file.string() + " has version " + of_module +
                                 ", needs " + version() + "; install the library and its modules together");
    return functions;
}

}  // namespace spawnfield
