#pragma once

#include "query_args.h"

#include <spawnfield/place_quantities.h>
#include <spawnfield/place_rules.h>

#include <string>
#include <utility>
#include <vector>

namespace spawnfield::cli {

/// Options about what a place must comply with, and how good it is.
struct PlaceArgs {
    double clearance = 0;  ///< m
    std::vector<std::string> on, not_on, in_view_of, hidden_from;
    std::vector<std::pair<std::string, std::string>> near, distance_to;  ///< glob or point, and range
    std::string facing, columns, prefer;
    double sensor_height = 0, view_range = 10, room_range = 3;  ///< m
};

// They add options below the heading "Places":
void add_place_rules(CLI::App& command, PlaceArgs& args);        ///< those of PlaceRules
void add_quantity_settings(CLI::App& command, PlaceArgs& args);  ///< --sensor-height, --view-range and --room-range
void add_measures(CLI::App& command, PlaceArgs& args);           ///< --columns and --prefer
inline const std::vector<std::string> quantity_setting_names{"--sensor-height", "--view-range", "--room-range"};

/// Reads the options. Throws ArgumentError for values that cannot be read, and for --facing together with --yaw.
PlaceRules place_rules(const PlaceArgs& args, const CLI::App& command);

/// Reads the options of add_quantity_settings() and add_measures(), all but PlaceMeasures::room. Throws ArgumentError
/// for values that cannot be read, and for options without effect.
PlaceMeasures place_measures(const PlaceArgs& args, const CLI::App& command);
/// The same without add_measures(): `option` has the names of the columns, with commas between them.
PlaceMeasures place_measures(const PlaceArgs& args, const CLI::App& command, const std::string& option,
                             const std::string& quantities);

/// Returns "clearance=1, margin=0.5"; empty without preferences.
std::string words_of(const PlaceMeasures& measures);

/// Prints a notice if the map has no obstacles, so that `option` has no effect.
void notice_if_no_obstacles(const CommonArgs& common, const std::string& option, const Map& map);

/// Throws ArgumentError for a glob that matches no part of the map. Prints notices about rules without effect.
void check_places(const CommonArgs& common, const PlaceRules& rules, const Map& map);

}  // namespace spawnfield::cli
