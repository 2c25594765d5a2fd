#pragma once

#include "common_args.h"

#include <optional>

namespace spawnfield::cli {

/// The units of --yaw, for --help.
inline const std::string yaw_help = "radians, or degrees such as 90deg";

/// Returns --yaw in rad, from "1.57" or "90deg". Prints a notice for radians of more than a turn, which are likely
/// degrees. Throws ArgumentError.
double parse_yaw(const CommonArgs& args, const std::string& text);

/// Returns the same, or nothing for "random".
std::optional<double> parse_yaw_or_random(const CommonArgs& args, const std::string& text);

}  // namespace spawnfield::cli
