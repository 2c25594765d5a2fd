#pragma once

#include "query_args.h"

#include <spawnfield/place_quantities.h>
#include <spawnfield/place_rules.h>

#include <string>
#include <utility>
#include <vector>

namespace spawnfield::cli {

/// Options about what a place must comply with, for `sample`.
struct PlaceArgs {
    double clearance = 0;  ///< m
    std::vector<std::string> on, not_on, in_view_of, hidden_from;
    std::vector<std::pair<std::string, std::string>> near, distance_to;  ///< glob or point, and range
    std::string facing, columns, prefer;
    double sensor_height = 0, view_range = 10;  ///< m
};

void add_places(CLI::App& command, PlaceArgs& args);

/// Reads the options. Throws ArgumentError for values that cannot be read, and for --facing together with --yaw.
PlaceRules place_rules(const PlaceArgs& args, const CLI::App& command);

/// Reads the options about quantities. Throws ArgumentError for values that cannot be read, and for options without
/// effect.
PlaceMeasures place_measures(const PlaceArgs& args, const CLI::App& command);

/// Returns "clearance=1, margin=0.5"; empty without preferences.
std::string words_of(const PlaceMeasures& measures);

/// Throws ArgumentError for a glob that matches no part of the map. Prints notices about rules without effect.
void check_places(const CommonArgs& common, const PlaceRules& rules, const Map& map);

}  // namespace spawnfield::cli
