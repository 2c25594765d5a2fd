#include "base/parallel.h"
#include "query/draw.h"
#include "reach/path_search.h"

#include <spawnfield/error.h>
#include <spawnfield/pairs.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <utility>

namespace spawnfield {
namespace {

constexpr int most_rounds = 10;
constexpr std::size_t fewest_goals = 1000;  // drawn in a round
constexpr int most_searches = 100;          // of paths from a start

using Search = PathSearch::Impl;

/// A drawn pose, and how it is joined with the graph.
struct Drawn {
    SettledPose pose;
    std::optional<Search::End> end;  ///< nothing: it is on no island
};

void check_pair_options(const PairOptions& options)
{
    constexpr const char* function = "sample_pairs";
    if (options.spawns.stance != Stance::Settled)
        throw ArgumentError(function, "the stance must be Settled, because paths lead between settled poses");
    if (options.spawns.min_distance != 0)
        throw ArgumentError(function, "min_distance", options.spawns.min_distance, "0 m: pairs have no distance");
    if (!(options.min_path >= 0) || !std::isfinite(options.min_path))
        throw ArgumentError(function, "min_path", options.min_path, ">= 0 m");
    if (!(options.max_path >= options.min_path))
        throw ArgumentError(function, "max_path", options.max_path, ">= min_path");
    if (!(options.min_detour >= 1) || !std::isfinite(options.min_detour))
        throw ArgumentError(function, "min_detour", options.min_detour, ">= 1");
}

/// Draws the pairs of a list, round by round.
class PairSampler {
public:
    PairSampler(const Judge& judge, const ReachGraph& graph, const PairOptions& options)
        : judge_(judge), options_(options),
          searches_([graph = std::make_shared<const PathGraph>(graph.impl())] { return Search(graph); })
    {
    }

    PairList run()
    {
        PairList out;
        for (int round = 0; round < most_rounds && out.pairs.size() < options_.spawns.count; ++round) {
            const std::size_t missing = options_.spawns.count - out.pairs.size();
            share_ = double(out.pairs.size()) / double(options_.spawns.count);
            const std::vector<Drawn> starts = draw(missing, std::uint64_t(2 * round));
            const std::vector<Drawn> goals = draw(std::max(missing, fewest_goals), std::uint64_t(2 * round + 1));
            if (starts.empty() || goals.empty() || is_stopped()) break;
            join(starts, goals, round, out);
        }
        out.is_stopped = out.pairs.size() < options_.spawns.count && is_stopped();
        return out;
    }

private:
    bool is_stopped() const { return options_.spawns.stop && options_.spawns.stop(); }

    /// Returns poses from sample(), with seeds that differ between the lists.
    std::vector<Drawn> draw(std::size_t count, std::uint64_t list)
    {
        SampleOptions options = options_.spawns;
        options.count = count;
        options.seed = std::uint64_t(Draw(options_.spawns.seed, list).unit() * 0x1p53);
        if (options.progress) options.progress = [&](double) { options_.spawns.progress(share_); };
        const std::vector<Spawn> spawns = sample(judge_, options).spawns;
        std::vector<Drawn> out(spawns.size());
        const auto stop = [&] { return is_stopped(); };  // then, the poses are not used
        parallel_until(spawns.size(), options.threads, {}, stop, [&](std::size_t i) { out[i] = settle(spawns[i]); });
        return out;
    }

    /// Returns the settled pose of a spawn. It is on no island if it is not certain to be the same.
    Drawn settle(const Spawn& spawn)
    {
        const Vec3 lift = judge_.options().stand.lift * Vec3::UnitZ(),
                   above_ground = std::max(0.0, judge_.robot().bounds().min.z()) * Vec3::UnitZ();
        Drawn out{.pose = judge_.settle(spawn.position + above_ground, spawn.yaw), .end = {}};
        constexpr double rounding = 1e-9;  // m
        if ((out.pose.position + lift - spawn.position).norm() <= rounding)
            out.end = searches_.local().end_of(out.pose);
        return out;
    }

    /// Appends a pair for each start that has a goal, until the work is stopped.
    void join(const std::vector<Drawn>& starts, const std::vector<Drawn>& goals, int round, PairList& out)
    {
        std::vector<std::optional<StartGoal>> found(starts.size());
        std::atomic<std::uint64_t> searches{0};
        const auto progress = [&](double share) {
            if (options_.spawns.progress)
                options_.spawns.progress((double(out.pairs.size()) + share * double(starts.size())) /
                                         double(options_.spawns.count));
        };
        const auto stop = [&] { return is_stopped(); };
        const auto find = [&](std::size_t i) {
            Draw random(options_.spawns.seed, std::uint64_t(2 * most_rounds + round));
            const std::size_t begin = (i + std::size_t(random.unit() * double(goals.size()))) % goals.size();
            int made = 0;
            for (std::size_t k = 0; k < goals.size() && !found[i] && made < most_searches; ++k)
                found[i] = pair_of(starts[i], goals[(begin + k) % goals.size()], made);
            searches += std::uint64_t(made);
        };
        found.resize(parallel_until(starts.size(), options_.spawns.threads, progress, stop, find));
        out.starts += found.size();
        out.searches += searches;
        for (std::optional<StartGoal>& pair : found) {
            out.without_goal += !pair;
            if (pair) out.pairs.push_back(std::move(*pair));
        }
    }

    /// Returns a pair if it fits. Adds 1 to `made` if a path had to be searched.
    std::optional<StartGoal> pair_of(const Drawn& start, const Drawn& goal, int& made)
    {
        if (!start.end || !goal.end || start.end->island != goal.end->island) return std::nullopt;
        StartGoal out{.straight = (start.end->stop.ground - goal.end->stop.ground).norm(), .island = start.end->island};
        if (out.straight > options_.max_path) return std::nullopt;
        ++made;
        Search& search = searches_.local();
        const auto found = search.find(*start.end, *goal.end,
                                       options_.max_path * (options_.shorten ? longest_graph_path : 1));
        const auto fits = [&](double length) {
            out.path_length = length;
            return length >= options_.min_path && out.detour() >= options_.min_detour;
        };
        if (!found || !fits(*found)) return std::nullopt;
        ShortPath path;
        if (options_.shorten || options_.keep_paths) path = search.path(*start.end, *goal.end, options_.shorten);
        if (options_.shorten && (path.length > options_.max_path || !fits(path.length))) return std::nullopt;
        out.start = start.pose;
        out.goal = goal.pose;
        if (options_.keep_paths) out.path = search.poses(path, start.pose, goal.pose);
        return out;
    }

    const Judge& judge_;
    const PairOptions& options_;
    PerThread<Search> searches_;
    double share_ = 0;  ///< of the pairs that were found in earlier rounds
};

}  // namespace

PairList sample_pairs(const Judge& judge, const ReachGraph& graph, const PairOptions& options)
{
    check_pair_options(options);
    return PairSampler(judge, graph, options).run();
}

}  // namespace spawnfield
