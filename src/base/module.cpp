#include "base/module.h"

#include <dlfcn.h>

#include <filesystem>
#include <stdexcept>

namespace spawnfield {

const void* module_symbol(const char* file_name, const char* symbol, const std::string& failure)
{
    Dl_info here{};
    const bool known = dladdr(reinterpret_cast<const void*>(&module_symbol), &here) != 0;
    const std::filesystem::path file = known ? std::filesystem::path(here.dli_fname).parent_path() / file_name : std::filesystem::path(file_name);
    void* const module = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
    const void* const found = module == nullptr ? nullptr : dlsym(module, symbol);
    if (found != nullptr) return found;
    const char* const reason = dlerror();
    throw std::runtime_error(failure + ": " + file.string() + " cannot be loaded: " + (reason != nullptr ? reason : "no reason is told"));
}

}  // namespace spawnfield
