#pragma once

#include <spawnfield/types.h>

#include <cmath>

namespace spawnfield {

/// Returns the yaw of a rotation, rad: the direction of its x axis, seen from above.
inline double yaw_of(const Mat3& rotation) { return std::atan2(rotation(1, 0), rotation(0, 0)); }

/// Cosine and sine of an angle.
struct CosSin {
    double cos, sin;

    explicit CosSin(double angle) : cos(std::cos(angle)), sin(std::sin(angle)) {}
};

/// Does the same as rotation_from_rpy, for callers that know some of these angles from the rotation before.
inline Mat3 rotation_from_rpy(const CosSin& roll, const CosSin& pitch, const CosSin& yaw)
{
    const auto& [cr, sr] = roll;
    const auto& [cp, sp] = pitch;
    const auto& [cy, sy] = yaw;
    Mat3 rotation;
    rotation << cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr, sy * cp, sy * sp * sr + cy * cr,
        sy * sp * cr - cy * sr, -sp, cp * sr, cp * cr;
    return rotation;
}

/// Returns the smallest rotation that turns the z axis to `direction`, which must not be zero. For a direction that is
/// straight down (to 1e-12), this is a half turn about the x axis. The numbers are the same as those of Eigen's
/// Quaterniond::FromTwoVectors, but that function instantiates a singular value decomposition, which takes seconds to
/// compile in each file.
Mat3 rotation_from_z_to(const Vec3& direction);

}  // namespace spawnfield
