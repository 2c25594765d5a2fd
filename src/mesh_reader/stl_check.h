#pragma once

#include <string>
#include <string_view>

namespace spawnfield {

/// Checks that an STL file is whole. A binary file must have exactly the facets that it declares; in a text file,
/// endsolid must follow the last facet, because assimp reads all facets before the place where a file was cut. Throws
/// FileError. Source: 3D Systems, StereoLithography Interface Specification, 1989.
void check_stl(std::string_view bytes, const std::string& file);

}  // namespace spawnfield
