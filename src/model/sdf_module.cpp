#include "model/sdf_module.h"

#include "base/input_watch.h"
#include "base/module.h"

namespace spawnfield {

SdfContent read_sdf_file(const std::filesystem::path& file, ModelPaths& paths, const std::optional<std::string>& text)
{
    const ForeignReading reading("SDF reader", file);
    return module_functions<sdf_module::Functions>().file(file, paths, text);
}

JointedModel read_sdf_model(const std::filesystem::path& file, ModelPaths& paths,
                            const std::vector<JointPosition>& joints)
{
    const ForeignReading reading("SDF reader", file);
    return module_functions<sdf_module::Functions>().model(file, paths, joints);
}

}  // namespace spawnfield
