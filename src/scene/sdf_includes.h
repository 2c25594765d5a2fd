#pragma once

#include <filesystem>
#include <vector>

namespace spawnfield {

/// Throws FileError, with the way there, if an SDF file includes itself through others: libsdformat would not come back.
/// What is not found is passed over; `folders` are for model:// (model_folders). Each file is read once.
void refuse_cyclic_includes(const std::filesystem::path& file, const std::vector<std::filesystem::path>& folders);

}  // namespace spawnfield
