#include "base/module.h"

#include <dlfcn.h>

#include <stdexcept>

namespace spawnfield {

std::filesystem::path library_folder()
{
    Dl_info here{};
    const bool known = dladdr(reinterpret_cast<const void*>(&library_folder), &here) != 0;
    return known ? std::filesystem::path(here.dli_fname).parent_path() : std::filesystem::path();
}

const void* module_symbol(const char* file_name, const char* symbol, const std::string& failure)
{
    const std::filesystem::path file = library_folder() / file_name;
    void* const module = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
    const void* const found = module == nullptr ? nullptr : dlsym(module, symbol);
    if (found != nullptr) return found;
    const char* const reason = dlerror();
    throw std::runtime_error(failure + ": " + file.string() +
                             " cannot be loaded: " + (reason != nullptr ? reason : "no reason is known"));
}

}  // namespace spawnfield
