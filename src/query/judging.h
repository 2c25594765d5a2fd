#pragma once

#include "column/columns.h"
#include "free_space/mask.h"
#include "query/footing.h"

#include <spawnfield/query.h>

#include <chrono>

namespace spawnfield {

/// Whether a pose with its origin there is not `outside`.
inline bool is_within(const Map& map, const Vec3& position)
{
    return map.bounds.contains_xy(position.x(), position.y(), touch_tolerance) &&
           map.z_limits.contains(position.z(), touch_tolerance);
}

/// Judges poses for one query: the mask first, the CollisionChecker where it cannot tell, then the footing of those
/// that are free. Shared by all threads.
class Judging {
public:
    Judging(const Map& map, const CollisionChecker& checker, const QueryOptions& options);

    const Map& map() const { return map_; }
    const QueryOptions& options() const { return options_; }
    const FreeSpace* free_space() const { return space_ ? &*space_ : nullptr; }

private:
    friend class PoseJudge;
    const Map& map_;
    const CollisionChecker& checker_;
    const QueryOptions options_;
    std::optional<FreeSpace> space_;  ///< none: every pose is checked exactly
    std::optional<Footing> footing_;  ///< none: it is not asked for; each thread takes its own copy
};

/// Throws ArgumentError unless the range is one and the offset, if given, is finite.
void check_ground(const char* function, const ZRange& z, const std::optional<double>& offset);

/// Throws ArgumentError for an offset above max_height: `check` calls such poses aerial.
void check_offset(const char* function, double offset, const QueryOptions& options);

/// One thread's judge of poses that share a rotation.
class PoseJudge {
public:
    explicit PoseJudge(const Judging& judging);
    PoseJudge(const PoseJudge&) = delete;
    PoseJudge& operator=(const PoseJudge&) = delete;
    ~PoseJudge();  ///< tells the time of its exact checks

    void face(double yaw);  ///< upright; to be called before the first pose
    void face(const Mat3& rotation);
    void set_y(double y);

    /// The verdict at (x, y of set_y, z) with its ground, as judge gives it. With `with_hit` also what a pose collides
    /// with, which takes an exact check.
    Judgement at(const ColumnView& column, double x, double z, bool with_hit = false);
    /// Valid or Collision: of collisions alone, whatever the footing.
    Judgement collision(double x, double z, bool with_hit = false);

private:
    void decide(const ColumnView& column, double x, double z, bool with_hit, Judgement& out);
    void decide_exactly(const Pose& pose, bool with_hit, Judgement& out);

    const Judging& judging_;
    std::optional<Mask> mask_;
    std::optional<Footing> footing_;
    Mat3 rotation_ = Mat3::Identity();
    double y_ = 0;
    std::chrono::nanoseconds exact_time_{0};
};

}  // namespace spawnfield
