#include "scene/sdf_module.h"

#include "robot/sdf_robot.h"

#include <dlfcn.h>

#include <stdexcept>

namespace spawnfield {
namespace {

/// The module lies beside the library that this is in.
std::filesystem::path module_file()
{
    Dl_info here{};
    if (dladdr(reinterpret_cast<const void*>(&read_sdf_file), &here) == 0) return SPAWNFIELD_SDF_MODULE;
    return std::filesystem::path(here.dli_fname).parent_path() / SPAWNFIELD_SDF_MODULE;
}

const sdf_module::Functions& functions()
{
    static const sdf_module::Functions* const loaded = [] {
        const std::filesystem::path file = module_file();
        void* const module = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);  // for good
        const void* const found = module == nullptr ? nullptr : dlsym(module, sdf_module::symbol);
        if (found == nullptr) {
            const char* const reason = dlerror();
            throw std::runtime_error("SDF cannot be read: " + file.string() + " cannot be loaded: " + (reason != nullptr ? reason : "no reason is told"));
        }
        return static_cast<const sdf_module::Functions*>(found);
    }();
    return *loaded;
}

}  // namespace

SdfContent read_sdf_file(const std::filesystem::path& file, ModelPaths& paths, const std::optional<std::string>& text)
{
    return functions().file(file, paths, text);
}

Robot read_sdf_robot(const std::filesystem::path& file_or_folder, const RobotOptions& options) { return functions().robot(file_or_folder, options); }

}  // namespace spawnfield
