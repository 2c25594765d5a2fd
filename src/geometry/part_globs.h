#pragma once

#include <spawnfield/geometry.h>

#include <string>
#include <vector>

namespace spawnfield {

/// Returns the parts that match a shell glob with their whole name or with one of its words between "::". Removed parts
/// match nothing. Empty if there is none.
std::vector<std::size_t> parts_that_match(const Geometry& geometry, const std::string& glob);

/// Returns the text of an error: a glob matches no part.
std::string no_part_matches(const Geometry& geometry, const std::string& glob);

}  // namespace spawnfield
