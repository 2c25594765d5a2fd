#include "settle/underside.h"

#include <algorithm>
#include <limits>

namespace spawnfield {

std::optional<double> underside_of(std::span<const PlacedBody> bodies)
{
    std::optional<double> out;
    for (const PlacedBody& body : bodies)
        if (const auto end = lower_end(body, 0, 0)) out = std::min(out.value_or(*end), *end);
    return out;
}

Underside::Underside(const Robot& robot) : rotation_(Mat3::Constant(std::numeric_limits<double>::quiet_NaN()))
{
    for (const RobotPart& part : robot.parts) {
        parts_.push_back(convex_of(part));
        placed_.push_back({.body = parts_.back()});
    }
}

double Underside::above_origin(const Mat3& rotation)
{
    if (rotation == rotation_) return above_;
    for (std::size_t p = 0; p < parts_.size(); ++p) place(placed_[p], parts_[p], rotation);
    rotation_ = rotation;
    above_ = std::max(0.0, underside_of(placed_).value_or(0));
    return above_;
}

}  // namespace spawnfield
