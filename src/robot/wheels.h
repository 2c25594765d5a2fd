#pragma once

#include "model/jointed_model.h"

#include <optional>

namespace spawnfield {

/// Returns Robot::drive.wheel_radius of a model, m; no value if it has no wheels.
std::optional<double> wheel_radius_of(const JointedModel& model);

}  // namespace spawnfield
