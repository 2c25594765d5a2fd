#include "model/sdf_module.h"

#include "base/module.h"

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

JointedModel read_sdf_model(const std::filesystem::path& file, ModelPaths& paths,
                            const std::vector<JointPosition>& joints)
{
    return functions().model(file, paths, joints);
}

}  // namespace spawnfield
