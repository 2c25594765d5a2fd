#pragma once

#include <spawnfield/scene.h>

namespace spawnfield {

/// How the user can turn and scale what was read, for the words of a notice.
struct Remedies {
    std::string scale;  ///< "--scale", "key scale"
    std::string up;     ///< "--up", "key up"
};

/// Notices about a scene that is likely read in wrong units (more than 20 km or less than half a metre across, or an
/// upright face of a mesh of 1 km height) or lies on its side (most of its faces look along y or x, few up or down).
/// Guesses: nothing is changed.
std::vector<std::string> doubts_about(const Scene& scene, const std::string& file, const Remedies& remedies);

}  // namespace spawnfield
