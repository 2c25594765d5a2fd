#pragma once

#include <spawnfield/path.h>
#include <spawnfield/query.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

namespace spawnfield {

struct PairOptions {
    /// How starts and goals are drawn; `count` is the number of pairs. The stance must be Settled, and min_distance 0.
    /// `stop`: see PairList::is_stopped.
    SampleOptions spawns = {};
    double min_path = 0;                                        ///< m, >= 0; shortest path from start to goal
    double max_path = std::numeric_limits<double>::infinity();  ///< m, >= min_path
    double min_detour = 1;                                      ///< >= 1; limit of StartGoal::detour()
    /// Whether paths are those of PathSearch. Otherwise, they are shortest paths of the graph: up to 2 % longer in
    /// the open, in about a tenth of the time.
    bool shorten = true;
    bool keep_paths = false;  ///< whether StartGoal::path is filled
};

/// Returns how many times a path is as long as the straight line between its ends, >= 1.
inline double detour_of(double path_length, double straight)
{
    return straight > 0 ? std::max(1.0, path_length / straight) : 1;
}

/// A start and a goal, both valid settled poses (not raised) on one island.
struct StartGoal {
    SettledPose start = {}, goal = {};
    double path_length = 0;              ///< m; see PathSearch and PairOptions::shorten
    double straight = 0;                 ///< m, between the ground at the start and at the goal
    std::size_t island = 0;              ///< index in ReachGraph::islands()
    std::vector<SettledPose> path = {};  ///< Path::poses, if they were wanted

    double detour() const { return detour_of(path_length, straight); }
};

struct PairList {
    std::vector<StartGoal> pairs;
    std::uint64_t starts = 0;        ///< number of starts that were drawn
    std::uint64_t without_goal = 0;  ///< of these, those for which no goal was found
    std::uint64_t searches = 0;      ///< number of paths that were searched
    /// There are fewer pairs because `stop` returned true. They are the first ones of the whole list.
    bool is_stopped = false;
};

/// Returns pairs of a start and a goal. Starts are drawn by sample(). Goals are drawn by sample(), too, until the path
/// to one of them has a length of min_path to max_path, and a detour of at least min_detour. So the goal is uniform by
/// area among those that fit. A start for which no goal is found among 100 paths and one list of goals is replaced by
/// another one; thus, starts with few goals are rarer. The result has fewer than `count` pairs if some are missing
/// after ten rounds.
///
/// The result is the same for any number of threads. The judge must be that of the graph. Throws ArgumentError for
/// options beyond their limits and for a graph that does not keep its ways, FileError for a damaged map.
SPAWNFIELD_API PairList sample_pairs(const Judge& judge, const ReachGraph& graph, const PairOptions& options);

/// What judge_pairs() says about a pair; the first one that applies.
enum class PairVerdict : std::uint8_t {
    StartNotValid,  ///< the start is not a valid settled pose
    GoalNotValid,
    Unreachable,  ///< they are not on the same island
    TooLong,      ///< the path is longer than PairOptions::max_path
    TooShort,     ///< it is shorter than PairOptions::min_path
    TooDirect,    ///< its detour is below PairOptions::min_detour
    Valid
};
SPAWNFIELD_API const char* to_string(PairVerdict verdict);  ///< "start_not_valid", …, "valid"

struct JudgedPair {
    PairVerdict verdict = PairVerdict::Valid;
    SettledPose start = {}, goal = {};                               ///< not raised
    std::optional<std::size_t> start_island = {}, goal_island = {};  ///< indices in ReachGraph::islands()
    std::optional<double> path_length = {};  ///< m; none: there is no path, or it is longer than max_path
    std::optional<double> straight = {};     ///< m, between the ground at the start and at the goal, if both are valid

    std::optional<double> detour() const
    {
        return path_length && straight ? std::optional(detour_of(*path_length, *straight)) : std::nullopt;
    }
};

/// Lets the robot down at each start and each goal, and judges the pairs. Of the options, min_path, max_path,
/// min_detour, shorten, and the threads and the progress of `spawns` are used. The result is the same for any number of
/// threads. The judge must be that of the graph. Throws ArgumentError if there are not as many goals as starts, or if
/// the graph does not keep its ways, FileError for a damaged map.
SPAWNFIELD_API std::vector<JudgedPair> judge_pairs(const Judge& judge, const ReachGraph& graph,
                                                   std::span<const Pose> starts, std::span<const Pose> goals,
                                                   const PairOptions& options);

}  // namespace spawnfield
