#pragma once

#include <spawnfield/geometry.h>

#include <string>
#include <vector>

namespace spawnfield {

/// Returns the face groups, as indices in Geometry::face_groups(), whose node or material matches a shell glob as names
/// of parts do. Groups of removed parts match nothing.
std::vector<std::size_t> face_groups_that_match(const Geometry& geometry, const std::string& glob);

/// Returns the text of an error: a glob matches no part.
std::string no_part_matches(const Geometry& geometry, const std::string& glob);

/// Returns the text of an error: a glob matches no part, node or material.
std::string no_name_matches(const Geometry& geometry, const std::string& glob);

}  // namespace spawnfield
