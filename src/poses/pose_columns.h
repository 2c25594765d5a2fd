#pragma once

#include <algorithm>
#include <array>
#include <string>

namespace spawnfield {

/// Returns whether a column with this name is part of a pose.
inline bool is_pose_column(const std::string& name)
{
    constexpr std::array names{"x",         "y",       "z",  "roll", "pitch", "yaw", "roll_deg",
                               "pitch_deg", "yaw_deg", "qx", "qy",   "qz",    "qw"};
    return std::find(names.begin(), names.end(), name) != names.end();
}

/// Returns whether `check` writes a column with this name.
inline bool is_verdict_column(const std::string& name)
{
    constexpr std::array names{"verdict", "ground", "height_above", "hit"};
    return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace spawnfield
