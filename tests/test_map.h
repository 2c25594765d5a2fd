#pragma once

#include "random_scene.h"

#include <spawnfield/map.h>
#include <spawnfield/query.h>

#include <memory>

/// A map together with the scene that it was made of.
struct TestMap : spawnfield::Map {
    spawnfield::Scene scene;
};

/// A scene with what queries need, without files.
inline TestMap map_of(spawnfield::Scene scene)
{
    TestMap map;
    map.name = scene.name;
    map.bounds = scene.bounds();
    map.geometry = spawnfield::Geometry(scene);
    map.parts = scene.parts;
    map.labels = scene.count_labels();
    map.layers = 1;
    map.scene = std::move(scene);
    return map;
}

inline TestMap training_map()
{
    return map_of(spawnfield::load_scene(SPAWNFIELD_SOURCE "/maps/training/scene.yaml"));
}

inline spawnfield::Robot husky() { return spawnfield::load_robot(SPAWNFIELD_SOURCE "/maps/robots/husky.yaml"); }

inline spawnfield::CollisionChecker checker_of(const spawnfield::Map& map, const spawnfield::Robot& robot)
{
    return {map.geometry, robot};
}
