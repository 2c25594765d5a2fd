#pragma once

#include "query/clearance.h"
#include "query/pose_judge.h"

#include <spawnfield/heading_rule.h>
#include <spawnfield/query.h>

#include <utility>

namespace spawnfield {

/// Throws ArgumentError if the filter is given for level robots.
void check_filter(const char* function, const ReachFilter& is_reachable, Stance stance);

/// Lets the robot down and judges its settled poses, for one thread.
class StandJudge {
public:
    /// Valid poses that a filter refuses are `unreachable`. Without filters, there are no such poses. Those that only
    /// the second filter refuses have SettledPose::off_rules.
    explicit StandJudge(const Judge::Impl& shared, ReachFilter is_reachable = {}, ReachFilter complies = {})
        : shared_(shared), settler_(shared.settler()), upright_(shared, 0), checker_(shared.checker),
          is_reachable_(std::move(is_reachable)), complies_(std::move(complies))
    {
    }

    /// Announces that most of the next places are in this rectangle. They share work if it is small.
    void expect(const Rect& places) { settler_.expect(places, workspace_); }

    /// Judges the robot that is let down at (x, y) with a yaw onto the ground at or below z. `column` must be the
    /// column at (x, y).
    SettledPose judge(const ColumnView& column, const Vec3& place, double yaw);
    /// The same, but looks up the column itself.
    SettledPose judge(const Vec3& place, double yaw);

    /// A pose at a heading that was chosen by a rule.
    struct Choice {
        SettledPose pose;
        std::uint64_t valid_headings = 0;                               ///< as RasterRest::valid_headings
        std::uint64_t exact_checks = 0;                                 ///< at all headings
        double free_length = std::numeric_limits<double>::quiet_NaN();  ///< as RasterRest::free_length
    };

    /// The same at the heading that a rule chooses. For All and Any, `chance` (in [0, 1)) selects one of the valid
    /// headings. If the rule finds no valid pose, returns the first one that has the most frequent verdict (of equally
    /// frequent ones, that with the smallest number) or, for All, the first one that is not valid.
    Choice judge(const ColumnView& column, const Vec3& place, const HeadingRule& rule, double chance);

private:
    Choice judge_several(const ColumnView& column, const Vec3& place, const HeadingRule& rule, double chance);
    std::size_t longest_way(const Vec3& place, const std::vector<std::size_t>& headings, Choice& out,
                            const std::vector<SettledPose>& poses);
    /// The headings with the longest way, and its number of steps.
    struct Ways {
        std::vector<std::size_t> headings;
        int steps = 0;
    };
    Ways with_longest_way(const Vec3& place, const std::vector<std::size_t>& headings,
                          const std::vector<SettledPose>& poses, double step, Choice& out);
    double downhill_yaw(const Vec3& place);
    void judge_rest(const ColumnView& column, const Rest& rest, SettledPose& out);
    std::optional<CollisionHit> hit_at(const Pose& pose, const ColumnView& column);

    const Judge::Impl& shared_;
    const Settler& settler_;
    Settler::Workspace workspace_;
    PoseJudge upright_;
    PoseChecker checker_;
    const ReachFilter is_reachable_, complies_;
    std::optional<ClearanceMeter> clearances_;  ///< made when it is first needed
};

}  // namespace spawnfield
