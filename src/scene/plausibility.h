#pragma once

#include <spawnfield/scene.h>

namespace spawnfield {

/// How the user can rotate and scale the input, for the text of a notice.
struct Remedies {
    std::string scale;  ///< "--scale", "key scale"
    std::string up;     ///< "--up", "key up"
};

/// Returns notices about a scene that most likely has wrong units (it is more than 20 km or less than half a metre
/// across, or a mesh has an upright face of 1 km height) or lies on its side (most of its faces look along y or x, few
/// up or down). These are guesses; nothing is changed.
std::vector<std::string> doubts_about(const Scene& scene, const std::string& file, const Remedies& remedies);

}  // namespace spawnfield
