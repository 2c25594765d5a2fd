#include "base/parallel.h"
#include "query/judging.h"

#include <algorithm>
#include <numeric>

namespace spawnfield {
namespace {

bool is_submerged(const ColumnView& column, double ground, double max_water_depth)
{
    return std::any_of(column.water.begin(), column.water.end(), [&](double water) {
        return water >= ground - touch_tolerance && water <= ground + max_water_depth + touch_tolerance;
    });
}

/// The verdict table up to collisions; true if those are to decide.
bool judge_ground(const Map& map, const ColumnView& column, const Vec3& position, const QueryOptions& options,
                  Judgement& out)
{
    out.ground = ground_below(column, position.z());
    out.verdict = Verdict::Outside;
    if (!is_within(map, position)) return false;
    out.verdict = Verdict::Aerial;
    if (!out.ground || position.z() - out.ground->height > options.max_height + touch_tolerance) return false;
    out.verdict = Verdict::OffTerrain;
    if (!out.ground->terrain) return false;
    out.verdict = Verdict::Submerged;
    return !is_submerged(column, out.ground->height, options.max_water_depth);
}

void check_exactly(const CollisionChecker& checker, const Pose& pose, bool with_hit, Judgement& out)
{
    out.exact_check = true;
    if (with_hit) out.hit = checker.find_hit(pose);
    const bool is_free = with_hit ? !out.hit : checker.is_free(pose);
    out.verdict = is_free ? Verdict::Valid : Verdict::Collision;
}

bool has_limit(const QueryOptions& options) { return options.max_slope != std::numeric_limits<double>::infinity(); }

/// Numbers of poses, neighbours after each other, so that they find each other's tiles in the cache. Counting sort over
/// a grid around them.
std::vector<std::uint32_t> in_neighbourhoods(const std::vector<Pose>& poses)
{
    constexpr std::size_t side = 256;
    Bounds bounds;
    for (const Pose& pose : poses) bounds.extend(pose.position);
    const auto bin_of = [&](const Vec3& p) {
        const auto along = [&](int axis) {
            const double share = (p[axis] - bounds.min[axis]) / (bounds.max[axis] - bounds.min[axis]);
            return share > 0 ? std::size_t(std::min(share, 1.0) * (side - 1)) : 0;  // also where the share is no number
        };
        return along(1) * side + along(0);
    };
    std::vector<std::uint32_t> starts(side * side + 1), order(poses.size());
    for (const Pose& pose : poses) ++starts[bin_of(pose.position) + 1];
    std::partial_sum(starts.begin(), starts.end(), starts.begin());
    for (std::size_t i = 0; i < poses.size(); ++i) order[starts[bin_of(poses[i].position)]++] = std::uint32_t(i);
    return order;
}

}  // namespace

Judgement judge(const Map& map, const CollisionChecker& checker, const Column& column, const Pose& pose,
                const QueryOptions& options)
{
    check_max_slope("judge", options);
    Judgement out;
    if (judge_ground(map, column, pose.position, options, out)) check_exactly(checker, pose, true, out);
    if (out.verdict != Verdict::Valid || !has_limit(options)) return out;
    Footing footing(map.geometry, checker.robot(), options.max_slope);
    footing.face(pose.rotation);
    out.verdict = footing.at(pose.position, out.ground->height);
    return out;
}

Judging::Judging(const Map& map, const CollisionChecker& checker, const QueryOptions& options)
    : map_(map), checker_(checker), options_(options)
{
    if (!options.exhaustive && !checker.uses_occupancy() && !map.solid_bounds.impl().levels.empty())
        space_.emplace(map.solid_bounds, checker.robot());
    if (has_limit(options)) footing_.emplace(map.geometry, checker.robot(), options.max_slope);
}

PoseJudge::PoseJudge(const Judging& judging) : judging_(judging), footing_(judging.footing_)
{
    if (judging.space_) mask_.emplace(judging.space_->impl());
}

void PoseJudge::face(double yaw)
{
    rotation_ = rotation_from_rpy(0, 0, yaw);
    if (mask_) mask_->face(yaw);
    if (footing_) footing_->face(rotation_);
}

void PoseJudge::face(const Mat3& rotation)
{
    rotation_ = rotation;
    if (footing_) footing_->face(rotation_);
    if (!mask_) return;
    if (rotation(2, 2) == 1)
        mask_->face(std::atan2(rotation(1, 0), rotation(0, 0)));
    else
        mask_->face(rotation);
}

void PoseJudge::set_y(double y)
{
    y_ = y;
    if (mask_) mask_->set_y(y);
}

Judgement PoseJudge::at(const ColumnView& column, double x, double z, bool with_hit)
{
    Judgement out;
    if (judge_ground(judging_.map_, column, {x, y_, z}, judging_.options_, out)) decide(column, x, z, with_hit, out);
    if (footing_ && out.verdict == Verdict::Valid) out.verdict = footing_->at({x, y_, z}, out.ground->height);
    return out;
}

Judgement PoseJudge::collision(double x, double z, bool with_hit)
{
    Judgement out;
    decide({}, x, z, with_hit, out);
    return out;
}

void PoseJudge::decide(const ColumnView& column, double x, double z, bool with_hit, Judgement& out)
{
    Proof proof = Proof::Candidate;
    if (mask_ && mask_->is_pierced(column.spans, z))
        proof = Proof::Blocked;
    else if (mask_)
        proof = mask_->at(x, z);
    if (proof == Proof::Free)
        out.verdict = Verdict::Valid;
    else if (proof == Proof::Blocked && !with_hit)
        out.verdict = Verdict::Collision;
    else
        decide_exactly({{x, y_, z}, rotation_}, with_hit, out);
}

void PoseJudge::decide_exactly(const Pose& pose, bool with_hit, Judgement& out)
{
    using Clock = std::chrono::steady_clock;
    const bool timed = judging_.options_.exact_time != nullptr;
    const Clock::time_point start = timed ? Clock::now() : Clock::time_point{};
    check_exactly(judging_.checker_, pose, with_hit, out);
    if (timed) exact_time_ += Clock::now() - start;
}

PoseJudge::~PoseJudge()
{
    if (judging_.options_.exact_time != nullptr) judging_.options_.exact_time->nanoseconds += exact_time_.count();
}

std::vector<Judgement> check_poses(const Map& map, const CollisionChecker& checker, const std::vector<Pose>& poses,
                                   const QueryOptions& options)
{
    check_max_slope("check_poses", options);
    const Judging judging(map, checker, options);
    std::vector<Judgement> out(poses.size());
    const std::vector<std::uint32_t> order = in_neighbourhoods(poses);
    constexpr std::size_t batch = 256;
    parallel_for((poses.size() + batch - 1) / batch, options.threads, options.progress, [&](std::size_t b) {
        PoseJudge judge(judging);
        for (const std::uint32_t i : std::span(order).subspan(b * batch, std::min(batch, poses.size() - b * batch))) {
            const Vec3& p = poses[i].position;
            judge.face(poses[i].rotation);
            judge.set_y(p.y());
            out[i] = judge.at(column_at(map.geometry, p.x(), p.y()), p.x(), p.z(), true);
        }
    });
    return out;
}

}  // namespace spawnfield
