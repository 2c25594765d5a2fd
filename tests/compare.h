#pragma once

#include "exact.h"
#include "hard_scene.h"
#include "this_build.h"

/// Functions that ask queries twice, with the mask and exhaustively, and compare the answers.
namespace compare {

struct Tally {
    std::size_t poses = 0;               ///< or spawns
    std::size_t asked = 0;               ///< exact checks of the exhaustive run
    std::size_t exact = 0;               ///< exact checks of the run with the mask
    spawnfield::VerdictCounts verdicts;  ///< of the exhaustive run
    /// Poses that the mask proved, without an exact check; only of_check counts them.
    std::size_t proven_valid = 0, proven_collision = 0;
    std::size_t differences = 0;
    std::string first;  ///< the first difference: query, pose, both verdicts

    void add(const Tally& other);
};

/// Number of random scenes; in a slow build, all would take many minutes.
inline std::uint64_t scene_count() { return is_slow_build() ? 40 : 300; }

/// Counts are checked only over all scenes together. Then every kind of answer must have occurred.
inline bool all_scenes() { return !is_slow_build(); }

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

/// The results of all queries of a case, with a few hundred poses each.
struct CaseTally {
    Tally raster_2d, raster_3d, collisions, check, sample, search, snap;

    void add(const CaseTally& other);
    Tally sum() const;
};

CaseTally of_case(const HardCase& hard);

/// Compares the exhaustive check with the independent decision of the tests (slow.h), which does not use FCL, at the
/// poses where that one is certain; counts the verdicts of that one. Returns an empty tally for scenes that have filled
/// meshes with holes, which slow.h does not support.
Tally independently(const HardCase& hard);

TestMap map_of_case(const HardCase& hard);

/// Returns bounds of cols x cols columns, `step` apart, near something in the scene, with all heights of the map.
spawnfield::Bounds crop_near(const TestMap& map, Random& random, double step, int cols);

/// Returns poses at which verdicts change: at the offset above layers of the crop, some of them rotated, tilted or
/// shifted a little.
std::vector<spawnfield::Pose> standing_poses(const TestMap& map, const HardCase& hard, const spawnfield::Bounds& crop,
                                             std::size_t count);

std::string described(const spawnfield::Robot& robot);
std::string described(const spawnfield::Pose& pose);

}  // namespace compare
