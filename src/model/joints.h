#pragma once

#include <spawnfield/joints.h>
#include <spawnfield/types.h>

#include <map>
#include <optional>
#include <vector>

namespace spawnfield {

/// A joint in a robot file.
struct Joint {
    enum class Motion { None, Turning, Sliding, Other };  ///< Other: needs more than one number; it stays at zero
    struct Mimic {
        std::string joint;
        double multiplier = 1, offset = 0;
    };

    std::string name;
    std::string type;  ///< as in the file, for messages
    Motion motion = Motion::None;
    double lower = -std::numeric_limits<double>::infinity(), upper = -lower;  ///< limits, rad or m
    std::optional<Mimic> mimic;
};

/// Returns the position of every joint that can move: the given one, the one that follows from the joint it mimics, or
/// 0. Adds a notice for a joint that is out of its limits without being given. Throws ArgumentError for a given joint
/// that is not in the file, is fixed, mimics another or is out of its limits; FileError for a joint that mimics itself
/// or a joint that does not exist.
SPAWNFIELD_MODULE_API std::map<std::string, double> joint_positions(const std::string& file,
                                                                    const std::vector<Joint>& joints,
                                                                    const std::vector<JointPosition>& given,
                                                                    std::vector<std::string>& notices);

/// Returns the motion of a joint by `value` along or about its axis. The axis has length 1 and is in the joint's frame.
SPAWNFIELD_MODULE_API Pose joint_motion(Joint::Motion motion, const Vec3& axis, double value);

}  // namespace spawnfield
