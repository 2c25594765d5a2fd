#pragma once

#include "base/parallel.h"
#include "collision/pose_checker.h"
#include "column/columns.h"
#include "free_space/mask.h"
#include "query/footing.h"
#include "settle/settle.h"
#include "settle/underside.h"

#include <spawnfield/heading_rule.h>
#include <spawnfield/judge.h>

#include <mutex>

namespace spawnfield {

/// Returns whether a position is within the map's bounds in x and y, and within its z limits. Other poses are
/// `outside`.
inline bool is_within(const Map& map, const Vec3& position)
{
    return map.bounds.contains_xy(position.x(), position.y(), touch_tolerance) &&
           map.z_limits.contains(position.z(), touch_tolerance);
}

/// Throws ArgumentError if z.low is above z.high, if one of them is NaN, if the offset is given and not finite, or if
/// it is given for settled robots.
void check_ground(const char* function, const ZRange& z, Stance stance, const std::optional<double>& offset);

/// Throws ArgumentError if a rule has values beyond their limits, or if it is given for level robots.
void check_heading(const char* function, const std::optional<HeadingRule>& rule, Stance stance);

/// Throws ArgumentError if the offset is above max_height, because `check` would call such poses aerial.
void check_offset(const char* function, double offset, double max_height);

/// Judges poses of one thread: the mask first, then an exact check where the mask cannot decide, then the footing of
/// poses that are free. Caches what neighbouring poses share, so it is fast for rows of poses with equal y and
/// rotation.
class PoseJudge {
public:
    /// Poses are upright with this yaw until set_rotation() is called. Poses more than max_height above their ground
    /// are aerial.
    PoseJudge(const Judge::Impl& shared, double yaw, double max_height);
    PoseJudge(const Judge::Impl& shared, double yaw);  ///< with JudgeOptions::max_height
    PoseJudge(const PoseJudge&) = delete;
    PoseJudge& operator=(const PoseJudge&) = delete;

    /// Sets the rotation of the following poses. Does nothing if they have it already.
    void set_rotation(double yaw);
    void set_rotation(const Mat3& rotation);

    /// Says that many of the next poses are in this rectangle: their exact checks share the search for tiles.
    void expect(const Rect& places) { checker_.expect(places); }
    /// From now on, shares this search with another judge, for poses at the same places.
    void share_search(const PoseJudge& with) { checker_.share_tiles(with.checker_); }

    /// From now on, the mask only uses coarse cells, and more poses are checked exactly: for few poses, far apart.
    void use_coarse_cells()
    {
        if (mask_) mask_->use_coarse_cells();
    }

    /// From now on, an exact check takes the place of a look at fine cells that have several intervals, if checks are
    /// fast: for poses beside each other, not above each other.
    void leave_layered_cells();

    /// Returns the verdict on a pose, and its ground. `column` must be the column at its x and y. `with_hit` adds what
    /// the robot collides with; this needs an exact check.
    Judgement judge(const ColumnView& column, const Vec3& position, bool with_hit = false);
    /// The same, but looks up the column of the pose itself.
    Judgement judge(const Vec3& position, bool with_hit = false);
    /// The same by the rule for poses as given: a pose that is aerial, off_terrain or submerged is valid if it is valid
    /// with the ground between its origin and the robot's underside (see judge_over_ground()).
    Judgement judge_as_given(const ColumnView& column, const Vec3& position, bool with_hit = false);
    Judgement judge_as_given(const Vec3& position, bool with_hit = false);
    /// Judges a pose by ground that is above its origin and below the robot, for example a crest between its wheels.
    /// Ground counts up to the robot's lowest point on the vertical line through its origin. Returns nothing if there
    /// is none.
    std::optional<Judgement> judge_over_ground(const ColumnView& column, const Vec3& position, bool with_hit);
    /// Returns the column at (x, y). It is valid until the next column is looked up.
    const Column& column_at(const Vec2& place);
    struct RowVerdict {
        Verdict verdict;
        bool exact_check;  ///< as in Judgement
    };
    /// Returns whether judge_row() can be called.
    bool can_judge_rows() const { return mask_ && !footing_ && max_height_ == std::numeric_limits<double>::infinity(); }
    /// The column of a pose in a row that has more than open ground.
    struct LayeredColumn {
        std::size_t pose;  ///< its index in the row
        ColumnView column;
    };
    /// Judges a row of poses: at x[i], ascending, and y, `offset` >= 0 above the terrain of ground[i]. It takes less
    /// time than judge() for each pose. The column of each pose must have nothing but ground[i], or be in `layered`.
    /// Poses without terrain are left out.
    void judge_row(std::span<const double> x, double y, std::span<const Columns::OpenGround> ground,
                   std::span<const LayeredColumn> layered, double offset, std::span<RowVerdict> out);
    /// Returns Valid or Collision. Does not look at ground and footing.
    Judgement judge_collision(const Vec3& position);

    // The steps of judge():
    /// Sets the ground, and decides the verdicts that come before `collision`. Returns true if none of them applies.
    /// The ground is at most `above` higher than the position, m.
    bool judge_ground(const ColumnView& column, const Vec3& position, Judgement& out, double above = 0) const;
    /// Sets Valid or Collision.
    void judge_collision(const ColumnView& column, const Vec3& position, bool with_hit, Judgement& out);
    /// Changes Valid to Steep or Unstable, if the footing of the pose is.
    void judge_footing(const Vec3& position, Judgement& out);

private:
    Judgement judge(const ColumnView& column, const Vec3& position, bool with_hit, double above);
    void judge_collision(Proof proof, const ColumnView* column, const Vec3& position, bool with_hit, Judgement& out);
    void check_exactly(const ColumnView* column, const Vec3& position, bool with_hit, Judgement& out);

    const Judge::Impl& shared_;
    const double max_height_;
    PoseChecker checker_;
    std::optional<Mask> mask_;            ///< empty: every pose is checked exactly
    std::optional<Footing> footing_;      ///< empty: footings are not examined
    std::optional<Underside> underside_;  ///< made when it is first needed
    Mat3 rotation_;
    double yaw_;                 ///< the yaw given to set_rotation(); NaN after a matrix
    Column column_;              ///< the one that was looked up last
    std::vector<double> z_;      ///< of the poses of a row, m
    std::vector<Proof> proofs_;  ///< of these poses
};

struct Judge::Impl {
    Impl(Map map_, Robot robot_, const JudgeOptions& options_);

    /// Returns whether so many poses, far apart, take less time with coarse cells only. For so few poses, most fine
    /// tiles of the mask would serve one pose only, and an exact check takes less time than reading a tile, unless it
    /// meets many elements.
    bool is_sparse(std::uint64_t poses) const;
    /// Says that so many poses will be judged, at random places. For many, the map keeps all that it reads in memory.
    void expect(std::uint64_t poses) const;

    /// Returns what lets the robot down. It is made at the first call. Throws ArgumentError if the obstacles are
    /// voxels.
    const Settler& settler() const;

    const Map map;
    const Robot robot;
    const JudgeOptions options;
    const CollisionChecker checker;
    const bool are_checks_fast;            ///< comparing the robot with all that is near takes little time
    const std::optional<FreeSpace> space;  ///< empty: every pose is checked exactly
    const std::optional<Footing> footing;  ///< empty: footings are not examined; each PoseJudge has its own copy
    mutable PerThread<PoseJudge> pose_judges{[this] { return PoseJudge(*this, 0); }};  ///< for calls with one pose

private:
    mutable std::once_flag settler_made_;
    mutable std::optional<Settler> settler_;
};

}  // namespace spawnfield
