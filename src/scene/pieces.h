#pragma once

#include <spawnfield/scene.h>

#include <string>

namespace spawnfield {

/// Appends a part without geometry and returns its index.
std::uint32_t add_part(Scene& scene, const std::string& name, const std::string& kind, Label label);

/// Appends one piece without thickness. `triangles` are indices into `vertices`, which are in the scene's frame.
void append_sheet(Scene& scene, std::uint32_t part, const std::vector<Vec3>& vertices,
                  const std::vector<Triangle>& triangles, bool sides_up);

}  // namespace spawnfield
