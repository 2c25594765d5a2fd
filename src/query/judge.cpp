#include "base/number.h"
#include "base/rotation.h"
#include "query/neighbourhoods.h"
#include "query/obstacle_below.h"
#include "query/stand_judge.h"
#include "query/timed_part.h"
#include "settle/friction.h"

#include <spawnfield/error.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace spawnfield {
namespace {

bool has_max_slope(const JudgeOptions& options) { return options.max_slope != std::numeric_limits<double>::infinity(); }

/// Returns the options, with values for those that depend on the robot.
JudgeOptions checked(JudgeOptions options, const Robot& robot)
{
    const auto require = [](bool is_good, const char* name, double value, const char* limit) {
        if (!is_good) throw ArgumentError("Judge", name, value, limit);
    };
    require(options.max_height >= 0, "max_height", options.max_height, ">= 0 m");
    require(options.max_water_depth >= 0, "max_water_depth", options.max_water_depth, ">= 0 m");
    require(!has_max_slope(options) || (options.max_slope > 0 && options.max_slope < std::numbers::pi / 2), "max_slope",
            options.max_slope, "> 0 and < pi/2 rad, or infinite");
    StandLimits& stand = options.stand;
    if (!stand.min_stability) stand.min_stability = auto_min_stability(robot);
    const auto is_angle = [](double angle) { return angle > 0 && angle < std::numbers::pi / 2; };
    const auto is_length = [](double length) { return length >= 0 && std::isfinite(length); };
    require(is_length(stand.lift), "stand.lift", stand.lift, ">= 0 m");
    require(is_angle(stand.max_slope), "stand.max_slope", stand.max_slope, "> 0 and < pi/2 rad");
    require(is_angle(stand.max_tilt), "stand.max_tilt", stand.max_tilt, "> 0 and < pi/2 rad");
    require(is_length(*stand.min_stability), "stand.min_stability", *stand.min_stability, ">= 0 m");
    require(stand.friction >= 0 && std::isfinite(stand.friction), "stand.friction", stand.friction, ">= 0");
    require(!stand.drop || (is_length(*stand.drop) && *stand.drop > 0), "stand.drop", stand.drop.value_or(0), "> 0 m");
    return options;
}

Robot checked(Robot robot)
{
    if (robot.parts.empty()) throw ArgumentError("Judge", "the robot has no parts, needs at least one");
    return robot;
}

CollisionChecker checker_of(const Map& map, const Robot& robot, const JudgeOptions& options)
{
    if (options.obstacles == Obstacles::Geometry) return {map.geometry, robot, options.exhaustive};
    return {std::make_shared<const OccupancyTree>(read_occupancy(map)), robot};
}

std::optional<FreeSpace> mask_of(const Map& map, const Robot& robot, const JudgeOptions& options)
{
    const bool is_usable = !options.exhaustive && options.obstacles == Obstacles::Geometry &&
                           !map.solid_bounds.impl().levels().empty();
    return is_usable ? std::optional<FreeSpace>(std::in_place, map.solid_bounds, robot) : std::nullopt;
}

std::optional<Footing> footing_of(const Map& map, const Robot& robot, const JudgeOptions& options)
{
    return has_max_slope(options) ? std::optional<Footing>(std::in_place, map.geometry, robot, options.max_slope)
                                  : std::nullopt;
}

bool is_submerged(double ground, double water, double max_water_depth)
{
    return water >= ground - touch_tolerance && water <= ground + max_water_depth + touch_tolerance;
}

/// Returns whether exact checks take little time: the robot is one box, which is compared fast with triangles, and
/// nearly all elements of the scene are triangles.
bool has_fast_checks(const Map& map, const Robot& robot)
{
    constexpr std::uint64_t few = 16;  // one primitive for so many triangles
    std::uint64_t primitives = 0;
    for (const LabelCount& label : map.geometry.labels()) primitives += label.primitives;
    return robot.parts.size() == 1 && robot.parts[0].shape.kind == ShapeKind::Box &&
           primitives * few <= map.geometry.element_count();
}

/// Returns how far an obstructed robot can be raised, or from where it can fall.
std::string obstruction(const SettledPose& pose, const StandLimits& limits)
{
    if (pose.headroom < limits.lift)
        return ": it can be raised by " + rounded(pose.headroom) + " m, --lift is " + rounded(limits.lift) + " m";
    if (limits.drop && pose.free_fall < *limits.drop)
        return ": it can fall from " + rounded(pose.free_fall) + " m above its rest, --drop is " +
               rounded(*limits.drop) + " m";
    return "";
}

/// Returns how much friction a robot needs not to slide.
std::string friction_reason(const SettledPose& pose, const Robot& robot, double limit)
{
    const double needed = friction_needed(pose.contacts, mass_center_at(pose, mass_center_of(robot)), limit);
    const std::string has = ", and --friction is " + rounded(limit);
    if (std::isinf(needed)) return "not even a coefficient of friction of 10 holds it" + has;
    return "it needs a coefficient of friction of about " + rounded(std::ceil(100 * needed) / 100) + has;
}

}  // namespace

Judge::Impl::Impl(Map map_, Robot robot_, const JudgeOptions& options_)
    : map(std::move(map_)), robot(checked(std::move(robot_))), options(checked(options_, robot)),
      checker(checker_of(map, robot, options)), are_checks_fast(has_fast_checks(map, robot)),
      space(mask_of(map, robot, options)), footing(footing_of(map, robot, options))
{
}

namespace {

/// Returns how far above the robot its way must be known, m: for --lift from its rest, and for --drop from where it was
/// level.
double needed_headroom(const Robot& robot, const StandLimits& limits)
{
    if (!limits.drop) return limits.lift;
    const Bounds box = robot.bounds();
    const double largest_rise = 2 * std::max(box.max.norm(), box.min.norm());  // from the level robot to its rest
    return std::max(limits.lift, *limits.drop + largest_rise);
}

}  // namespace

const Settler& Judge::Impl::settler() const
{
    if (options.obstacles != Obstacles::Geometry)
        throw ArgumentError("Judge", "settled poses need the scene's own geometry, but the obstacles are voxels");
    std::call_once(settler_made_, [&] {
        settler_.emplace(map.geometry, robot,
                         Settler::Options{.max_tilt = options.stand.max_tilt,
                                          .max_height = options.max_height,
                                          .min_stability = *options.stand.min_stability,
                                          .headroom = needed_headroom(robot, options.stand),
                                          .wants_drop = options.stand.drop.has_value()});
    });
    return *settler_;
}

bool Judge::Impl::is_sparse(std::uint64_t poses) const
{
    constexpr double few_elements = 64;  // under a robot: they take about as long as one tile
    const std::vector<TileLevel>& levels = map.solid_bounds.impl().levels();
    if (options.obstacles != Obstacles::Geometry || levels.empty() || poses > levels[0].tiles.size()) return false;
    const auto area = [](const Bounds& box) { return (box.max.x() - box.min.x()) * (box.max.y() - box.min.y()); };
    const double scene = area(map.geometry.bounds());
    return double(map.geometry.element_count()) * area(robot.bounds()) <= few_elements * scene;
}

void Judge::Impl::expect(std::uint64_t poses) const
{
    constexpr std::uint64_t many = 16;  // poses for each tile of the finest level: most of these will be read
    const SolidBounds::Impl& bounds = map.solid_bounds.impl();
    if (options.obstacles != Obstacles::Geometry || bounds.levels().empty() ||
        poses < many * bounds.levels()[0].tiles.size())
        return;
    bounds.expect_all();
    map.geometry.impl().expect_all();
}

PoseJudge::PoseJudge(const Judge::Impl& shared, double yaw) : PoseJudge(shared, yaw, shared.options.max_height) {}

PoseJudge::PoseJudge(const Judge::Impl& shared, double yaw, double max_height)
    : shared_(shared), max_height_(max_height), checker_(shared.checker), footing_(shared.footing),
      rotation_(rotation_from_rpy(0, 0, yaw)), yaw_(yaw)
{
    if (shared.space) mask_.emplace(shared.space->impl(), yaw);
    if (footing_) footing_->set_rotation(rotation_);
}

void PoseJudge::set_rotation(double yaw)
{
    if (yaw == yaw_) return;
    yaw_ = yaw;
    rotation_ = rotation_from_rpy(0, 0, yaw);
    if (mask_) mask_->set_rotation(yaw);
    if (footing_) footing_->set_rotation(rotation_);
}

void PoseJudge::set_rotation(const Mat3& rotation)
{
    if (rotation == rotation_ && std::isnan(yaw_)) return;
    yaw_ = std::numeric_limits<double>::quiet_NaN();
    rotation_ = rotation;
    if (mask_) mask_->set_rotation(rotation_);
    if (footing_) footing_->set_rotation(rotation_);
}

void PoseJudge::leave_layered_cells()
{
    if (mask_ && shared_.are_checks_fast) mask_->leave_layered_cells();
}

Judgement PoseJudge::judge(const ColumnView& column, const Vec3& position, bool with_hit)
{
    return judge(column, position, with_hit, 0);
}

/// The ground is at most `above` higher than the position, m.
Judgement PoseJudge::judge(const ColumnView& column, const Vec3& position, bool with_hit, double above)
{
    Judgement out;
    if (!judge_ground(column, position, out, above)) return out;
    judge_collision(column, position, with_hit, out);
    judge_footing(position, out);
    return out;
}

bool PoseJudge::judge_ground(const ColumnView& column, const Vec3& position, Judgement& out, double above) const
{
    out.ground = ground_below(column, position.z() + above);
    out.verdict = Verdict::Outside;
    if (!is_within(shared_.map, position)) return false;
    out.verdict = Verdict::Aerial;
    if (!out.ground || position.z() - out.ground->height > max_height_ + touch_tolerance) return false;
    out.verdict = Verdict::OffTerrain;
    if (!out.ground->terrain) return false;
    out.verdict = Verdict::Submerged;
    return std::none_of(column.water.begin(), column.water.end(), [&](double water) {
        return is_submerged(out.ground->height, water, shared_.options.max_water_depth);
    });
}

void PoseJudge::judge_footing(const Vec3& position, Judgement& out)
{
    if (footing_ && out.verdict == Verdict::Valid) out.verdict = footing_->judge(position, out.ground->height);
}

namespace {

/// Returns whether a verdict is about the ground of a pose. Other ground may be below the robot.
bool is_refused_for_ground(Verdict verdict)
{
    return verdict == Verdict::Aerial || verdict == Verdict::OffTerrain || verdict == Verdict::Submerged;
}

}  // namespace

Judgement PoseJudge::judge(const Vec3& position, bool with_hit)
{
    return judge(column_at(position.head<2>()), position, with_hit);
}

Judgement PoseJudge::judge_as_given(const Vec3& position, bool with_hit)
{
    return judge_as_given(column_at(position.head<2>()), position, with_hit);
}

Judgement PoseJudge::judge_as_given(const ColumnView& column, const Vec3& position, bool with_hit)
{
    Judgement out = judge(column, position, with_hit);
    if (!is_refused_for_ground(out.verdict)) return out;
    const std::optional<Judgement> over = judge_over_ground(column, position, false);
    if (over && over->verdict == Verdict::Valid) return *over;
    out.exact_check = over && over->exact_check;
    return out;
}

std::optional<Judgement> PoseJudge::judge_over_ground(const ColumnView& column, const Vec3& position, bool with_hit)
{
    if (!underside_) underside_.emplace(shared_.robot);
    const double above = underside_->above_origin(rotation_);
    if (above == 0) return std::nullopt;
    const Judgement out = judge(column, position, with_hit, above);
    return out.verdict == Verdict::Aerial ? std::nullopt : std::optional(out);
}

const Column& PoseJudge::column_at(const Vec2& place)
{
    read_column(shared_.map.geometry, place.x(), place.y(), column_);
    return column_;
}

void PoseJudge::judge_row(std::span<const double> x, double y, std::span<const Columns::OpenGround> ground,
                          std::span<const LayeredColumn> layered, double offset, std::span<RowVerdict> out)
{
    constexpr double decided = std::numeric_limits<double>::quiet_NaN();
    z_.resize(x.size());
    proofs_.resize(x.size());
    const Map& map = shared_.map;
    const bool are_within = map.z_limits.is_unlimited() && is_within(map, {x.front(), y, 0}) &&
                            is_within(map, {x.back(), y, 0});
    for (std::size_t i = 0; i < x.size(); ++i) {
        const auto& [terrain, water] = ground[i];
        z_[i] = terrain + offset;  // NaN without terrain
        if (!are_within && !is_within(map, {x[i], y, z_[i]}))
            out[i] = {Verdict::Outside, false};
        else if (is_submerged(terrain, water, shared_.options.max_water_depth))
            out[i] = {Verdict::Submerged, false};
        else
            continue;
        z_[i] = decided;
    }
    for (const auto& [i, column] : layered) {
        Judgement judged;
        if (std::isnan(z_[i])) continue;
        if (judge_ground(column, {x[i], y, z_[i]}, judged)) {
            if (!mask_->is_pierced(column.spans, z_[i])) continue;
            judged.verdict = Verdict::Collision;
        }
        out[i] = {judged.verdict, false};
        z_[i] = decided;
    }
    mask_->prove(x, y, z_, proofs_);
    const auto judge_one = [&](std::size_t i, const ColumnView& column) {
        Judgement judged;
        judge_collision(proofs_[i], &column, {x[i], y, z_[i]}, false, judged);
        out[i] = {judged.verdict, judged.exact_check};
        z_[i] = decided;
    };
    for (const auto& [i, column] : layered)
        if (!std::isnan(z_[i])) judge_one(i, column);
    for (std::size_t i = 0; i < x.size(); ++i) {
        if (std::isnan(z_[i])) continue;
        if (proofs_[i] == Proof::Free) {
            out[i] = {Verdict::Valid, false};
            continue;
        }
        const double terrain = ground[i].terrain;
        const Span surface{.bottom = terrain, .top = terrain, .terrain = true};
        if (mask_->is_pierced({&surface, 1}, z_[i])) proofs_[i] = Proof::Blocked;
        judge_one(i, ColumnView({&surface, 1}, {}, {}));
    }
}

Judgement PoseJudge::judge_collision(const Vec3& position)
{
    Judgement out;
    judge_collision(mask_ ? mask_->proof_of(position) : Proof::Candidate, nullptr, position, false, out);
    return out;
}

void PoseJudge::judge_collision(const ColumnView& column, const Vec3& position, bool with_hit, Judgement& out)
{
    Proof proof = Proof::Candidate;
    if (mask_ && mask_->is_pierced(column.spans, position.z()))
        proof = Proof::Blocked;
    else if (mask_)
        proof = mask_->proof_of(position);
    judge_collision(proof, &column, position, with_hit, out);
}

/// Sets the verdict on a pose whose proof is known. `column` is nullptr if it is not known.
void PoseJudge::judge_collision(Proof proof, const ColumnView* column, const Vec3& position, bool with_hit,
                                Judgement& out)
{
    if (proof == Proof::Free)
        out.verdict = Verdict::Valid;
    else if (proof == Proof::Blocked && !with_hit)
        out.verdict = Verdict::Collision;
    else
        check_exactly(column, position, with_hit, out);
}

void PoseJudge::check_exactly(const ColumnView* column, const Vec3& position, bool with_hit, Judgement& out)
{
    const TimedPart timed(shared_.options.exact_time);
    const Pose pose{position, rotation_};
    out.exact_check = true;
    if (with_hit) out.hit = checker_.find_hit(pose, column);
    const bool is_free = with_hit ? !out.hit : checker_.is_free(pose, column);
    out.verdict = is_free ? Verdict::Valid : Verdict::Collision;
}

Judge::Judge(Map map, Robot robot, const JudgeOptions& options)
    : impl_(std::make_shared<const Impl>(std::move(map), std::move(robot), options))
{
}

const Map& Judge::map() const { return impl_->map; }
const Robot& Judge::robot() const { return impl_->robot; }
const JudgeOptions& Judge::options() const { return impl_->options; }

Judgement Judge::check(const Pose& pose) const
{
    PoseJudge& judge = impl_->pose_judges.local();
    judge.set_rotation(pose.rotation);
    return judge.judge_as_given(pose.position, true);
}

bool Judge::is_valid(const Pose& pose) const
{
    PoseJudge& judge = impl_->pose_judges.local();
    judge.set_rotation(pose.rotation);
    return judge.judge_as_given(pose.position).verdict == Verdict::Valid;
}

namespace {

/// Calls make() once for a batch of poses in several threads, and then judge(index, made) for each pose of the batch.
/// Poses of a batch are near to each other.
template <class Make, class JudgeOne>
void judge_all(std::span<const Pose> poses, const RunOptions& options, const Make& make, const JudgeOne& judge_one)
{
    std::vector<Vec2> places;
    places.reserve(poses.size());
    for (const Pose& pose : poses) places.push_back(pose.position.head<2>());
    const std::vector<std::uint32_t> order = in_neighbourhoods(places);
    constexpr std::size_t batch = 256;
    parallel_for((poses.size() + batch - 1) / batch, options.threads, options.progress, [&](std::size_t b) {
        auto made = make();
        for (const std::uint32_t i : std::span(order).subspan(b * batch, std::min(batch, poses.size() - b * batch)))
            judge_one(i, made);
    });
}

}  // namespace

std::vector<Judgement> Judge::check(std::span<const Pose> poses, const RunOptions& options) const
{
    std::vector<Judgement> out(poses.size());
    judge_all(
        poses, options, [&] { return PoseJudge(*impl_, 0); },
        [&](std::uint32_t i, PoseJudge& judge) {
            judge.set_rotation(poses[i].rotation);
            out[i] = judge.judge_as_given(poses[i].position, true);
        });
    return out;
}

SettledPose Judge::settle(const Vec3& place, double yaw) const { return StandJudge(*impl_).judge(place, yaw); }

std::vector<SettledPose> Judge::settle(std::span<const Pose> poses, const RunOptions& options) const
{
    constexpr double rounding = 1e-6;  // m
    struct Thread {
        StandJudge judge;
        Underside underside;
    };
    std::vector<SettledPose> out(poses.size());
    judge_all(
        poses, options,
        [&] {
            return Thread{StandJudge(*impl_), Underside(impl_->robot)};
        },
        [&](std::uint32_t i, Thread& thread) {
            const Vec3& position = poses[i].position;
            const double yaw = yaw_of(poses[i].rotation), above = thread.underside.above_origin(poses[i].rotation);
            out[i] = thread.judge.judge(position, yaw);
            if (out[i].verdict == Verdict::Valid || above == 0) return;
            // The robot may stand over a crest that is higher than its origin. It is only let down, so the pose at
            // which it stands is not above the given one.
            SettledPose over = thread.judge.judge(position + above * Vec3::UnitZ(), yaw);
            if (over.verdict == Verdict::Valid && over.position.z() <= position.z() + rounding)
                out[i] = std::move(over);
        });
    return out;
}

namespace {

/// Returns why a place is aerial. `ground` is the one below it.
std::string aerial_reason(const Vec3& origin, const std::optional<Ground>& ground, double max_height)
{
    const std::string verdict = to_string(Verdict::Aerial);
    if (!ground) return verdict + ": no ground below the origin";
    return verdict + ": " + rounded(origin.z() - ground->height) + " m above the ground, the limit is " +
           rounded(max_height) + " m (--max-height)";
}

/// Returns a hint for an aerial place if ground is above it: the robot may have sunk into that ground. If there is also
/// ground below the place, higher ground than `limit` (m) is no hint.
std::string ground_above(const Map& map, const Vec3& origin, const std::optional<Ground>& below, double limit)
{
    const Column column = column_at(map.geometry, origin.x(), origin.y());
    const std::span<const double> layers = heights_within(column.layers, map.z_limits);
    const auto next = std::find_if(layers.rbegin(), layers.rend(), [&](double z) { return z > origin.z(); });
    if (next == layers.rend() || (below && *next - origin.z() > limit)) return {};
    return "; the next ground is " + rounded(*next - origin.z()) + " m above the origin";
}

/// Returns a hint for an aerial pose if ground is above its origin and below the robot: why it is not valid over it.
std::string below_robot(const Judge& judge, const Pose& pose)
{
    PoseJudge& pose_judge = judge.impl().pose_judges.local();
    pose_judge.set_rotation(pose.rotation);
    const Column column = column_at(judge.map().geometry, pose.position.x(), pose.position.y());
    const std::optional<Judgement> over = pose_judge.judge_over_ground(ColumnView(column), pose.position, true);
    if (!over) return {};
    return "; with the ground below the robot, " + rounded(over->ground->height - pose.position.z()) +
           " m above the origin, it is " + judge.describe(pose, *over);
}

}  // namespace

std::string Judge::describe(const Pose& pose, const Judgement& judgement) const
{
    const std::string verdict = to_string(judgement.verdict);
    switch (judgement.verdict) {
    case Verdict::Outside: return verdict + " the map's bounds";
    case Verdict::Aerial: {
        const double max_height = impl_->options.max_height;
        const std::string hint = below_robot(*this, pose);
        return aerial_reason(pose.position, judgement.ground, max_height) +
               (hint.empty() ? ground_above(impl_->map, pose.position, judgement.ground, max_height) : hint);
    }
    case Verdict::OffTerrain:
        return verdict + ": the ground is " + impl_->map.geometry.parts()[judgement.ground->part].name;
    case Verdict::Collision: return judgement.hit ? verdict + " with " + name_of(*judgement.hit, impl_->map) : verdict;
    default: return verdict;
    }
}

double auto_min_stability(const Robot& robot)
{
    constexpr double share = 0.002;
    const Bounds box = robot.bounds();
    return share * (box.max - box.min).head<2>().maxCoeff();
}

std::string Judge::describe(const SettledPose& pose) const
{
    const auto degrees = [](double angle) { return rounded(angle * 180 / std::numbers::pi) + " degrees"; };
    const StandLimits& limits = impl_->options.stand;
    const std::string verdict = to_string(pose.verdict),
                      what = pose.hit ? name_of(*pose.hit, impl_->map) : std::string();
    switch (pose.verdict) {
    case Verdict::OffTerrain:
        if (const auto obstacle = pose.hit ? pose.hit : obstacle_below(pose.contacts))
            return verdict + ": it comes to rest on " + name_of(*obstacle, impl_->map);
        break;
    case Verdict::Collision:
        if (!pose.has_pose) return verdict + ": it has no room to settle" + (pose.hit ? ", because of " + what : "");
        if (!pose.hit) return verdict + ": its pose belongs to a higher layer";
        return verdict + ": it is inside " + what;
    case Verdict::Steep:
        return verdict + ": it tilts by " + degrees(pose.tilt) + ", the limit is " + degrees(limits.max_slope);
    case Verdict::Unstable:
        if (pose.falls)
            return verdict + ": it tips over: it finds no rest within " + degrees(limits.max_tilt) +
                   " (--max-tilt); where it would have to balance, its margin is " + rounded(pose.margin) + " m";
        if (pose.slides) return verdict + ": it slides: " + friction_reason(pose, impl_->robot, limits.friction);
        return verdict + ": its margin is " + rounded(pose.margin) + " m, the limit is " +
               rounded(*limits.min_stability) + " m";
    case Verdict::Obstructed: return verdict + (pose.hit ? " by " + what : "") + obstruction(pose, limits);
    case Verdict::Aerial: {
        const Vec3 origin = pose.has_pose ? pose.lifted(limits.lift).position : pose.position;
        const double max_height = impl_->options.max_height;
        return aerial_reason(origin, pose.ground, max_height) +
               ground_above(impl_->map, origin, pose.ground, max_height) +
               (pose.has_pose ? "; this is where it rests, raised by --lift" : "");
    }
    default: break;
    }
    return describe(Pose{.position = pose.position}, judgement_of(pose));
}

Judgement judgement_of(const SettledPose& pose) { return {pose.verdict, pose.ground, pose.hit, pose.exact_check}; }

std::string name_of(const CollisionHit& hit, const Map& map)
{
    return hit.part == CollisionHit::occupancy ? "occupancy" : map.geometry.parts()[hit.part].name;
}

}  // namespace spawnfield
