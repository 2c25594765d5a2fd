#include "query/stand_judge.h"

#include "query/timed_part.h"

#include <algorithm>

namespace spawnfield {
namespace {

constexpr double just_above = 1e-5;   // m: a robot that is raised by this touches nothing any more
constexpr double limit_slack = 1e-9;  // m and rad, in comparisons with limits

/// Returns an obstacle on which the robot rests, if there is one.
std::optional<CollisionHit> obstacle_below(const Rest& rest)
{
    for (const RestContact& contact : rest.contacts)
        if (contact.label != Label::Terrain) return CollisionHit{contact.ground};
    return std::nullopt;
}

}  // namespace

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
    const Rest rest = settler_.settle(place.x(), place.y(), yaw, there.ground->height, flat_);
    out.verdict = Verdict::Collision;
    if (rest.state == Rest::State::Blocked) {
        if (rest.wall) out.hit = CollisionHit{*rest.wall};
        return out;
    }
    out.has_pose = true;
    out.position.z() = rest.z;
    out.roll = rest.roll;
    out.pitch = rest.pitch;
    out.tilt = rest.tilt();
    out.margin = rest.margin;
    out.tip_over = rest.tip_over;
    out.belly = rest.belly;
    out.contacts = rest.contacts;
    judge_rest(column, rest, out);
    return out;
}

/// Sets the verdict on a robot that was let down, and what it meets.
void StandJudge::judge_rest(const ColumnView& column, const Rest& rest, SettledPose& out)
{
    const StandLimits& limits = shared_.options.stand;
    Judgement written;
    // The robot may stand over a crest that is higher than its origin, for example if that is between its feet.
    if (!upright_.judge_ground(column, out.lifted(limits.lift).position, written, std::max(rest.underside, 0.0))) {
        out.verdict = written.verdict;
        return;
    }
    out.verdict = Verdict::OffTerrain;
    out.hit = obstacle_below(rest);
    if (out.hit) return;
    // A pose belongs to the layer that carries its origin, so a column has it only once.
    out.verdict = Verdict::Collision;
    if (written.ground->height > out.ground->height + layer_tolerance) return;
    bool is_obstructed = rest.headroom < limits.lift;
    if (rest.state == Rest::State::Standing) {
        out.hit = hit_at(out, std::max(limits.lift, just_above));
        out.exact_check = true;
        if (out.hit && hit_at(out, just_above)) return;
        is_obstructed |= out.hit.has_value();
    }
    if (rest.state == Rest::State::Falling)
        out.verdict = Verdict::Unstable;
    else if (out.tilt > limits.max_slope + limit_slack)
        out.verdict = Verdict::Steep;
    else if (out.margin < *limits.min_stability - limit_slack)
        out.verdict = Verdict::Unstable;
    else if (is_obstructed || (limits.drop && rest.drop_z < out.position.z() + *limits.drop))
        out.verdict = Verdict::Obstructed;
    else
        out.verdict = Verdict::Valid;
    if (out.verdict != Verdict::Obstructed) out.hit.reset();
}

/// Returns what the robot collides with if it is raised from its rest.
std::optional<CollisionHit> StandJudge::hit_at(const SettledPose& pose, double raised)
{
    const TimedPart timed(shared_.options.exact_time);
    return checker_.find_hit(pose.lifted(raised));
}

}  // namespace spawnfield
