#pragma once

#include "ground_args.h"

namespace spawnfield::cli {

/// What a command knows when it found fewer spawns than wanted.
struct Shortfall {
    bool is_search = false;  ///< random searches; else samples
    double min_distance = 0;
    bool has_region = false;
    bool is_near_avoided = false;  ///< a draw was too near to an avoided pose
    bool has_place_rules = false;
    VerdictCounts counts = {};  ///< of the positions that were judged
};

/// Returns the changes that may give more spawns, for example "a smaller --min-distance or a wider --region": first
/// those to which the most frequent verdicts point.
std::string spawn_advice(const QueryArgs& args, const GroundArgs& ground, const Shortfall& shortfall);

}  // namespace spawnfield::cli
