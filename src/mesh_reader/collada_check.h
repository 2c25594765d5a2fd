#pragma once

#include <string>
#include <string_view>

namespace spawnfield {

/// Returns whether assimp would read the file as COLLADA: because of its extension (with the dot, in lower case) or
/// because of a root element <COLLADA> near its start.
bool is_collada(std::string_view bytes, const std::string& extension);

/// Checks a COLLADA file before assimp reads it, because assimp 5.2 does not check files and would crash, never end or
/// read nonsense. Returns the text that assimp should read instead of the file, or "" if it can read the file itself.
///
/// Throws FileError with line and element for: text that is not XML, or is nested more than 100 deep (tinyxml2's
/// limit); values that are not numbers, and lists of numbers that do not have the declared length; a <unit> that is not
/// a length > 0; nodes that contain themselves through <instance_node>, that are more than a million, or that are
/// nested more than 500 deep. Colours do not matter here, but assimp refuses a file that has a space before one: in the
/// returned text each <color> that assimp cannot read is black. Sources: Khronos, COLLADA 1.4.1 specification; the
/// behaviour of assimp 5.2 for files that break it.
std::string check_collada(std::string_view bytes, const std::string& file);

}  // namespace spawnfield
