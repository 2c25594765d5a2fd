#pragma once

#include "cli.h"

namespace spawnfield::cli {

/// For --help.
inline const std::string yaw_help = "rad, or degrees as 90deg";

/// --yaw in rad, from "1.57" or "90deg". A notice for radians beyond a turn, which are likely degrees. Throws
/// ArgumentError.
double parse_yaw(const CommonArgs& args, const std::string& text);

/// The same, or nothing for "random".
std::optional<double> parse_yaw_or_random(const CommonArgs& args, const std::string& text);

}  // namespace spawnfield::cli
