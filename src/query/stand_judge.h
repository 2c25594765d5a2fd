#pragma once

#include "query/pose_judge.h"

namespace spawnfield {

/// Lets the robot down and judges its settled poses, for one thread.
class StandJudge {
public:
    explicit StandJudge(const Judge::Impl& shared)
        : shared_(shared), settler_(shared.settler()), upright_(shared, 0), checker_(shared.checker)
    {
    }

    /// Judges the robot that is let down at (x, y) with a yaw onto the ground at or below z. `column` must be the
    /// column at (x, y).
    SettledPose judge(const ColumnView& column, const Vec3& place, double yaw);
    /// The same, but looks up the column itself.
    SettledPose judge(const Vec3& place, double yaw);

private:
    void judge_rest(const ColumnView& column, const Rest& rest, SettledPose& out);
    std::optional<CollisionHit> hit_at(const SettledPose& pose, double raised);

    const Judge::Impl& shared_;
    const Settler& settler_;
    Settler::FlatRest flat_;  ///< for the yaw of the last pose
    PoseJudge upright_;
    PoseChecker checker_;
};

}  // namespace spawnfield
