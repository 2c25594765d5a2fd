#pragma once

#include "temp_folder.h"

#include <spawnfield/scene.h>

/// Writes a scene.yaml with these lines as its `parts` into the folder, and reads it.
inline spawnfield::Scene load_parts(const TempFolder& folder, const std::string& parts,
                                    const spawnfield::SceneOptions& options = {})
{
    return spawnfield::load_scene(
        folder.write("scene.yaml", "format: spawnfield-scene/1\nname: test\nparts:\n" + parts), options);
}
