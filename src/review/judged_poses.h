#pragma once

#include <spawnfield/judge.h>

#include <functional>
#include <span>
#include <string>

namespace spawnfield {

/// What a page shows about a pose.
struct JudgedPlace {
    Judgement judgement;
    std::string reason;        ///< empty if it is valid
    SettledPose settled = {};  ///< only of settled robots
};

/// Judges poses as Judge::check() or, if the robot is let down, as Judge::settle() does, and calls
/// take(index, result) in their order. Holds only some of them at a time.
void judge_places(const Judge& judge, Stance stance, std::size_t count, const std::function<Pose(std::size_t)>& pose_of,
                  const RunOptions& options, const std::function<void(std::size_t, const JudgedPlace&)>& take);

/// Returns the number of what a robot meets: 0 nothing, 1 + its part, or 1 + the number of parts: a voxel of the
/// OctoMap.
std::uint32_t hit_number(const std::optional<CollisionHit>& hit, const Map& map);

}  // namespace spawnfield
