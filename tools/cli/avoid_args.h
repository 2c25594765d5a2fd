#pragma once

#include "common_args.h"

#include <spawnfield/query.h>

#include <string>
#include <vector>

namespace spawnfield::cli {

/// Poses that spawns keep a distance from: options of `sample` and `search`.
struct AvoidArgs {
    std::vector<std::string> files;
    std::vector<double> distances;  ///< m; one for all files, or one for each
};
void add_avoid(CLI::App& command, AvoidArgs& args);

/// Reads the files. Without --avoid-distance the distance is `min_distance`, if that is > 0 m. Throws ArgumentError,
/// FileError.
std::vector<AvoidedPoints> read_avoided(const CommonArgs& common, const AvoidArgs& args, double min_distance);

/// Prints a notice for each file whose poses all lie off the map.
void notice_about_avoided(const CommonArgs& common, const Map& map, const std::vector<AvoidedPoints>& avoid);

/// Returns "spawns.csv: 10 poses, 2 m", for reports.
std::string words_of(const AvoidedPoints& group);

}  // namespace spawnfield::cli
