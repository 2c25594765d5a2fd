#pragma once

#include <spawnfield/types.h>

#include <cmath>

namespace spawnfield {

/// Returns the yaw of a rotation, rad: the direction of its x axis, seen from above.
inline double yaw_of(const Mat3& rotation) { return std::atan2(rotation(1, 0), rotation(0, 0)); }

/// Returns the smallest rotation that turns the z axis to `direction`, which must not be zero. For a direction that is
/// straight down (to 1e-12), this is a half turn about the x axis. The numbers are the same as those of Eigen's
/// Quaterniond::FromTwoVectors, but that function instantiates a singular value decomposition, which takes seconds to
/// compile in each file.
Mat3 rotation_from_z_to(const Vec3& direction);

}  // namespace spawnfield
