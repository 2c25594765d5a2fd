#include "settle/settle.h"

#include "base/polygon2.h"
#include "geometry/geometry_impl.h"
#include "settle/minimax.h"
#include "settle/touch.h"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace spawnfield {
namespace {

constexpr double contact_tolerance = 1e-9;  // m: touches that are at most this much lower than the highest are contacts
/// The margin also counts wheels and feet that are at most this far above the ground, m: real ones give way by so much,
/// and the vertices of real meshes are not more precise.
constexpr double contact_gap = 1e-3;
constexpr double tie = 1e-12;                           // m: touches of one height, up to rounding
constexpr double smallest_turn = 1e-11;                 // rad
constexpr double first_turn = 0.1, largest_turn = 0.3;  // rad: limits of one step
constexpr double seen_below = 0.2;  // m: touches that much below the highest may soon carry the robot
constexpr int max_turns = 300;
/// Where the mass is exactly above an edge between two ways to rest, the robot turns as if its centre of mass were this
/// much farther back and to the right, m.
const Vec3 preference(-1e-7, -0.5e-7, 0);

/// A part of the scene near a robot, relative to the place where the robot is let down.
struct NearSolid {
    Convex body;
    Bounds bounds;
    std::uint32_t part;
    Label label;
};

/// A touch between a part of the robot and a solid.
struct RestTouch {
    Touch touch;
    Vec2 rise;  ///< derivative of touch.height by roll and pitch, m/rad
    std::size_t part, solid;
};

/// The rotation of a robot.
struct Attitude {
    Mat3 rotation;
    Vec3 roll_axis, pitch_axis;  ///< about which the robot turns if its roll or its pitch changes

    Attitude(const Vec2& angles, double yaw)
        : rotation(rotation_from_rpy(angles[0], angles[1], yaw)), roll_axis(rotation.col(0)),
          pitch_axis(-std::sin(yaw), std::cos(yaw), 0)
    {
    }

    /// Returns the derivative by roll and pitch of how much the robot must be raised so that its point `r` stays above
    /// a plane with this slope (see Touch).
    Vec2 rise(const Vec3& r, const Vec3& slope) const
    {
        const Vec3 arm = r.cross(slope);
        return {-roll_axis.dot(arm), -pitch_axis.dot(arm)};
    }
};

/// The robot with a roll and a pitch, lowered onto the solids below it.
struct Lowered {
    Vec2 angles = Vec2::Zero();  ///< roll and pitch, rad
    double z = 0;                ///< of its origin, m
    std::vector<RestTouch> touches;
    bool has_room = false;
};

/// Returns the angle between the robot's z axis and the vertical for this roll and pitch, rad.
double tilt_of(const Vec2& angles)
{
    return std::acos(std::clamp(std::cos(angles[0]) * std::cos(angles[1]), -1.0, 1.0));
}

/// Returns the distance of a point to the boundary of a convex polygon (counterclockwise, 3 or more corners); negative
/// if it is outside.
double margin_of(const Polygon2& polygon, const Vec2& point)
{
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < polygon.size(); ++k) {
        const Vec2 &p = polygon[k], along = polygon[k + 1 < polygon.size() ? k + 1 : 0] - p;
        const double t = std::clamp(along.dot(point - p) / along.squaredNorm(), 0.0, 1.0);
        nearest = std::min(nearest, (point - p - t * along).norm());
    }
    return contains(polygon, point) ? nearest : -nearest;
}

}  // namespace

double Rest::tilt() const { return tilt_of({roll, pitch}); }

/// One robot on its way down.
class Settler::Descent {
public:
    Descent(const Settler& settler, std::vector<NearSolid> solids, double yaw)
        : settler_(settler), solids_(std::move(solids)), yaw_(yaw)
    {
    }

    Rest run()
    {
        at_ = level();
        if (!at_.has_room) return {};
        balance_ = at_;
        double limit = first_turn;
        for (int step = 0; step < max_turns; ++step) {
            if (at_.touches.empty() || tilt_of(at_.angles) > settler_.options_.max_tilt)
                return rest(balance_, Rest::State::Falling);
            if (stands()) {
                level_contacts();
                return rest(at_, Rest::State::Standing);
            }
            const Vec2 aim = falling_turn(limit);
            if (aim.norm() < smallest_turn) break;
            const auto [share, is_kink] = way_to_kink(aim);
            const Vec2 turn = share * aim;
            Lowered next = turned(turn);
            // The mass must sink at least by a part of what the touches let expect.
            const double sinks = at_.z - next.z - drift_.dot(turn),
                         expected = at_.z - expected_z(turn) - drift_.dot(turn);
            if (!next.has_room || sinks < 0.25 * expected - tie) {
                limit = turn.lpNorm<Eigen::Infinity>() / 4;
                continue;
            }
            limit = std::min(largest_turn, 2 * std::max(limit, turn.lpNorm<Eigen::Infinity>()));
            at_ = std::move(next);
            if (is_kink && !at_.touches.empty()) land(turn);
        }
        return rest(at_, Rest::State::Falling);
    }

private:
    Mat3 rotation(const Vec2& angles) const { return rotation_from_rpy(angles[0], angles[1], yaw_); }

    Vec3 mass_center(const Vec2& angles) const { return rotation(angles) * (settler_.mass_center_ + preference); }

    std::vector<Convex> parts(const Attitude& attitude) const
    {
        std::vector<Convex> out;
        for (const Convex& part : settler_.parts_) out.push_back(moved(part, {Vec3::Zero(), attitude.rotation}));
        return out;
    }

    /// Returns the level robot at the lowest height where it has room above its layer.
    Lowered level() const
    {
        std::vector<Interval> blocked;
        const std::vector<Convex> robot = parts(Attitude(Vec2::Zero(), yaw_));
        Convex layer;
        layer.points = {Vec3::Zero()};
        double z = -std::numeric_limits<double>::infinity(), top = z;
        for (const Convex& part : robot) {
            const Bounds bounds = part.bounds();
            top = std::max(top, bounds.max.z());
            if (const auto around = blocked_heights(part, layer)) z = std::max(z, around->top);
            for (const NearSolid& solid : solids_)
                if (bounds.meets(solid.bounds, 2))
                    if (const auto heights = blocked_heights(part, solid.body)) blocked.push_back(*heights);
        }
        if (!std::isfinite(z)) z = -top;  // nothing of the robot is above its origin
        std::sort(blocked.begin(), blocked.end(),
                  [](const Interval& l, const Interval& r) { return l.bottom < r.bottom; });
        for (const Interval& heights : blocked)
            if (heights.bottom < z + contact_tolerance) z = std::max(z, heights.top);
        if (z > settler_.options_.max_height) return {};
        return lowered(Vec2::Zero(), z, contact_tolerance);
    }

    /// Lowers the robot onto the solids that are not higher than about z. It has no room if a solid reaches from below
    /// z to more than `rise` above it: a wall. Solids above are ceilings.
    Lowered lowered(const Vec2& angles, double z, double rise) const
    {
        Lowered out;
        out.angles = angles;
        out.z = -std::numeric_limits<double>::infinity();
        double ceiling = std::numeric_limits<double>::infinity();
        const Attitude attitude(angles, yaw_);
        const std::vector<Convex> robot = parts(attitude);
        std::vector<Touch> found;
        for (std::size_t p = 0; p < robot.size(); ++p) {
            const Bounds bounds = robot[p].bounds();
            for (std::size_t s = 0; s < solids_.size(); ++s) {
                const Bounds& around = solids_[s].bounds;
                if (!bounds.meets(around, 2) ||
                    around.max.z() - bounds.min.z() < std::max(out.z, z - rise) - seen_below)
                    continue;
                found.clear();
                add_touches(robot[p], solids_[s].body, found);
                double highest = -std::numeric_limits<double>::infinity();
                for (const Touch& touch : found) highest = std::max(highest, touch.height);
                if (highest > z + rise) {
                    const auto blocked = blocked_heights(robot[p], solids_[s].body);
                    if (blocked && blocked->bottom < z - rise) return out;
                    if (blocked) ceiling = std::min(ceiling, blocked->bottom);
                    continue;
                }
                out.z = std::max(out.z, highest);
                for (const Touch& touch : found)
                    out.touches.push_back({touch, attitude.rise(touch.body, touch.slope), p, s});
            }
        }
        if (out.touches.empty()) out.z = z;  // nothing is below it
        out.has_room = out.z <= ceiling;
        return out;
    }

    double expected_z(const Vec2& turn) const
    {
        double out = -std::numeric_limits<double>::infinity();
        for (const RestTouch& t : at_.touches) out = std::max(out, t.touch.height + t.rise.dot(turn));
        return out;
    }

    /// Returns the touch that carries the robot when it begins to turn: the highest one, and of equal ones the one that
    /// rises most.
    const RestTouch& carrier(const Vec2& turn) const
    {
        const RestTouch* out = nullptr;
        for (const RestTouch& t : at_.touches)
            if (t.touch.height >= at_.z - tie && (!out || t.rise.dot(turn) > out->rise.dot(turn))) out = &t;
        return *out;
    }

    Lowered turned(const Vec2& turn) const
    {
        return lowered(at_.angles + turn, expected_z(turn), 4 * settler_.reach_ * turn.norm() + contact_tolerance);
    }

    /// Returns the share of a turn up to which the touch that carries the robot does so, and whether another one takes
    /// over there.
    std::pair<double, bool> way_to_kink(const Vec2& turn) const
    {
        const RestTouch& carried = carrier(turn);
        double share = 1;
        for (const RestTouch& t : at_.touches) {
            const double faster = (t.rise - carried.rise).dot(turn);
            if (faster <= 0) continue;
            const double there = (carried.touch.height - t.touch.height) / faster;
            if (there * turn.norm() >= smallest_turn) share = std::min(share, there);
        }
        return {share, share < 1};
    }

    /// Turns the robot a little, forth or back along its last turn, until two touches are equally high there.
    void land(const Vec2& turn)
    {
        for (int step = 0; step < 8; ++step) {
            const double share = nearest_kink(turn);
            if (std::abs(share) * turn.norm() < smallest_turn) return;
            Lowered next = turned(share * turn);
            if (!next.has_room || next.touches.empty()) return;
            at_ = std::move(next);
        }
    }

    /// Returns how far, as a share of `turn`, it is to the nearest place along it where another touch is as high as the
    /// one that carries the robot; negative: back.
    double nearest_kink(const Vec2& turn) const
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
    RestTouch contact_at(const Vec2& place) const
    {
        const std::vector<RestTouch> found = contacts(at_);
        const auto distance = [&](const RestTouch& t) { return (t.touch.body.head<2>() - place).squaredNorm(); };
        return *std::min_element(found.begin(), found.end(),
                                 [&](const RestTouch& l, const RestTouch& r) { return distance(l) < distance(r); });
    }

    /// Turns the standing robot until three contacts around its mass are equally high up to rounding.
    void level_contacts()
    {
        for (int step = 0; step < 4; ++step) {
            const Polygon2 polygon = support_polygon(at_);
            const Vec2 mass = mass_center(at_.angles).head<2>();
            std::size_t k = 1;
            while (k + 2 < polygon.size() && cross(polygon[k + 1] - polygon[0], mass - polygon[0]) > 0) ++k;
            if (polygon.size() < 3) return;
            const std::array corners{contact_at(polygon[0]), contact_at(polygon[k]), contact_at(polygon[k + 1])};
            Eigen::Matrix2d slopes;
            Vec2 rises;
            for (int row = 0; row < 2; ++row) {
                const RestTouch& other = corners[std::size_t(row) + 1];
                slopes.row(row) = (other.rise - corners[0].rise).transpose();
                rises[row] = corners[0].touch.height - other.touch.height;
            }
            const Vec2 turn = slopes.inverse() * rises;
            if (!(turn.norm() > 1e-15) || !(turn.norm() < 1e-6)) return;
            Lowered next = turned(turn);
            if (!next.has_room || next.touches.empty()) return;
            at_ = std::move(next);
        }
    }

    /// Returns the turn with which the mass sinks most, at most `limit` in roll and pitch. The mass sinks as it does
    /// while the robot turns about its contacts, which friction holds: as if all touching surfaces were level. But x
    /// and y stay the same, so on a slope the robot also rises or sinks because the contacts move along it. `drift_` is
    /// the gradient of the mass's height without that. It depends on how the weight is spread over the touches, which
    /// the linear program returns; so that is repeated a few times.
    Vec2 falling_turn(double limit)
    {
        const Attitude attitude(at_.angles, yaw_);
        const Vec3 mass = attitude.rotation * (settler_.mass_center_ + preference);
        // How the mass rises with roll and pitch while the robot turns about one of its points.
        const auto rise_of_mass = [&](const Vec3& about) -> Vec2 {
            return attitude.rise(mass - about, -Vec3::UnitZ());
        };
        Vec2 turn = Vec2::Zero();
        for (int round = 0; round < 4; ++round) {
            std::vector<MinimaxRow> rows;
            for (const RestTouch& t : at_.touches) rows.push_back({t.touch.height, t.rise + drift_});
            const Minimax lowest = lowest_of_highest(rows, limit);
            turn = lowest.at;
            Vec2 drift = Vec2::Zero();
            double weights = 0;
            for (std::size_t k = 0; k < 3; ++k) {
                if (lowest.rows[k] < 0) continue;
                const RestTouch& t = at_.touches[std::size_t(lowest.rows[k])];
                drift += lowest.weights[k] * (rise_of_mass(t.touch.body) - t.rise);
                weights += lowest.weights[k];
            }
            if ((drift / weights - drift_).norm() < 1e-12) break;
            drift_ = drift / weights;
        }
        return turn;
    }

    /// Returns the touches that carry the robot.
    static std::vector<RestTouch> contacts(const Lowered& at, double tolerance = contact_tolerance)
    {
        std::vector<RestTouch> out;
        for (const RestTouch& t : at.touches)
            if (t.touch.height >= at.z - tolerance) out.push_back(t);
        return out;
    }

    static Polygon2 support_polygon(const Lowered& at, double tolerance = contact_tolerance)
    {
        Polygon2 points;
        for (const RestTouch& t : contacts(at, tolerance)) points.push_back(t.touch.body.head<2>());
        return convex_hull(std::move(points));
    }

    /// Returns whether the robot stands. Remembers a pose in which it would only have to balance.
    bool stands()
    {
        const Polygon2 polygon = support_polygon(at_);
        if (polygon.size() < 3) return false;
        balance_ = at_;
        return margin_of(polygon, mass_center(at_.angles).head<2>()) >= 0;
    }

    Rest rest(const Lowered& at, Rest::State state) const
    {
        Rest out;
        out.state = state;
        out.z = at.z;
        out.roll = at.angles[0];
        out.pitch = at.angles[1];
        const Polygon2 polygon = support_polygon(at, contact_gap);
        const Vec2 mass = (rotation(at.angles) * settler_.mass_center_).head<2>();
        out.margin = polygon.size() < 3 ? 0 : margin_of(polygon, mass);
        for (const RestTouch& t : contacts(at, contact_gap))
            out.contacts.push_back({t.touch.body + at.z * Vec3::UnitZ(), t.touch.slope.normalized(), t.part,
                                    solids_[t.solid].part, solids_[t.solid].label});
        return out;
    }

    const Settler& settler_;
    const std::vector<NearSolid> solids_;
    const double yaw_;
    Lowered at_, balance_;
    Vec2 drift_ = Vec2::Zero();  ///< see falling_turn()
};

Settler::Settler(const Geometry& geometry, const Robot& robot, const Options& options)
    : geometry_(geometry), options_(options), mass_center_(mass_center_of(robot)), reach_(0)
{
    for (const RobotPart& part : robot.parts) {
        parts_.push_back(convex_of(part));
        const Convex& body = parts_.back();
        for (const Vec3& point : body.points) reach_ = std::max(reach_, point.norm() + body.ball + body.disc);
    }
}

Rest Settler::settle(double x, double y, double yaw, double layer) const
{
    const Vec3 origin(x, y, layer);
    std::vector<NearSolid> solids;
    const Geometry::Impl& geometry = geometry_.impl();
    geometry.visit_in(x - reach_, y - reach_, x + reach_, y + reach_, [&](const Tile& tile, std::uint32_t element) {
        if (tile.label(element) == Label::Water || tile.label(element) == Label::Ignore) return;
        NearSolid solid{{}, {}, tile.part(element), tile.label(element)};
        if (tile.is_triangle(element)) {
            std::array<Vec3, 3> corners = tile.corners(element);
            for (Vec3& corner : corners) corner -= origin;
            solid.body = convex_of(corners);
        } else {
            solid.body = moved(convex_of(tile.primitive(element).shape()), {-origin, Mat3::Identity()});
        }
        solid.bounds = solid.body.bounds();
        solids.push_back(std::move(solid));
    });
    Rest out = Descent(*this, std::move(solids), yaw).run();
    out.z += layer;
    for (RestContact& contact : out.contacts) contact.point += origin;
    return out;
}

}  // namespace spawnfield
