#pragma once

#include "experiments.h"

namespace experiments {

/// A picture of the report.
struct Picture {
    std::string file;   ///< within the folder of pictures
    std::string title;  ///< what to see
};

/// Verdicts of the box, 0.3 m above the ground, around the environments' landmarks, into a folder; `bridge_deck` is the
/// version of the complex environment in which the bridge's deck alone is terrain.
std::vector<Picture> draw_cases(const Settings& settings, const Districts& districts, const Environment& bridge_deck,
                                const std::filesystem::path& folder);

/// The spawns of the first search of tests 7 and 8 over the whole maps, with the verdicts 1 m above the ground.
std::vector<Picture> draw_spawns(const Settings& settings, const Districts& districts,
                                 const std::filesystem::path& folder);

}  // namespace experiments
