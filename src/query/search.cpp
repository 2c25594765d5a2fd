#include "base/chosen_bounds.h"
#include "query/judging.h"
#include "query/spawning.h"

#include <spawnfield/error.h>

#include <cmath>

namespace spawnfield {

void check_spawn_options(const char* function, const SpawnOptions& options)
{
    if (options.count < 1) throw ArgumentError(function, "count", double(options.count), ">= 1");
    if (options.count > max_spawns)
        throw ArgumentError(function, "count", double(options.count), "at most " + std::to_string(max_spawns));
    if (!(options.min_distance >= 0) || !std::isfinite(options.min_distance))
        throw ArgumentError(function, "min_distance", options.min_distance, ">= 0 m");
    if (!(options.max_height >= 0)) throw ArgumentError(function, "max_height", options.max_height, ">= 0 m");
    if (!(options.max_water_depth >= 0)) throw ArgumentError(function, "max_water_depth", options.max_water_depth, ">= 0 m");
    if (!std::isfinite(options.yaw)) throw ArgumentError(function, "yaw", options.yaw, "a finite number, rad");
}

SpawnList search(const Map& map, const CollisionChecker& checker, const SearchOptions& options)
{
    check_spawn_options("search", options);
    if (options.max_failures < 1) throw ArgumentError("search", "max_failures", double(options.max_failures), ">= 1");
    const Bounds box = chosen_bounds("search", options.bounds, map.bounds);
    const Judging judging(map, checker, options);
    SpacedPoints checked(options.min_distance);

    const auto look = [&](std::uint64_t index) {
        Draw draw(options.seed, index);
        Candidate out;
        out.on_ground = true;
        for (int axis = 0; axis < 3; ++axis) out.spawn.position[axis] = draw.uniform(box.min[axis], box.max[axis]);
        out.spawn.yaw = draw_yaw(options, draw);
        out.clear = checked.is_clear(out.spawn.position);
        if (!out.clear) return out;
        const Vec3& p = out.spawn.position;
        PoseJudge judge(judging);
        judge.face(out.spawn.yaw);
        judge.set_y(p.y());
        out.judgement = judge.at(column_at(map.geometry, p.x(), p.y()), p.x(), p.z());
        return out;
    };
    SpawnList out;
    std::uint64_t failures = 0;
    draw_in_order(options.threads, share_found(options, out), look, [&](const Candidate& candidate) {
        ++out.draws;
        ++failures;
        if (!candidate.clear || !checked.is_clear(candidate.spawn.position)) {
            ++out.too_close;
        } else {
            checked.add(candidate.spawn.position);
            ++out.counts[std::size_t(candidate.judgement.verdict)];
            out.exact_checks += candidate.judgement.exact_check;
            if (candidate.judgement.verdict == Verdict::Valid) {
                out.spawns.push_back(candidate.spawn);
                failures = 0;
            }
        }
        return out.spawns.size() < options.count && failures < options.max_failures;
    });
    return out;
}

}  // namespace spawnfield
