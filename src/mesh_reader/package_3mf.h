#pragma once

#include <string>
#include <string_view>

namespace spawnfield {

/// Checks a 3MF package before assimp unpacks it. Throws FileError for a package whose files become too large, that
/// does not have the 3D model which it names, whose components contain themselves, refer to objects that do not exist
/// or are nested too deep, and whose objects repeat their triangles too often. Source: 3MF Core Specification 1.3.0,
/// 4.2 (components).
void check_3mf(std::string_view package, const std::string& file);

/// Returns at most the first `most` bytes of the XML of the package's 3D model; "" if it has none.
std::string model_of_3mf(std::string_view package, std::size_t most);

}  // namespace spawnfield
