#pragma once

#include <string>
#include <string_view>

namespace spawnfield {

/// Returns whether the text of a file is JSON: it begins with a brace.
bool is_json(std::string_view text);

/// Returns the poses of a file that `sample`, `search` or `check` write with --format json as CSV:
/// x,y,z,roll,pitch,yaw, and name, kind and verdict if they have them. Throws FileError, which names the file, the pose
/// and the key.
std::string csv_of_json(std::string_view text, const std::string& file);

}  // namespace spawnfield
