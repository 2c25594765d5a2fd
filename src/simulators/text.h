#pragma once

#include <spawnfield/simulators.h>

#include <string>
#include <string_view>

namespace spawnfield {

/// Returns the shortest text without an exponent that reads back as the same double. roslaunch's spawn_model would read
/// -1e-05 as an option.
std::string plain_number(double value);

/// Returns a word, quoted if needed, for shlex and for a POSIX shell.
std::string shell_quoted(std::string_view word);

/// Returns a text as a Python string literal.
std::string python_quoted(std::string_view text);

/// Returns a pose as "x y z roll pitch yaw" in m and rad.
std::string spaced(const RobotStart& robot);

/// Returns a text like "10 robots by spawnfield 0.2.0".
std::string made_by(std::size_t robots);

}  // namespace spawnfield
