#pragma once

#include "this_build.h"
#include "random_scene.h"

#include <spawnfield/bake.h>
#include <spawnfield/poses.h>
#include <spawnfield/query.h>

#include <memory>

/// A map with the scene from which it was made.
struct TestMap : spawnfield::Map {
    spawnfield::Scene scene;
};

/// Returns a map of the scene, made without files, with a mask of this resolution (m). Poses beyond the bounds (empty:
/// those of the scene) are `outside`, but solids there still collide.
inline TestMap map_of(spawnfield::Scene scene, double resolution = 0.1, const spawnfield::Bounds& bounds = {})
{
    TestMap map;
    map.name = scene.name;
    map.bounds = bounds.is_empty() ? scene.bounds() : bounds;
    map.resolution = resolution;
    map.geometry = spawnfield::Geometry(scene);
    map.solid_bounds = spawnfield::SolidBounds(map.geometry, map.bounds, resolution);
    map.layers = 1;
    map.scene = std::move(scene);
    return map;
}

inline TestMap training_map() { return map_of(spawnfield::load_scene(source_folder() + "/maps/training/scene.yaml")); }

inline spawnfield::Robot husky() { return spawnfield::load_robot(source_folder() + "/maps/robots/husky.yaml"); }

/// The same judge without the mask: every collision is decided by an exact check.
inline spawnfield::Judge without_mask(const spawnfield::Judge& judge)
{
    spawnfield::JudgeOptions options = judge.options();
    options.exhaustive = true;
    return {judge.map(), judge.robot(), options};
}

/// The same judge without the mask and without a limit of height above the ground.
inline spawnfield::Judge at_any_height(const spawnfield::Judge& judge)
{
    spawnfield::JudgeOptions options = judge.options();
    options.exhaustive = true;
    options.max_height = std::numeric_limits<double>::infinity();
    return {judge.map(), judge.robot(), options};
}

/// Returns the verdict that a raster must have at a pose: that of check, but ground above the origin does not count.
inline spawnfield::Verdict verdict_in_raster(const spawnfield::Judge& judge, const spawnfield::Pose& pose)
{
    const spawnfield::Judgement judged = judge.check(pose);
    const bool is_over = judged.ground && judged.ground->height > pose.position.z() + 1e-9;
    return is_over ? spawnfield::Verdict::Aerial : judged.verdict;
}

inline spawnfield::CollisionChecker checker_of(const spawnfield::Map& map, const spawnfield::Robot& robot)
{
    return {map.geometry, robot};
}

/// Returns the file that write_raster_csv() writes.
inline std::string csv_of(const spawnfield::RasterResult& raster, bool aerial = false)
{
    std::string text;
    spawnfield::write_raster_csv(raster, aerial, [&](std::string_view piece) { text += piece; });
    return text;
}
