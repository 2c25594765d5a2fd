#pragma once

#include "experiments.h"

namespace experiments {

/// A picture of the report.
struct Picture {
    std::string file;   ///< name in the folder of pictures
    std::string title;  ///< what the picture shows
};

/// Draws verdicts of the box robot, 0.3 m above the ground, around landmarks of the environments, into a folder. In
/// `bridge_deck`, the version of the complex environment, only the deck of the bridge is terrain.
std::vector<Picture> draw_cases(const Settings& settings, const Districts& districts, const Environment& bridge_deck,
                                const std::filesystem::path& folder);

/// Draws the spawns of the first search of tests 7 and 8 over the whole maps, with the verdicts 1 m above the ground.
std::vector<Picture> draw_spawns(const Settings& settings, const Districts& districts,
                                 const std::filesystem::path& folder);

}  // namespace experiments
