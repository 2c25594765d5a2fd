#pragma once

#include <string>

namespace spawnfield {

/// Where a joint stands.
struct JointPosition {
    std::string joint;
    double value = 0;  ///< rad of revolute and continuous joints, m of prismatic ones
};

}  // namespace spawnfield
