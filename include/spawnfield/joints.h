#pragma once

#include <string>

namespace spawnfield {

/// The position of a joint.
struct JointPosition {
    std::string joint;
    double value = 0;  ///< rad for revolute and continuous joints, m for prismatic joints
};

}  // namespace spawnfield
