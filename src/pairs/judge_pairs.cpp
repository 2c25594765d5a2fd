#include "base/parallel.h"
#include "pairs/pair_ground.h"
#include "reach/path_search.h"

#include <spawnfield/error.h>
#include <spawnfield/pairs.h>

#include <memory>
#include <utility>

namespace spawnfield {
namespace {

/// Returns the verdict on a pair whose start and goal are judged, and measures its path.
PairVerdict judge_path(JudgedPair& pair, PathSearch::Impl& search, const PairOptions& options)
{
    if (pair.start.verdict != Verdict::Valid) return PairVerdict::StartNotValid;
    if (pair.goal.verdict != Verdict::Valid) return PairVerdict::GoalNotValid;
    const auto start = search.end_of(pair.start), goal = search.end_of(pair.goal);
    if (start) pair.start_island = start->island;
    if (goal) pair.goal_island = goal->island;
    pair.straight = (ground_of(pair.start) - ground_of(pair.goal)).norm();
    if (!start || !goal || start->island != goal->island) return PairVerdict::Unreachable;
    auto length = search.find(*start, *goal, options.max_path * (options.shorten ? longest_graph_path : 1));
    if (length && options.shorten) length = search.path(*start, *goal, true).length;
    if (!length || *length > options.max_path) return PairVerdict::TooLong;
    pair.path_length = length;
    if (*length < options.min_path) return PairVerdict::TooShort;
    return *pair.detour() < options.min_detour ? PairVerdict::TooDirect : PairVerdict::Valid;
}

}  // namespace

const char* to_string(PairVerdict verdict)
{
    switch (verdict) {
    case PairVerdict::StartNotValid: return "start_not_valid";
    case PairVerdict::GoalNotValid: return "goal_not_valid";
    case PairVerdict::Unreachable: return "unreachable";
    case PairVerdict::TooLong: return "too_long";
    case PairVerdict::TooShort: return "too_short";
    case PairVerdict::TooDirect: return "too_direct";
    case PairVerdict::Valid: break;
    }
    return "valid";
}

std::vector<JudgedPair> judge_pairs(const Judge& judge, const ReachGraph& graph, std::span<const Pose> starts,
                                    std::span<const Pose> goals, const PairOptions& options)
{
    if (starts.size() != goals.size())
        throw ArgumentError("judge_pairs", "number of goals", double(goals.size()), "as many as starts");
    const RunOptions run{.threads = options.spawns.threads, .progress = {}};
    std::vector<SettledPose> from = judge.settle(starts, run), to = judge.settle(goals, run);
    PerThread<PathSearch::Impl> searches(
        [shared = std::make_shared<const PathGraph>(graph.impl())] { return PathSearch::Impl(shared); });
    std::vector<JudgedPair> out(starts.size());
    parallel_for(out.size(), options.spawns.threads, options.spawns.progress, [&](std::size_t i) {
        out[i].start = std::move(from[i]);
        out[i].goal = std::move(to[i]);
        out[i].verdict = judge_path(out[i], searches.local(), options);
    });
    return out;
}

}  // namespace spawnfield
