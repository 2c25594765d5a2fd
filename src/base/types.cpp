#include "base/number.h"
#include "base/rotation.h"

#include <spawnfield/error.h>
#include <spawnfield/types.h>

#include <cmath>
#include <sstream>

namespace spawnfield {

ArgumentError::ArgumentError(const std::string& function, const std::string& message)
    : std::invalid_argument(function + ": " + message), prefix_length_(function.size() + 2)
{
}

ArgumentError::ArgumentError(const std::string& function, const std::string& argument, double value,
                             const std::string& limit)
    : ArgumentError(function, argument + " is " + number(value) + ", needs " + limit)
{
}

Mat3 rotation_from_rpy(double roll, double pitch, double yaw)
{
    return rotation_from_rpy(CosSin(roll), CosSin(pitch), CosSin(yaw));
}

std::string to_string(const Bounds& bounds, int axes)
{
    const auto corner = [&](const Vec3& point) {
        std::ostringstream text;
        text.precision(9);
        for (int axis = 0; axis < axes; ++axis) text << (axis > 0 ? ", " : "") << point[axis];
        return text.str();
    };
    return corner(bounds.min) + " to " + corner(bounds.max) + " m";
}

const char* to_string(Label label)
{
    constexpr std::array names{"terrain", "obstacle", "water", "ignore"};
    return names[static_cast<std::size_t>(label)];
}

const char* to_string(Verdict verdict)
{
    constexpr std::array<const char*, verdict_count> names{"outside",    "aerial",     "off_terrain", "submerged",
                                                           "collision",  "steep",      "unstable",    "valid",
                                                           "obstructed", "unreachable"};
    return names[static_cast<std::size_t>(verdict)];
}

std::string version() { return SPAWNFIELD_VERSION; }

}  // namespace spawnfield
