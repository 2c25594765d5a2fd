#pragma once

#include "base/parallel.h"
#include "column/columns.h"
#include "free_space/mask.h"
#include "query/footing.h"

#include <spawnfield/judge.h>

namespace spawnfield {

/// Returns whether a pose with its origin there is not `outside`.
inline bool is_within(const Map& map, const Vec3& position)
{
    return map.bounds.contains_xy(position.x(), position.y(), touch_tolerance) &&
           map.z_limits.contains(position.z(), touch_tolerance);
}

/// Throws ArgumentError unless the range is one and the offset, if given, is finite.
void check_ground(const char* function, const ZRange& z, const std::optional<double>& offset);

/// Throws ArgumentError for an offset above max_height: `check` calls such poses aerial.
void check_offset(const char* function, double offset, double max_height);

/// Judges poses of one thread: the mask first, then an exact check where the mask cannot decide, then the footing of
/// poses that are free. Keeps what neighbouring poses share, so it is fast for poses in rows of equal y and rotation.
class PoseJudge {
public:
    /// Upright at this yaw until another rotation is set. Poses may be up to max_height above their ground.
    PoseJudge(const Judge::Impl& shared, double yaw, double max_height);
    PoseJudge(const Judge::Impl& shared, double yaw);  ///< with JudgeOptions::max_height
    PoseJudge(const PoseJudge&) = delete;
    PoseJudge& operator=(const PoseJudge&) = delete;

    /// Sets the rotation of the following poses. Returns at once if it is the present one.
    void set_rotation(double yaw);
    void set_rotation(const Mat3& rotation);

    /// Returns the verdict on a pose with its ground. `column` is the one at its x and y. With `with_hit` also what the
    /// robot collides with, which takes an exact check.
    Judgement judge(const ColumnView& column, const Vec3& position, bool with_hit = false);
    /// The same for a pose whose column is not at hand.
    Judgement judge(const Vec3& position, bool with_hit = false);
    /// Returns Valid or Collision: without ground and footing.
    Judgement judge_collision(const Vec3& position);

private:
    void decide(const ColumnView& column, const Vec3& position, bool with_hit, Judgement& out);
    void check_exactly(const Vec3& position, bool with_hit, Judgement& out) const;

    const Judge::Impl& shared_;
    const double max_height_;
    std::optional<Mask> mask_;        ///< none: every pose is checked exactly
    std::optional<Footing> footing_;  ///< none: slopes are not looked at
    Mat3 rotation_;
    double yaw_;     ///< if the rotation was set by a yaw, else not a number
    Column column_;  ///< of the last pose that came without one
};

struct Judge::Impl {
    Impl(Map map_, Robot robot_, const JudgeOptions& options_);

    const Map map;
    const Robot robot;
    const JudgeOptions options;
    const CollisionChecker checker;
    const std::optional<FreeSpace> space;  ///< none: every pose is checked exactly
    const std::optional<Footing> footing;  ///< none: slopes are not looked at; each PoseJudge takes its own copy
    mutable PerThread<PoseJudge> pose_judges{
        [this] { return PoseJudge(*this, 0); }};  ///< for poses that come one by one
};

}  // namespace spawnfield
