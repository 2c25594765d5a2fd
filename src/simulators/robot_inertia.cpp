#include "base/text.h"
#include "model/jointed_model.h"

#include <spawnfield/robot_inertia.h>

#include <Eigen/Eigenvalues>

#include <filesystem>

namespace spawnfield {
namespace {

/// Returns whether a rigid body can have these moments of inertia. MuJoCo refuses others.
bool is_rigid(const Mat3& tensor)
{
    constexpr double smallest = 1e-12;  // kg m2
    if (!tensor.allFinite()) return false;
    const Vec3 moments = Eigen::SelfAdjointEigenSolver<Mat3>(tensor).eigenvalues();  // ascending
    return moments[0] > smallest && moments[0] + moments[1] > moments[2];
}

}  // namespace

std::optional<RobotInertia> robot_inertia(const std::string& robot, const RobotOptions& options)
{
    if (robot.starts_with("box:")) return std::nullopt;
    const std::filesystem::path file = model_file_of(robot);
    const std::string extension = lower_case(file.extension().string());
    if (extension == ".yaml" || extension == ".yml") return std::nullopt;
    ModelPaths paths(options.model_paths, file);
    const JointedModel model = extension == ".urdf" ? read_urdf_model(file, options.joints)
                                                    : read_sdf_model(file, paths, options.joints);
    if (!(model.mass > 0)) return std::nullopt;
    const Vec3 centre = model.mass_moment / model.mass;
    RobotInertia out{model.mass, centre, Mat3::Zero()};
    for (const JointedModel::LinkMass& link : model.masses) {  // Steiner's theorem
        const Vec3 away = link.centre - centre;
        out.tensor += link.inertia + link.mass * (away.squaredNorm() * Mat3::Identity() - away * away.transpose());
    }
    return is_rigid(out.tensor) ? std::optional(out) : std::nullopt;
}

}  // namespace spawnfield
