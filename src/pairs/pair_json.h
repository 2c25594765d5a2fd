#pragma once

#include "poses/pose_json.h"

#include <spawnfield/pairs.h>

namespace spawnfield {

/// Adds the limits of the paths of pairs to the settings of a query. Limits that are infinite are left out.
void add_path_limits(Json& settings, const PairOptions& options);

}  // namespace spawnfield
