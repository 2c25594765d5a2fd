#pragma once

#include "common_args.h"

#include <spawnfield/heading_rule.h>

#include <optional>

namespace spawnfield::cli {

/// The units of --yaw, for --help.
inline const std::string yaw_help = "radians, or degrees such as 90deg";
/// The rules of --yaw, for --help.
inline const std::string heading_help =
    "robots at rest: facing:X,Y (towards a point), downhill or uphill, any:K or all:K (valid at one or at each of K "
    "headings), best:K (the one with the largest margin), best:K:clearance (the one farthest from obstacles), or "
    "along or along:K (the one with the longest way straight ahead; K is 16)";

/// What --yaw can be.
struct YawChoice {
    double yaw = 0;  ///< rad; unless it is random or there is a rule
    bool is_random = false;
    std::optional<HeadingRule> rule = {};
};

/// Returns --yaw in rad, from "1.57" or "90deg". Prints a notice for radians of more than a turn, which are likely
/// degrees. Throws ArgumentError.
double parse_yaw(const CommonArgs& args, const std::string& text);

/// Returns the same, "random" if that is allowed, or a rule such as "any:8" if the robots are settled. Throws
/// ArgumentError.
YawChoice parse_yaw_choice(const CommonArgs& args, const std::string& text, bool is_settled, bool allow_random);

}  // namespace spawnfield::cli
