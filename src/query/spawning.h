#pragma once

#include "base/parallel.h"
#include "query/draw.h"
#include "query/spaced_points.h"

#include <spawnfield/query.h>

#include <algorithm>
#include <numbers>

namespace spawnfield {

/// Throws ArgumentError unless count, distances and bounds are in their limits.
void check_spawn_options(const char* function, const SpawnOptions& options);

inline double draw_yaw(const SpawnOptions& options, Draw& draw)
{
    return options.random_yaw ? draw.uniform(-std::numbers::pi, std::numbers::pi) : options.yaw;
}

/// A draw that was looked at: judged only if it was clear of the points that stood before its batch.
struct Candidate {
    bool on_ground = false;  ///< whether the draw gave a pose at all
    bool clear = false;
    Spawn spawn;
    Judgement judgement;
};

/// The share of the wanted spawns that were found, told to whoever waits: also while none are.
inline Progress share_found(const SpawnOptions& options, const SpawnList& found)
{
    if (!options.progress) return {};
    return [&](double) { options.progress(double(found.spawns.size()) / double(options.count)); };
}

/// Draws 0, 1, 2, … in batches that all cores judge ahead; `take` gets them one by one in their order, and stops the
/// work by returning false. How far ahead they are judged never shows in the result. `progress` hears of it meanwhile.
template <class Look, class Take>
void draw_in_order(int threads, const Progress& progress, const Look& look, const Take& take)
{
    constexpr std::size_t first_batch = 256, largest_batch = 16384;
    std::vector<Candidate> batch;
    std::uint64_t next = 0;
    for (std::size_t size = first_batch;; size = std::min(2 * size, largest_batch)) {
        batch.assign(size, {});
        parallel_for(size, threads, progress, [&](std::size_t i) { batch[i] = look(next + i); });
        for (const Candidate& candidate : batch)
            if (!take(candidate)) return;
        next += size;
    }
}

}  // namespace spawnfield
