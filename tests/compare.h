#pragma once

#include "exact.h"
#include "hard_scene.h"

/// Queries asked twice, with the mask and exhaustively, and what came of it.
namespace compare {

struct Tally {
    std::size_t poses = 0;                               ///< or spawns
    std::size_t asked = 0;                               ///< by the exhaustive way, of the collision checker
    std::size_t exact = 0;                               ///< with the mask
    spawnfield::VerdictCounts verdicts;                  ///< of the exhaustive way
    std::size_t proven_valid = 0, proven_collision = 0;  ///< without an exact check, where each pose tells
    std::size_t differences = 0;
    std::string first;  ///< difference: query, pose, both verdicts

    void add(const Tally& other);
};

/// A judge with the mask, and the same one without it.
struct TwoJudges {
    spawnfield::Judge fast, exhaustive;

    TwoJudges(const spawnfield::Map& map, const spawnfield::Robot& robot, const spawnfield::JudgeOptions& options = {})
        : fast(map, robot, options), exhaustive(without_mask(fast))
    {
    }
};

Tally of_raster(const TwoJudges& judges, const spawnfield::RasterOptions& options);
Tally of_check(const TwoJudges& judges, const std::vector<spawnfield::Pose>& poses);
Tally of_sample(const TwoJudges& judges, const spawnfield::SampleOptions& options);
Tally of_search(const TwoJudges& judges, const spawnfield::SearchOptions& options);

/// All queries of a case, a few hundred poses each.
struct CaseTally {
    Tally raster_2d, raster_3d, collisions, check, sample, search, snap;

    void add(const CaseTally& other);
    Tally sum() const;
};

CaseTally of_case(const HardCase& hard);

/// The exhaustive check beside the tests' own decision (slow.h), which knows no FCL, where that one can tell: with
/// verdicts of that one. Nothing for scenes with meshes filled in spite of their holes, of which it knows nothing.
Tally independently(const HardCase& hard);

TestMap map_of_case(const HardCase& hard);

/// cols x cols columns `step` apart, around something of the scene; with the heights that matter there.
spawnfield::Bounds crop_near(const TestMap& map, Random& random, double step, int cols);

/// Poses at which verdicts change: offset above layers of the crop, some turned, tilted or shifted by a little.
std::vector<spawnfield::Pose> standing_poses(const TestMap& map, const HardCase& hard, const spawnfield::Bounds& crop,
                                             std::size_t count);

std::string described(const spawnfield::Robot& robot);
std::string described(const spawnfield::Pose& pose);

}  // namespace compare
