#pragma once

#include "random_scene.h"

/// A scene, a robot and heights that are likely to expose errors of a raster that decides for whole cells at once.
///
/// Scenes are 4 to 20 m wide, with up to 160,000 columns, up to a few km from the origin. About half of all faces lie
/// on borders of cells. Many tops and ceilings touch the robot exactly or miss it by 1e-9 .. 1e-4 m, and many things
/// are thinner than a cell: walls of 2 cm, poles of 5 cm, cables, spikes, fences, slivers. Robots have one to four
/// parts.
struct HardCase {
    std::uint64_t seed = 0;
    double resolution = 0.1;  ///< m, 0.02 .. 0.5
    spawnfield::Robot robot;
    double offset = 0.1;    ///< m, mostly 0 .. 1; often the robot just touches a level floor
    double max_height = 1;  ///< m
    double max_slope = std::numeric_limits<double>::infinity();  ///< rad; a test that needs footings sets it
    std::vector<double> yaws;                                    ///< rad; one to six
    spawnfield::Scene scene;        ///< parts are named after what they are: "bridge", "wall", …
    spawnfield::Bounds map_bounds;  ///< empty: those of the scene
};

struct HardOptions {
    bool razor = true;  ///< also use gaps of 1e-9 .. 1e-4 m; without them the rounding of FCL hardly matters
};

HardCase hard_case(std::uint64_t seed, const HardOptions& options = {});

/// Returns the names of the things that scenes of hard cases contain.
std::vector<std::string> hard_features();

/// Return a scene, or a robot about its origin, shifted or mirrored (y becomes -y; faces keep their orientation).
spawnfield::Scene shifted(spawnfield::Scene scene, const spawnfield::Vec3& by);
spawnfield::Scene mirrored(spawnfield::Scene scene);
spawnfield::Robot mirrored(spawnfield::Robot robot);

/// Returns the robot with each part `factor` times as large about its own centre.
spawnfield::Robot enlarged(spawnfield::Robot robot, double factor);

/// Returns the scene with coordinates rounded to multiples of 2^-20 m. So shifts by whole metres up to 8 km are exact.
spawnfield::Scene on_binary_lattice(spawnfield::Scene scene);
