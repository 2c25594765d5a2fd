#include "settle/descent.h"

#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace spawnfield {
namespace {

constexpr double whole_turn = 1e-6;  // a part of a turn that differs from all of it by this share is all of it
constexpr double same_drift = 1e-9;  // m: much less than `preference`, which would have no effect otherwise

// Where a rim rolls from a face onto the edge of the face, both touches rise equally: the difference of their heights
// has a double root. Each step of Newton's method goes only half of the way to it, where a quarter of the difference is
// left.
bool is_half(double share, double of) { return std::abs(share / of - 0.5) < 0.1; }

bool is_quarter(double difference, double of) { return std::abs(difference / of - 0.25) < 0.1; }

}  // namespace

/// Returns the turn with which the mass sinks most, at most `limit_` in roll and pitch. The mass sinks as it does
/// while the robot turns about its contacts, which friction holds: as if all touching surfaces were level. But x
/// and y stay the same, so on a slope the robot also rises or sinks because the contacts move along it. `drift_` is
/// the gradient of the mass's height without that. It depends on how the weight is spread over the touches, which
/// the linear program returns; so that is repeated a few times.
Vec2 Settler::Descent::falling_turn()
{
    const Attitude attitude(at_.rotation, yaw_parts_);
    const Vec3 mass = attitude.rotation * mass_;
    // How the mass rises with roll and pitch while the robot turns about one of its points.
    const auto rise_of_mass = [&](const Vec3& about) -> Vec2 { return attitude.rise(mass - about, -Vec3::UnitZ()); };
    Vec2 turn = Vec2::Zero();
    std::optional<Minimax> before;
    for (int round = 0; round < 4; ++round) {
        planes_.clear();
        for (const RestTouch& t : at_.touches) planes_.push_back({t.touch.height, t.rise + drift_});
        const Minimax lowest = lowest_of_highest(planes_, limit_, before);
        before = lowest;
        turn = lowest.at;
        Vec2 drift = Vec2::Zero();
        double weights = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            if (lowest.planes[k] < 0) continue;
            const RestTouch& t = at_.touches[std::size_t(lowest.planes[k])];
            drift += lowest.weights[k] * (rise_of_mass(t.touch.point) - t.rise);
            weights += lowest.weights[k];
        }
        aim_ = lowest;
        const bool is_same = (drift / weights - drift_).norm() < same_drift;
        drift_ = drift / weights;
        if (is_same) break;
    }
    return turn;
}

/// Sets next_ to the robot after a turn.
void Settler::Descent::turn_by(const Vec2& turn)
{
    lower(at_.angles + turn, expected_z(turn), 4 * settler_.reach_ * turn.norm() + contact_tolerance, next_);
}

double Settler::Descent::expected_z(const Vec2& turn) const
{
    double out = -std::numeric_limits<double>::infinity();
    for (const RestTouch& t : at_.touches) out = std::max(out, t.touch.height + t.rise.dot(turn));
    return out;
}

/// Returns the touch that carries the robot when it begins to turn: the highest one, and of equal ones the one that
/// rises most.
const Settler::Descent::RestTouch& Settler::Descent::carrier(const Vec2& turn) const
{
    const RestTouch* out = nullptr;
    for (const RestTouch& t : at_.touches)
        if (t.touch.height >= at_.z - tie && (!out || t.rise.dot(turn) > out->rise.dot(turn))) out = &t;
    return *out;
}

/// Returns the part of the turn `aim` (of falling_turn()) during which the touches that carry the robot at its
/// beginning do so, before another one takes over; all of it if none does. At its end, these touches and the new
/// one are equally high.
Vec2 Settler::Descent::first_part(const Vec2& aim, bool& is_to_kink)
{
    const RestTouch& carried = carrier(aim);
    const RestTouch* next = nullptr;
    double share = 1 - whole_turn;
    for (const RestTouch& t : at_.touches) {
        const double faster = (t.rise - carried.rise).dot(aim);
        if (faster <= 0) continue;
        const double there = (carried.touch.height - t.touch.height) / faster;
        if (there * aim.norm() < smallest_turn || there >= share) continue;
        share = there;
        next = &t;
    }
    is_to_kink = next != nullptr;
    std::array<const RestTouch*, 4> touches;
    std::size_t count = 0;
    for (const int plane : aim_.planes) {
        if (plane < 0) continue;
        const RestTouch& t = at_.touches[std::size_t(plane)];
        if (!next || t.touch.height >= at_.z - contact_tolerance) touches[count++] = &t;
    }
    if (!next) return leveled(aim, {touches.data(), count}).value_or(aim);
    touches[count++] = next;
    if (count == 3)
        if (const auto turn = leveled(share * aim, {touches.data(), count})) return *turn;
    return exact_kink(aim, share, carried, *next) * aim;
}

/// Returns the turn near `turn` after which two or three touches are equally high. Of two touches, it is the
/// nearest one. Returns nothing if it is not found. Source: Broyden, A class of methods for solving nonlinear
/// simultaneous equations, 1965.
std::optional<Vec2> Settler::Descent::leveled(const Vec2& turn, std::span<const RestTouch* const> touches)
{
    if (touches.size() < 2) return std::nullopt;
    const bool is_edge = touches.size() == 2;
    Eigen::Matrix2d slopes;
    slopes.row(0) = (touches[1]->rise - touches[0]->rise).transpose();
    slopes.row(1) = is_edge ? Vec2(-slopes(0, 1), slopes(0, 0)).transpose()
                            : (touches[2]->rise - touches[0]->rise).transpose().eval();
    Vec2 out = turn, change = Vec2::Zero(), last = Vec2::Zero();
    for (int step = 0; step < 10; ++step) {
        const Mat3 rotated = rotation(at_.angles + out);
        Vec3 heights = Vec3::Zero();
        for (std::size_t k = 0; k < touches.size(); ++k) {
            const auto height = touch_height(*touches[k], rotated);
            if (!height) return std::nullopt;
            heights[int(k)] = *height;
        }
        const Vec2 rises(heights[1] - heights[0], is_edge ? 0 : heights[2] - heights[0]);
        if (step > 0) slopes += (rises - last - slopes * change) * change.transpose() / change.squaredNorm();
        last = rises;
        change = -(slopes.inverse() * rises);
        out += change;
        if (!((out - turn).norm() <= turn.norm() / 4)) return std::nullopt;
        if (change.norm() < smallest_turn) return out;
    }
    return std::nullopt;
}

/// Returns the share of a turn at which two touches are equally high, near the share that their derivatives
/// predict. Returns the predicted one if it finds no other, and twice as much at a double root.
double Settler::Descent::exact_kink(const Vec2& turn, double predicted, const RestTouch& carried, const RestTouch& next)
{
    double share = predicted, change = (next.rise - carried.rise).dot(turn), last = 0, last_difference = 0;
    for (int step = 0; step < 6; ++step) {
        const Mat3 rotated = rotation(at_.angles + share * turn);
        const auto height = touch_height(next, rotated), carried_height = touch_height(carried, rotated);
        if (!height || !carried_height) return predicted;
        const double difference = *height - *carried_height;
        if (step == 0 && is_quarter(difference, next.touch.height - carried.touch.height))
            return std::min(1.0, 2 * predicted);
        if (step > 0 && share != last) change = (difference - last_difference) / (share - last);
        const double better = share - difference / change;
        if (!(std::abs(better - predicted) <= predicted / 4)) return predicted;
        last = std::exchange(share, better);
        last_difference = difference;
        if (std::abs(share - last) * turn.norm() < smallest_turn) break;
    }
    return share;
}

/// Returns the height of a touch after the robot has turned. If the features that touch are not known: of the
/// touches between the same part and solid, that whose point of the part is nearest to the old one.
std::optional<double> Settler::Descent::touch_height(const RestTouch& old, const Mat3& rotated)
{
    const Convex& body = settler_.parts_[old.part];
    const NearSolid& solid = solids_[old.solid];
    if (solid.face && old.touch.kind != Touch::Kind::Other) return height_after(old.touch, body, rotated, *solid.face);
    place(turned_[old.part], body, rotated);
    placed_.setConstant(std::numeric_limits<double>::quiet_NaN());
    touch(turned_[old.part], solid, {.min_height = old.touch.height - most_seen});
    const Vec3 point = rotated * (at_.rotation.transpose() * old.touch.point);
    std::optional<double> out;
    double nearest = std::numeric_limits<double>::infinity();
    for (const Touch& t : touches_) {
        const double distance = (t.point - point).squaredNorm();
        if (distance >= nearest) continue;
        nearest = distance;
        out = t.height;
    }
    return out;
}

/// Turns the robot a little, forth or back along its last turn, until two touches are equally high there. It does not
/// go back by more than half of that turn: otherwise it would make the same turn again.
void Settler::Descent::land(const Vec2& turn)
{
    double last = 0, all = 0;  // shares of the turn
    for (int step = 0; step < 8; ++step) {
        double share = nearest_kink(turn);
        if (std::abs(share) * turn.norm() < smallest_turn) return;
        const bool is_double = last != 0 && is_half(share, last);
        last = is_double ? 0 : share;
        if (is_double) share *= 2;
        all += share;
        if (std::abs(all) > 0.5) return;
        turn_by(share * turn);
        if (!next_.has_room || next_.touches.empty()) return;
        std::swap(at_, next_);
    }
}

/// Returns how far, as a share of `turn`, it is to the nearest place along it where another touch is as high as the
/// one that carries the robot; negative: back.
double Settler::Descent::nearest_kink(const Vec2& turn) const
{
    const RestTouch& carried = carrier(turn);
    double nearest = std::numeric_limits<double>::infinity();
    for (const RestTouch& t : at_.touches) {
        const double faster = (t.rise - carried.rise).dot(turn);
        if (std::abs(faster) < 1e-6 * turn.norm()) continue;
        const double there = (carried.touch.height - t.touch.height) / faster;
        if (std::abs(there) < std::abs(nearest)) nearest = there;
    }
    return std::abs(nearest) < 0.5 ? nearest : 0;
}

/// Returns the contact that is nearest to a point, seen from above.
const Settler::Descent::RestTouch& Settler::Descent::contact_at(const Vec2& place) const
{
    const RestTouch* out = nullptr;
    double nearest = std::numeric_limits<double>::infinity();
    for (const RestTouch& t : at_.touches) {
        if (t.touch.height < at_.z - contact_tolerance) continue;
        const double distance = (t.touch.point.head<2>() - place).squaredNorm();
        if (distance >= nearest) continue;
        nearest = distance;
        out = &t;
    }
    return *out;
}

/// Turns the standing robot until three contacts around its mass are equally high up to rounding.
void Settler::Descent::level_contacts()
{
    for (int step = 0; step < 4; ++step) {
        const Polygon2 polygon = support_polygon(at_);
        const Vec2 mass = mass_center(at_).head<2>();
        std::size_t k = 1;
        while (k + 2 < polygon.size() && cross(polygon[k + 1] - polygon[0], mass - polygon[0]) > 0) ++k;
        if (polygon.size() < 3) return;
        const std::array corners{&contact_at(polygon[0]), &contact_at(polygon[k]), &contact_at(polygon[k + 1])};
        Eigen::Matrix2d slopes;
        Vec2 rises;
        for (int row = 0; row < 2; ++row) {
            const RestTouch& other = *corners[std::size_t(row) + 1];
            slopes.row(row) = (other.rise - corners[0]->rise).transpose();
            rises[row] = corners[0]->touch.height - other.touch.height;
        }
        if (rises.lpNorm<Eigen::Infinity>() < tie) return;
        const Vec2 turn = slopes.inverse() * rises;
        if (!(turn.norm() > 1e-15) || !(turn.norm() < 1e-6)) return;
        turn_by(turn);
        if (!next_.has_room || next_.touches.empty()) return;
        std::swap(at_, next_);
    }
}

}  // namespace spawnfield
