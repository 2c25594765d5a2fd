#include "review/judged_poses.h"

#include "base/parallel.h"

#include <algorithm>

namespace spawnfield {
namespace {

std::vector<JudgedPlace> judged(const Judge& judge, Stance stance, const std::vector<Pose>& poses, int threads)
{
    std::vector<JudgedPlace> out(poses.size());
    if (stance == Stance::Settled) {
        std::vector<SettledPose> settled = judge.settle(poses, {.threads = threads});
        for (std::size_t i = 0; i < out.size(); ++i) {
            out[i].judgement = judgement_of(settled[i]);
            out[i].settled = std::move(settled[i]);
        }
    } else {
        const std::vector<Judgement> judgements = judge.check(poses, {.threads = threads});
        for (std::size_t i = 0; i < out.size(); ++i) out[i].judgement = judgements[i];
    }
    parallel_for(out.size(), threads, {}, [&](std::size_t i) {
        if (out[i].judgement.verdict == Verdict::Valid) return;
        out[i].reason = stance == Stance::Settled ? judge.describe(out[i].settled)
                                                  : judge.describe(poses[i], out[i].judgement);
    });
    return out;
}

}  // namespace

void judge_places(const Judge& judge, Stance stance, std::size_t count, const std::function<Pose(std::size_t)>& pose_of,
                  const RunOptions& options, const std::function<void(std::size_t, const JudgedPlace&)>& take)
{
    constexpr std::size_t at_once = 1 << 14;
    for (std::size_t begin = 0; begin < count; begin += at_once) {
        const std::size_t end = std::min(count, begin + at_once);
        std::vector<Pose> poses;
        for (std::size_t i = begin; i < end; ++i) poses.push_back(pose_of(i));
        std::size_t next = begin;
        for (const JudgedPlace& place : judged(judge, stance, poses, options.threads)) take(next++, place);
        if (options.progress) options.progress(double(end) / double(count));
    }
}

std::uint32_t hit_number(const std::optional<CollisionHit>& hit, const Map& map)
{
    if (!hit) return 0;
    return 1 + std::uint32_t(hit->part == CollisionHit::occupancy ? map.geometry.parts().size() : hit->part);
}

}  // namespace spawnfield
