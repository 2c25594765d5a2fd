#pragma once

#include "base/large_list.h"
#include "query/avoid_index.h"
#include "query/draw.h"
#include "query/neighbourhoods.h"
#include "query/pose_judge.h"
#include "query/spaced_points.h"
#include "query/stand_judge.h"

#include <spawnfield/error.h>
#include <spawnfield/query.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <numbers>

namespace spawnfield {

inline Bounds overlap(Bounds box, const Bounds& other)
{
    for (int axis = 0; axis < 3; ++axis) {
        box.min[axis] = std::max(box.min[axis], other.min[axis]);
        box.max[axis] = std::min(box.max[axis], other.max[axis]);
    }
    return box;
}

/// Throws ArgumentError unless the distance and the points are within their limits.
void check_avoided(const char* function, const AvoidedPoints& group);

/// Throws ArgumentError unless count, distances and yaw are within their limits. Here and below, `Options` is
/// SearchOptions or SampleOptions.
template <class Options>
void check_spawn_options(const char* function, const Options& options)
{
    if (options.count < 1) throw ArgumentError(function, "count", double(options.count), ">= 1");
    if (options.count > max_spawns)
        throw ArgumentError(function, "count", double(options.count), "at most " + std::to_string(max_spawns));
    if (!(options.min_distance >= 0) || !std::isfinite(options.min_distance))
        throw ArgumentError(function, "min_distance", options.min_distance, ">= 0 m");
    for (const AvoidedPoints& group : options.avoid) check_avoided(function, group);
    if (!std::isfinite(options.yaw)) throw ArgumentError(function, "yaw", options.yaw, "a finite number, rad");
}

template <class Options>
double draw_yaw(const Options& options, Draw& draw)
{
    return options.random_yaw ? draw.uniform(-std::numbers::pi, std::numbers::pi) : options.yaw;
}

/// The result of one draw. It has a verdict only if it was far enough from the points that were taken before its batch.
struct Candidate {
    bool on_ground = false;         ///< the draw gave a pose; only set by sample()
    bool on_double_ground = false;  ///< as counted in SpawnList; only set by sample()
    bool off_area = false;
    bool off_rules = false;      ///< does not comply with place rules; only set by sample()
    bool not_preferred = false;  ///< only set by sample()
    bool near_avoided = false;
    bool clear = false;
    Verdict verdict = Verdict::Outside;
    std::uint32_t exact_checks = 0;
    Spawn spawn;
    SpawnRest rest;  ///< of a settled robot

    void set(const Judgement& judgement)
    {
        verdict = judgement.verdict;
        exact_checks = judgement.exact_check;
    }
};

/// Lets the robot of a draw down at a place, at the spawn's yaw or at that of the options' rule. Sets the spawn, which
/// stays at the place if the robot cannot be let down, and the verdict. `column` must be the column at the place.
template <class Options>
void let_down(StandJudge& judge, const ColumnView& column, const Vec3& place, double lift, const Options& options,
              Draw& draw, Candidate& out)
{
    StandJudge::Choice choice;
    if (options.heading) {
        choice = judge.judge(column, place, *options.heading, draw.unit());
    } else {
        choice.pose = judge.judge(column, place, out.spawn.yaw);
        choice.exact_checks = choice.pose.exact_check;
    }
    const SettledPose& pose = choice.pose;
    out.spawn = {pose.has_pose ? pose.lifted(lift).position : place, pose.yaw, pose.roll, pose.pitch};
    out.rest = {pose.tilt, pose.margin, choice.free_length};
    out.verdict = pose.verdict;
    out.off_rules = pose.off_rules;
    out.exact_checks = std::uint32_t(choice.exact_checks);
}

/// Returns a list without spawns, with the options that say how its spawns are placed.
template <class Options>
SpawnList empty_list(const Options& options)
{
    SpawnList out;
    out.stance = options.stance;
    out.heading = options.heading;
    return out;
}

/// Appends the spawn of a candidate.
inline void add_spawn(const Candidate& candidate, SpawnList& out)
{
    out.spawns.push_back(candidate.spawn);
    if (out.stance == Stance::Settled) out.rests.push_back(candidate.rest);
}

/// Positions from which later draws must keep a distance. Draws are examined in batches: first, several threads compare
/// them with before(). Then is_still_clear() compares them, one after the other, with the positions that were taken
/// since the batch began.
class TakenPoints {
public:
    explicit TakenPoints(double distance) : before_(distance), since_(distance) {}

    const SpacedPoints& before() const { return before_; }
    bool is_still_clear(const Vec3& point) const { return since_.is_clear(point); }
    void add(const Vec3& point)
    {
        if (!(before_.distance() > 0)) return;  // all points are clear
        since_.add(point);
        news_.push_back(point);
    }
    /// Must be called between batches.
    void settle()
    {
        for (const Vec3& point : news_) before_.add(point);
        news_.clear();
        since_.clear();
    }

private:
    SpacedPoints before_, since_;
    std::vector<Vec3> news_;
};

/// Sets whether a candidate is far enough from avoided points and from the positions of earlier batches, and returns
/// it.
inline bool is_clear(Candidate& out, const AvoidIndex& avoided, const TakenPoints& taken)
{
    out.near_avoided = !avoided.is_clear(out.spawn.position);
    out.clear = !out.near_avoided && taken.before().is_clear(out.spawn.position);
    return out.clear;
}

/// Returns a progress function that reports the number of spawns found, as a share of the wanted ones.
template <class Options>
Progress share_found(const Options& options, const SpawnList& found)
{
    if (!options.progress) return {};
    return [&](double) { options.progress(double(found.spawns.size()) / double(options.count)); };
}

template <class Options>
bool is_stopped(const Options& options)
{
    return options.stop && options.stop();
}

// Neighbours are judged one after the other within blocks of so many draws. In larger blocks, they are nearer to each
// other; in smaller ones, less is lost when the work is stopped: about so much time.
inline constexpr std::size_t smallest_block = 1 << 11, largest_block = 1 << 18;
inline constexpr double block_time = 0.5;  // s

/// Returns the number of draws in a block if one of them takes so many seconds.
inline std::size_t block_for(double time)
{
    return std::bit_floor(std::size_t(std::clamp(block_time / time, double(smallest_block), double(largest_block))));
}

/// Returns the indices of places block by block, each block in neighbourhoods.
inline std::vector<std::uint32_t> in_blocks_of_neighbours(std::span<const Vec2> places, std::size_t block)
{
    std::vector<std::uint32_t> out;
    out.reserve(places.size());
    for (std::size_t begin = 0; begin < places.size(); begin += block)
        for (const std::uint32_t i : in_neighbourhoods(places.subspan(begin, std::min(block, places.size() - begin))))
            out.push_back(std::uint32_t(begin) + i);
    return out;
}

/// What one thread needs for the draws of a batch.
struct DrawThread {
    PoseJudge judge;
    Columns columns;            ///< of a chunk of draws
    std::vector<Vec2> places;   ///< of these draws, m
    std::vector<Draw> started;  ///< these draws, after their places

    DrawThread(const Judge::Impl& shared, double yaw) : judge(shared, yaw) { judge.leave_layered_cells(); }
};

/// Returns for each index its place in `order`.
inline std::vector<std::uint32_t> inverse_of(std::span<const std::uint32_t> order)
{
    std::vector<std::uint32_t> out(order.size());
    for (std::size_t k = 0; k < order.size(); ++k) out[order[k]] = std::uint32_t(k);
    return out;
}

/// Makes draws first, first + 1, … in batches: place(draw) draws x and y, m. Several threads call
/// look(draw, place, judge, column, candidate), which goes on with the draw and sets an empty Candidate, for neighbours
/// one after the other. If `wants_columns`, `column` is the column at the place, which takes less time to find for
/// several neighbours at once, else nullptr. Then take(candidate) is called for one draw after the other, in their
/// order, until it returns false. batch_size(draws) returns the size of the next batch after so many draws; it changes
/// nothing but the exact checks. Ends early if the options' `stop` returns true: then, fewer than a block of judged
/// draws are not taken. Returns the number of the next draw.
template <class Options, class BatchSize, class Place, class Look, class Take>
std::uint64_t draw_in_order(std::uint64_t first, const Judge::Impl& shared, const Options& options,
                            const SpawnList& found, TakenPoints& taken, bool wants_columns, const BatchSize& batch_size,
                            const Place& place, const Look& look, const Take& take)
{
    constexpr std::size_t chunk = 64;
    static_assert(smallest_block % chunk == 0);
    std::size_t block = smallest_block;  // until it is known how long a draw takes
    std::vector<Candidate> batch;        // neighbour by neighbour
    std::vector<Vec2> places;
    for (std::uint64_t next = first;;) {
        taken.settle();
        const std::size_t size = batch_size(next - first);
        places.resize(size);
        for (std::size_t i = 0; i < size; ++i) {
            Draw draw(options.seed, next + i);
            places[i] = place(draw);
        }
        const std::vector<std::uint32_t> order = in_blocks_of_neighbours(places, block);
        if (batch.size() < size) {
            batch.clear();
            reserve_large(batch, size);
            batch.resize(size);
        }
        const Progress progress = share_found(options, found);
        const bool is_sparse = shared.is_sparse(next + size);
        const double shared_search = 4 * shared.map.geometry.impl().tile_side();  // m; few tiles for a chunk of draws
        shared.expect(next + size);
        const auto stop = [&] { return is_stopped(options); };
        PerThread<DrawThread> threads([&] { return DrawThread(shared, options.yaw); });
        const std::size_t chunks = (size + chunk - 1) / chunk;
        const auto begun = std::chrono::steady_clock::now();
        const std::size_t done = parallel_until(chunks, options.threads, progress, stop, [&](std::size_t c) {
            DrawThread& thread = threads.local();
            if (is_sparse) thread.judge.use_coarse_cells();
            const std::size_t begin = c * chunk;
            const std::span<const std::uint32_t> draws = std::span(order).subspan(begin, std::min(size - begin, chunk));
            thread.places.clear();
            thread.started.clear();
            for (const std::uint32_t i : draws) {  // again, because places[i] are far apart in memory
                Draw& draw = thread.started.emplace_back(options.seed, next + i);
                thread.places.push_back(place(draw));
            }
            if (const Rect around = rect_around(thread.places); around.longest_side() < shared_search)
                thread.judge.expect(around);
            if (wants_columns) thread.columns.set(shared.map.geometry, thread.places);
            for (std::size_t k = 0; k < draws.size(); ++k) {
                const ColumnView column = wants_columns ? thread.columns.at(int(k), 0) : ColumnView();
                Candidate& candidate = batch[begin + k] = {};
                look(thread.started[k], thread.places[k], thread.judge, wants_columns ? &column : nullptr, candidate);
            }
        });
        const bool is_late = done < chunks;
        const std::size_t taken_draws = is_late ? done * chunk / block * block : size;  // only whole blocks
        const std::vector<std::uint32_t> number = inverse_of(order);
        for (std::size_t i = 0; i < taken_draws; ++i) {
            constexpr std::size_t ahead = 16;  // the candidates of successive draws are far apart in memory
            if (i + ahead < taken_draws) {
                const Candidate& later = batch[number[i + ahead]];
                __builtin_prefetch(&later);
                __builtin_prefetch(&later.rest);  // may begin the next cache line
            }
            ++next;
            if (!take(batch[number[i]])) return next;
        }
        if (is_late) return next;
        block = block_for(std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count() /
                          double(size));
    }
}

/// Returns the size of the next batch: about as many draws as the missing spawns will need if the share of successful
/// draws stays the same, but at most twice the draws so far, and within fixed limits. In a larger batch, neighbours are
/// nearer to each other. But with a distance between spawns, draws that are too near to others of their batch are
/// judged in vain.
inline std::size_t batch_for(std::size_t wanted, double min_distance, std::size_t found, std::uint64_t draws)
{
    constexpr double smallest = 256, largest = 1 << 17, largest_without_distance = largest_block;
    const double share = (double(found) + 1) / (double(draws) + 1);
    return std::size_t(std::clamp(std::min(double(wanted - found) / share, 2 * double(draws)), smallest,
                                  min_distance > 0 ? largest : largest_without_distance));
}

}  // namespace spawnfield
