#pragma once

#include <spawnfield/joints.h>
#include <spawnfield/types.h>

#include <map>
#include <optional>
#include <vector>

namespace spawnfield {

/// A joint of a robot file.
struct Joint {
    enum class Motion { None, Turning, Sliding, Other };  ///< Other: not of one number, it stays at zero
    struct Mimic {
        std::string joint;
        double multiplier = 1, offset = 0;
    };

    std::string name;
    std::string type;  ///< as its file tells it, for messages
    Motion motion = Motion::None;
    double lower = -std::numeric_limits<double>::infinity(), upper = -lower;  ///< rad or m
    std::optional<Mimic> mimic;
};

/// Where every joint that can move stands: as given, as those that it mimics, or at 0. What is out of its limits
/// without being given gets a notice. Throws ArgumentError (joints) for given ones that are no joints of the file,
/// fixed, mimics or out of limits, FileError for mimics of nothing or of themselves.
SPAWNFIELD_MODULE_API std::map<std::string, double> joint_positions(const std::string& file,
                                                                    const std::vector<Joint>& joints,
                                                                    const std::vector<JointPosition>& given,
                                                                    std::vector<std::string>& notices);

/// The joint's frame moved along or about its axis (of length 1, in that frame) by value.
SPAWNFIELD_MODULE_API Pose joint_motion(Joint::Motion motion, const Vec3& axis, double value);

}  // namespace spawnfield
