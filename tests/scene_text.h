#pragma once

#include "temp_folder.h"

#include <spawnfield/scene.h>

/// Reads a scene.yaml whose `parts` are these lines, written into the folder.
inline spawnfield::Scene load_parts(const TempFolder& folder, const std::string& parts,
                                    const spawnfield::SceneOptions& options = {})
{
    return spawnfield::load_scene(
        folder.write("scene.yaml", "format: spawnfield-scene/1\nname: test\nparts:\n" + parts), options);
}
