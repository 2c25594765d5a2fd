#pragma once

#include <string>
#include <string_view>

namespace spawnfield {

/// Whether assimp would read the file as COLLADA: by its ending (with dot, in lower case), or by its root element near
/// the start.
bool is_collada(std::string_view bytes, const std::string& extension);

/// Refuses what assimp reads without looking and would crash, run on for ever, or make nonsense of. Throws FileError
/// with line and element for XML that is none or nested more than 100 deep (tinyxml2's limit); numbers that are none,
/// or too few or too many for what counts them; a <unit> that is no length; nodes that hold themselves by
/// <instance_node>, come to more than a million, or stand more than 500 deep. Sources: Khronos, COLLADA 1.4.1
/// specification; what assimp 5.2 does with files that break it. Returns the text that assimp is to read in place of
/// the file's, empty if that is the file's own. Colours do not matter here, but assimp refuses a file for a space
/// before one: each <color> that is not four plain numbers becomes black.
std::string check_collada(std::string_view bytes, const std::string& file);

}  // namespace spawnfield
