#pragma once

#include "random_scene.h"

/// A scene, a robot and heights made to trip a raster that decides for whole cells at once.
///
/// Scenes 4 to 20 m wide, up to 160,000 columns, up to a few km from the origin. About half of all faces lie on borders
/// of cells, many tops and ceilings touch the robot exactly or miss it by 1e-9 .. 1e-4 m, and much is thinner than a
/// cell: walls of 2 cm, poles of 5 cm, cables, spikes, fences, slivers. Robots of one to four parts.
struct HardCase {
    std::uint64_t seed = 0;
    double resolution = 0.1;  ///< m, 0.02 .. 0.5
    spawnfield::Robot robot;
    double offset = 0.1;    ///< m, mostly 0 .. 1; often so that the robot just touches a level floor
    double max_height = 1;  ///< m
    double max_slope = std::numeric_limits<double>::infinity();  ///< rad; to be set by who wants footings
    std::vector<double> yaws;                                    ///< rad; one to six
    spawnfield::Scene scene;        ///< its parts are named after what they make: "bridge", "wall", …
    spawnfield::Bounds map_bounds;  ///< empty: the scene's
};

struct HardOptions {
    bool razor = true;  ///< gaps of 1e-9 .. 1e-4 m too; without them FCL's rounding decides next to nothing
};

HardCase hard_case(std::uint64_t seed, const HardOptions& options = {});

/// What scenes of hard cases are made of: names of their parts.
std::vector<std::string> hard_features();

/// All of a scene, and of a robot about its origin, moved or mirrored (y to -y, with the winding of faces).
spawnfield::Scene shifted(spawnfield::Scene scene, const spawnfield::Vec3& by);
spawnfield::Scene mirrored(spawnfield::Scene scene);
spawnfield::Robot mirrored(spawnfield::Robot robot);

/// The robot with each of its parts `factor` times as large about the part's own centre.
spawnfield::Robot enlarged(spawnfield::Robot robot, double factor);

/// Coordinates rounded to multiples of 2^-20 m, so that shifts by whole metres up to 8 km change no digit.
spawnfield::Scene on_binary_lattice(spawnfield::Scene scene);
