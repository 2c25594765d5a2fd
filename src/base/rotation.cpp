#include "base/rotation.h"

#include <Eigen/Geometry>

#include <cmath>

namespace spawnfield {

Mat3 rotation_from_z_to(const Vec3& direction)
{
    const Vec3 target = direction.normalized();
    const double cosine = target.z();
    if (cosine < -1 + Eigen::NumTraits<double>::dummy_precision())
        return Eigen::Quaterniond(0, -1, 0, 0).toRotationMatrix();
    const double twice_w = std::sqrt((1 + cosine) * 2);
    Eigen::Quaterniond turn;
    turn.vec() = Vec3::UnitZ().cross(target) * (1 / twice_w);
    turn.w() = twice_w * 0.5;
    return turn.toRotationMatrix();
}

}  // namespace spawnfield
