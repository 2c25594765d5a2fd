#pragma once

#include "random_scene.h"

#include <spawnfield/map.h>
#include <spawnfield/query.h>

#include <memory>

/// A scene with what queries need, without files.
inline spawnfield::Map map_of(spawnfield::Scene scene)
{
    spawnfield::Map map;
    map.name = scene.name;
    map.bounds = scene.bounds();
    map.scene = std::move(scene);
    map.index = spawnfield::build_column_index(map.scene);
    map.layers = 1;
    return map;
}

inline spawnfield::Map training_map()
{
    return map_of(spawnfield::load_scene(SPAWNFIELD_SOURCE "/maps/training/scene.yaml"));
}

inline spawnfield::Robot husky() { return spawnfield::load_robot(SPAWNFIELD_SOURCE "/maps/robots/husky.yaml"); }

inline spawnfield::CollisionChecker checker_of(const spawnfield::Map& map, const spawnfield::Robot& robot)
{
    return {map.scene, map.index, robot};
}
