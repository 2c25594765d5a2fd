#include "scene/sdf_module.h"

#include "base/module.h"
#include "robot/sdf_robot.h"

namespace spawnfield {
namespace {

const sdf_module::Functions& functions()
{
    static const auto* const loaded = static_cast<const sdf_module::Functions*>(
        module_symbol(SPAWNFIELD_SDF_MODULE, sdf_module::symbol, "SDF cannot be read"));
    return *loaded;
}

}  // namespace

SdfContent read_sdf_file(const std::filesystem::path& file, ModelPaths& paths, const std::optional<std::string>& text)
{
    return functions().file(file, paths, text);
}

Robot read_sdf_robot(const std::filesystem::path& file_or_folder, const RobotOptions& options)
{
    return functions().robot(file_or_folder, options);
}

}  // namespace spawnfield
