#include "settle/descent.h"

#include "settle/support.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace spawnfield {
namespace {

constexpr double rest_tolerance = 1e-7;  // m: the same as contact_tolerance, if the mass does not sink any more
/// A robot also rests on a line, for example on two wheels with its mass below the axle, if its mass is this near above
/// that line, m, and does not sink any more.
constexpr double line_tolerance = 1e-6;
constexpr double least_limit = 0.01, largest_turn = 0.3;  // rad: limits of one step
constexpr double exact_turn = 1e-3;  // rad: after a turn of this size, the touches are where they were expected
/// After turns that are shorter than this, a wall that stops the robot is where it was met. In shorter steps, no rest
/// would be found before it, only the place of the wall more exactly.
constexpr double turn_to_wall = 1e-7;  // rad
constexpr int max_turns = 300;  // nearly all robots need less than 20; more are needed to roll along a bent valley
/// Where the mass is exactly above an edge between two ways to rest, the robot turns as if its centre of mass were this
/// much farther back and to the right, m.
const Vec3 preference(-1e-7, -0.5e-7, 0);

/// The mass is at a lowest place if it would sink by less than this share of a turn, m/rad: as `preference` may do.
constexpr double level_slope = 2e-7;

/// Returns the share of a turn at which the mass is lowest, if it sinks by `sinks` during the whole turn instead of
/// `expected`, because it sinks slower and slower: for a robot that rolls on round parts.
double lowest_of_parabola(double expected, double sinks) { return expected / (2 * (expected - sinks)); }

}  // namespace

Settler::Descent::Descent(const Settler& settler) : settler_(settler)
{
    for (const Convex& part : settler_.parts_) turned_.push_back({.body = part});
}

Rest Settler::Descent::run(std::span<const NearSolid> solids, double yaw)
{
    set_solids(solids);
    face(yaw);
    mass_ = settler_.mass_center_ + preference;
    drift_ = Vec2::Zero();
    limit_ = first_turn;
    level(at_);
    const double drop_z = settler_.options_.wants_drop && at_.has_room ? ceiling_above(at_) : at_.z;
    Rest::State state = Rest::State::Blocked;
    if (at_.has_room) {
        start_ = at_;
        state = descend(0);
        if (state == Rest::State::Falling && is_stuck_) {  // again, without the stops in which it is stuck
            const Lowered stuck = std::exchange(at_, start_);
            drift_ = Vec2::Zero();
            if (descend(straight_turn) == Rest::State::Standing)
                state = Rest::State::Standing;
            else
                at_ = stuck;
        }
    }
    if (state == Rest::State::Standing) level_contacts();
    Rest out = rest(state);
    out.drop_z = drop_z;
    if (state == Rest::State::Standing && out.margin < settler_.options_.min_stability) rock(out);
    return out;
}

/// Sets the yaw of the robot.
void Settler::Descent::face(double yaw)
{
    if (yaw_ == yaw) return;
    yaw_ = yaw;
    yaw_parts_ = CosSin(yaw);
    known_angles_.setConstant(std::numeric_limits<double>::quiet_NaN());
    placed_.setConstant(std::numeric_limits<double>::quiet_NaN());
    level_ = &level_robot(yaw);
}

Mat3 Settler::Descent::rotation(const Vec2& angles)
{
    if (angles != known_angles_) {
        known_ = rotation_from_rpy(CosSin(angles[0]), CosSin(angles[1]), yaw_parts_);
        known_angles_ = angles;
    }
    return known_;
}

/// Returns whether a robot with this rotation tilts by more than the largest tilt.
bool Settler::Descent::tilts_too_far(const Mat3& rotation) const
{
    constexpr double rounding = 1e-12;
    const double cosine = rotation(2, 2);
    return cosine <= least_cosine_ + rounding && std::acos(std::clamp(cosine, -1.0, 1.0)) > settler_.options_.max_tilt;
}

/// Returns the share of a turn, which leads beyond the largest tilt, with which the robot tilts so much.
double Settler::Descent::share_to_largest_tilt(const Vec2& turn)
{
    double low = 0, high = 1;
    for (int step = 0; step < 10; ++step) {
        const double middle = (low + high) / 2;
        (tilts_too_far(rotation(at_.angles + middle * turn)) ? high : low) = middle;
    }
    return low;
}

/// Turns the robot until it stands or falls, or until a wall stops it. Up to `straight` (rad), it turns at once to
/// where the touches let it rest, and may miss a rest before that. Otherwise, it stops at each new contact. At 0,
/// it also stops there exactly, so that balance_ is known if it falls. Sets is_stuck_ if it is falling only because
/// it found no turn with which the mass sinks.
Rest::State Settler::Descent::descend(double straight)
{
    balance_ = at_.angles;
    balance_z_ = at_.z;
    limit_ = first_turn;
    is_stuck_ = false;
    int level_turns = 0;  // in a row in which the mass did not sink, as around a lowest place
    std::optional<std::uint32_t> wall;
    for (int step = 0; step < max_turns; ++step) {
        if (at_.touches.empty() || tilts_too_far(at_.rotation)) {
            lower(balance_, balance_z_, contact_tolerance, at_);
            return Rest::State::Falling;
        }
        if (stands()) return Rest::State::Standing;
        const Vec2 aim = falling_turn();
        if (aim.norm() < smallest_turn) break;
        bool is_to_kink = false;
        const Vec2 turn = aim.norm() <= straight ? aim : first_part(aim, is_to_kink);
        // A long turn may miss a rest just below the largest tilt.
        if (turn.norm() > exact_turn && tilts_too_far(rotation(at_.angles + turn))) {
            limit_ = 0.9 * share_to_largest_tilt(turn) * turn.lpNorm<Eigen::Infinity>();
            limit_ = std::max(limit_, exact_turn / 2);
            continue;
        }
        if (straight > 0)
            limit_ = std::clamp(4 * turn.lpNorm<Eigen::Infinity>(), least_limit, largest_turn);
        else
            limit_ = std::min(largest_turn, 2 * std::max(limit_, turn.lpNorm<Eigen::Infinity>()));
        turn_by(turn);
        // The mass must sink at least by a part of what the touches let expect.
        const double sinks = at_.z - next_.z - drift_.dot(turn), expected = at_.z - expected_z(turn) - drift_.dot(turn);
        if (!next_.has_room || sinks < 0.25 * expected - tie) {
            wall = next_.has_room ? std::nullopt : next_.wall;
            const bool is_slower = next_.has_room && expected > 0;
            const double nearer = is_slower ? std::clamp(lowest_of_parabola(expected, sinks), 0.05, 0.25) : 0.25;
            limit_ = nearer * turn.lpNorm<Eigen::Infinity>();
            if (wall && turn.norm() < turn_to_wall) break;
            continue;
        }
        wall.reset();
        std::swap(at_, next_);
        level_turns = expected < std::min(4 * tie, level_slope * turn.norm()) ? level_turns + 1 : 0;
        if (level_turns == 3) break;
        if (straight == 0 && is_to_kink && !at_.touches.empty()) land(turn);
    }
    at_.wall = wall;
    if (wall) return Rest::State::Blocked;
    // The mass does not sink any more, so the touches around it are equally high up to rounding.
    is_stuck_ = !is_balanced();
    return is_stuck_ ? Rest::State::Falling : Rest::State::Standing;
}

/// Returns whether the robot stands. Remembers a pose in which it would only have to balance.
bool Settler::Descent::stands()
{
    const auto is_contact = [&](const RestTouch& t) { return t.touch.height >= at_.z - contact_tolerance; };
    if (std::count_if(at_.touches.begin(), at_.touches.end(), is_contact) < 3) return false;
    const Polygon2 polygon = support_polygon(at_);
    if (polygon.size() < 3) return false;
    balance_ = at_.angles;
    balance_z_ = at_.z;
    return contains(polygon, mass_center(at_).head<2>());
}

/// Returns whether the mass is above the contacts, up to rounding. They may form a line.
bool Settler::Descent::is_balanced() const
{
    const Polygon2 polygon = support_polygon(at_, rest_tolerance);
    const Vec2 mass = mass_center(at_).head<2>();
    if (polygon.size() < 2) return false;
    return contains(polygon, mass) || -nearest_edge(polygon, mass).distance <= line_tolerance;
}

}  // namespace spawnfield
