#pragma once

#include "settle/descent.h"

#include <optional>
#include <vector>

namespace spawnfield {

/// How the robot rests on a horizontal plane at z = 0. It depends only on the yaw.
struct Settler::FlatRest {
    double yaw;
    Rest rest;
    std::vector<Bounds> parts;  ///< of the robot at rest, m
};

struct Settler::Workspace::Kept {
    std::optional<Descent> descent = {};
    std::vector<FlatRest> flats = {};
    std::optional<NearSolids> near = {};
};

}  // namespace spawnfield
