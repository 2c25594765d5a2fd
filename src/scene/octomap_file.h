#pragma once

#include <octomap/OcTree.h>

#include <filesystem>
#include <memory>

namespace spawnfield {

/// Reads an OctoMap (.bt or .ot) of type OcTree, ColorOcTree (without its colours) or OcTreeStamped. Throws FileError
/// for a file that is missing, of another kind or cut short.
std::unique_ptr<octomap::OcTree> read_octomap(const std::filesystem::path& file);

}  // namespace spawnfield
