#pragma once

#include <spawnfield/simulators.h>

#include <string>
#include <string_view>

namespace spawnfield {

/// The shortest text without an exponent that reads back to the same double. (roslaunch's spawn_model takes -1e-05 for
/// an option.)
std::string plain_number(double value);

std::string xml_escaped(std::string_view text);

/// One word for shlex and for a POSIX shell.
std::string shell_quoted(std::string_view word);

/// A literal.
std::string python_quoted(std::string_view text);

/// "x y z r p y" in m and rad.
std::string spaced(const RobotStart& robot);

/// "10 robots by spawnfield 0.2.0".
std::string made_by(std::size_t robots);

}  // namespace spawnfield
