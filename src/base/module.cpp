#include "base/module.h"

#include <spawnfield/types.h>

#include <dlfcn.h>

#include <stdexcept>
#include <string>

namespace spawnfield {

std::filesystem::path library_folder()
{
    Dl_info here{};
    const bool known = dladdr(reinterpret_cast<const void*>(&library_folder), &here) != 0;
    return known ? std::filesystem::path(here.dli_fname).parent_path() : std::filesystem::path();
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
