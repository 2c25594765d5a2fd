#include "query/stand_judge.h"

#include "query/obstacle_below.h"
#include "query/timed_part.h"
#include "settle/friction.h"

#include <spawnfield/error.h>

#include <algorithm>
#include <cmath>

namespace spawnfield {
namespace {

constexpr double just_above = 1e-5;   // m: a robot that is raised by this touches nothing any more
constexpr double limit_slack = 1e-9;  // m and rad, in comparisons with limits

/// Returns an angle without what rounding leaves of 0, such as 5e-20 or -0, which is hard to read in files.
double without_noise(double angle)
{
    constexpr double noise = 1e-12;  // rad: far below what any check notices
    return std::abs(angle) < noise ? 0.0 : angle;
}

/// Returns the heading with the largest value; of those that differ by at most `equal`, the first one.
template <class Value>
std::size_t first_largest(const std::vector<std::size_t>& headings, double equal, const Value& value)
{
    std::size_t out = headings.front();
    double largest = value(out);
    for (const std::size_t k : std::span(headings).subspan(1)) {
        const double of_k = value(k);
        if (!(of_k > largest + equal)) continue;
        largest = of_k;
        out = k;
    }
    return out;
}

}  // namespace

void check_filter(const char* function, const ReachFilter& is_reachable, Stance stance)
{
    if (is_reachable && stance == Stance::Level)
        throw ArgumentError(function,
                            "is_reachable is given, but stance is Level: only settled robots have islands; give stance "
                            "Settled, or no filter");
}

SettledPose StandJudge::judge(const Vec3& place, double yaw)
{
    return judge(ColumnView(upright_.column_at(place.head<2>())), place, yaw);
}

SettledPose StandJudge::judge(const ColumnView& column, const Vec3& place, double yaw)
{
    SettledPose out;
    out.position = place;
    out.yaw = yaw;
    Judgement there;
    const bool is_usable = upright_.judge_ground(column, place, there);
    out.verdict = there.verdict;
    out.ground = there.ground;
    if (!is_usable) return out;
    Rest rest = settler_.settle(place.x(), place.y(), yaw, there.ground->height, workspace_);
    out.verdict = Verdict::Collision;
    if (rest.state == Rest::State::Blocked) {
        if (rest.wall) out.hit = CollisionHit{*rest.wall};
        return out;
    }
    out.has_pose = true;
    out.position.z() = rest.z;
    out.roll = without_noise(rest.roll);
    out.pitch = without_noise(rest.pitch);
    out.tilt = rest.tilt();
    out.margin = rest.margin;
    out.tip_over = rest.tip_over;
    out.belly = rest.belly;
    out.contacts = std::move(rest.contacts);
    judge_rest(column, rest, out);
    if (out.verdict == Verdict::Valid && is_reachable_ && !is_reachable_(out)) out.verdict = Verdict::Unreachable;
    out.off_rules = out.verdict == Verdict::Valid && complies_ && !complies_(out);
    if (out.off_rules) out.verdict = Verdict::Unreachable;
    return out;
}

StandJudge::Choice StandJudge::judge(const ColumnView& column, const Vec3& place, const HeadingRule& rule,
                                     double chance)
{
    if (rule.has_several()) return judge_several(column, place, rule, chance);
    double yaw = rule.kind == HeadingRule::Kind::Facing ? std::atan2(rule.y - place.y(), rule.x - place.x())
                                                        : downhill_yaw(place);
    if (rule.kind == HeadingRule::Kind::Uphill && yaw != 0) yaw += yaw > 0 ? -std::numbers::pi : std::numbers::pi;
    Choice out{.pose = judge(column, place, yaw)};
    out.exact_checks = out.pose.exact_check;
    return out;
}

StandJudge::Choice StandJudge::judge_several(const ColumnView& column, const Vec3& place, const HeadingRule& rule,
                                             double chance)
{
    Choice out;
    std::vector<SettledPose> poses;
    std::vector<std::size_t> valid;
    VerdictCounts counts;
    for (int k = 0; k < rule.count; ++k) {
        poses.push_back(judge(column, place, heading_of(k, rule.count)));
        out.exact_checks += poses.back().exact_check;
        ++counts[poses.back().verdict];
        if (poses.back().verdict != Verdict::Valid) continue;
        valid.push_back(std::size_t(k));
        out.valid_headings |= std::uint64_t{1} << k;
    }
    const bool is_all = rule.kind == HeadingRule::Kind::All;
    std::size_t chosen = 0;
    if (valid.empty() || (is_all && valid.size() < poses.size())) {
        // Of equally frequent verdicts, the one with the smallest number counts, as in merged().
        const auto rank = [&](const SettledPose& pose) {
            return is_all ? int(pose.verdict != Verdict::Valid)
                          : int(counts[pose.verdict]) * int(verdict_count) - int(pose.verdict);
        };
        for (std::size_t k = 1; k < poses.size(); ++k)
            if (rank(poses[k]) > rank(poses[chosen])) chosen = k;
    } else if (rule.kind == HeadingRule::Kind::Best) {
        chosen = first_largest(valid, limit_slack, [&](std::size_t k) { return poses[k].margin; });
    } else if (rule.kind == HeadingRule::Kind::Clearest) {
        if (!clearances_) clearances_.emplace(shared_.map.geometry, shared_.robot);
        std::vector<double> clearances(poses.size());
        for (const std::size_t k : valid)
            clearances[k] = clearances_->clearance_at(poses[k].lifted(shared_.options.stand.lift));
        chosen = first_largest(valid, touch_margin, [&](std::size_t k) { return clearances[k]; });
        out.free_length = clearances[chosen];
    } else if (rule.kind == HeadingRule::Kind::Along) {
        chosen = longest_way(place, valid, out, poses);
    } else {
        chosen = valid[std::size_t(chance * double(valid.size()))];
    }
    out.pose = std::move(poses[chosen]);
    return out;
}

/// Returns the heading in which the robot can go straight ahead for longest; of equal ones the one in which it can also
/// go back for longest, and of these the first one. `headings` are the valid ones, and `poses` those of all headings.
/// Sets the length of the way ahead.
std::size_t StandJudge::longest_way(const Vec3& place, const std::vector<std::size_t>& headings, Choice& out,
                                    const std::vector<SettledPose>& poses)
{
    const Bounds box = shared_.robot.bounds();
    const double step = (box.max.x() - box.min.x()) / 2;
    const Ways ahead = with_longest_way(place, headings, poses, step, out);
    out.free_length = ahead.steps * step;
    return with_longest_way(place, ahead.headings, poses, -step, out).headings.front();
}

/// Returns the headings in which the robot can make the most steps of a length (m; negative: backwards), up to
/// HeadingRule::most_steps. A step leads to a valid pose at the same yaw, whose ground rises or falls by at most
/// --max-slope from that of the pose before. The length of a way back is not needed: if one heading is left, its other
/// steps backwards are not examined.
StandJudge::Ways StandJudge::with_longest_way(const Vec3& place, const std::vector<std::size_t>& headings,
                                              const std::vector<SettledPose>& poses, double step, Choice& out)
{
    struct Way {
        std::size_t heading;
        double ground;  ///< height of the ground of its last pose, m
    };
    const double rise = std::abs(step) * std::tan(shared_.options.stand.max_slope) + limit_slack;
    std::vector<Way> ways;
    for (const std::size_t k : headings) ways.push_back({k, poses[k].ground->height});
    const auto can_go_on = [&](Way& way, int steps) {
        const double yaw = poses[way.heading].yaw;
        const Vec2 at = place.head<2>() + steps * step * Vec2(std::cos(yaw), std::sin(yaw));
        const ColumnView column(upright_.column_at(at));
        const std::optional<Ground> ground = ground_below(column, way.ground + rise);
        if (!ground || ground->height < way.ground - rise) return false;
        way.ground = ground->height;
        const SettledPose pose = judge(column, {at.x(), at.y(), way.ground}, yaw);
        out.exact_checks += pose.exact_check;
        return pose.verdict == Verdict::Valid;
    };
    Ways longest;
    while (longest.steps < HeadingRule::most_steps && (step > 0 || ways.size() > 1)) {
        std::vector<Way> next;
        for (Way way : ways)
            if (can_go_on(way, longest.steps + 1)) next.push_back(way);
        if (next.empty()) break;
        ways = std::move(next);
        ++longest.steps;
    }
    for (const Way& way : ways) longest.headings.push_back(way.heading);
    return longest;
}

/// Returns the yaw in which the ground around a place falls most, by the heights half a robot's length away from it; 0
/// on level ground. Where there is no ground, the height of the place itself is used.
double StandJudge::downhill_yaw(const Vec3& place)
{
    constexpr double level = 1e-3, steepest = 2;  // slopes; steeper steps lead to other layers
    const Bounds box = shared_.robot.bounds();
    const double arm = (box.max - box.min).head<2>().maxCoeff() / 2;
    const auto rise = [&](const Vec2& way) {
        double nearest = steepest * arm, out = 0;
        for (const double height : upright_.column_at(place.head<2>() + way).layers) {
            if (!(std::abs(height - place.z()) < nearest)) continue;
            nearest = std::abs(height - place.z());
            out = height - place.z();
        }
        return out;
    };
    const Vec2 slope((rise({arm, 0}) - rise({-arm, 0})) / (2 * arm), (rise({0, arm}) - rise({0, -arm})) / (2 * arm));
    return slope.norm() < level ? 0 : std::atan2(-slope.y(), -slope.x());
}

/// Sets the verdict on a robot that was let down, and what it meets.
void StandJudge::judge_rest(const ColumnView& column, const Rest& rest, SettledPose& out)
{
    const StandLimits& limits = shared_.options.stand;
    Judgement written;
    // The robot may stand over a crest that is higher than its origin, for example if that is between its feet.
    const Pose lifted = out.lifted(limits.lift);
    if (!upright_.judge_ground(column, lifted.position, written, std::max(rest.underside, 0.0))) {
        out.verdict = written.verdict;
        return;
    }
    out.verdict = Verdict::OffTerrain;
    out.hit = obstacle_below(out.contacts);
    if (out.hit) return;
    // A pose belongs to the layer that carries its origin, so a column has it only once.
    out.verdict = Verdict::Collision;
    if (written.ground->height > out.ground->height + layer_tolerance) return;
    out.headroom = rest.headroom;
    if (limits.drop) out.free_fall = rest.drop_z - rest.z;
    bool is_obstructed = out.headroom < limits.lift;
    if (rest.state == Rest::State::Standing) {
        out.hit = hit_at(limits.lift >= just_above ? lifted : out.lifted(just_above), column);
        out.exact_check = true;
        if (out.hit && hit_at(out.lifted(just_above), column)) return;
        is_obstructed |= out.hit.has_value();
    }
    if (out.falls = rest.state == Rest::State::Falling; out.falls)
        out.verdict = Verdict::Unstable;
    else if (out.tilt > limits.max_slope + limit_slack)
        out.verdict = Verdict::Steep;
    else if (out.margin < *limits.min_stability - limit_slack)
        out.verdict = Verdict::Unstable;
    else if (out.slides = !is_held(out.contacts, out.position + lifted.rotation * settler_.mass_center(),
                                   limits.friction);
             out.slides)
        out.verdict = Verdict::Unstable;
    else if (is_obstructed || (limits.drop && out.free_fall < *limits.drop))
        out.verdict = Verdict::Obstructed;
    else
        out.verdict = Verdict::Valid;
    if (out.verdict != Verdict::Obstructed) out.hit.reset();
}

/// Returns what the robot collides with at a pose in a column.
std::optional<CollisionHit> StandJudge::hit_at(const Pose& pose, const ColumnView& column)
{
    const TimedPart timed(shared_.options.exact_time);
    return checker_.find_hit(pose, &column);
}

}  // namespace spawnfield
