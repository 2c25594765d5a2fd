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
#include <numbers>
#include <span>
#include <utility>

namespace spawnfield {

/// A part of the scene near a robot, relative to the place where the robot is let down.
struct NearSolid {
    std::optional<TouchTriangle> triangle;  ///< if it is a triangle that is not steep
    Convex body;                            ///< otherwise
    Bounds bounds;
    std::uint32_t part = 0;
    Label label = Label::Terrain;
    WantedTouches wanted;  ///< of robots that lie on the ground of all solids
};

namespace {

constexpr double contact_tolerance = 1e-9;  // m: touches that are at most this much lower than the highest are contacts
/// The margin also counts wheels and feet that are at most this far above the ground, m: real ones give way by so much,
/// and the vertices of real meshes are not more precise.
constexpr double contact_gap = 1e-3;
constexpr double rest_tolerance = 1e-7;  // m: the same, if the mass does not sink any more
/// A robot also rests on a line, for example on two wheels with its mass below the axle, if its mass is this near above
/// that line, m, and does not sink any more.
constexpr double line_tolerance = 1e-6;
constexpr double tie = 1e-12;                                               // m: touches of one height, up to rounding
constexpr double smallest_turn = 1e-11;                                     // rad
constexpr double first_turn = 0.1, least_limit = 0.01, largest_turn = 0.3;  // rad: limits of one step
/// Touches that are farther below the highest one than this cannot carry the robot after the next step, m: at most
/// `most_seen` (of large robots, `large_seen` times the robot's size), and `seen_share` times the limit of the step and
/// the robot's size.
constexpr double most_seen = 0.2, large_seen = 0.3, seen_share = 4;
constexpr double straight_turn = 0.1;  // rad, see descend()
constexpr double whole_turn = 1e-6;    // a part of a turn that differs from all of it by this share is all of it
constexpr double exact_turn = 1e-3;    // rad: after a turn of this size, the touches are where they were expected
constexpr int max_turns = 300;
constexpr double same_drift = 1e-9;  // m: much less than `preference`, which would have no effect otherwise
// A robot whose mass is near an edge of the support polygon may rock onto another contact. It still stands there if it
// moves by no more than this.
constexpr double rocking_rise = 0.05;                         // m
constexpr double rocking_turn = 3 * std::numbers::pi / 180;   // rad
constexpr double rolling_turn = 10 * std::numbers::pi / 180;  // rad: the same if it rolls on a line of contacts
constexpr int max_rockings = 6;
/// Where the mass is exactly above an edge between two ways to rest, the robot turns as if its centre of mass were this
/// much farther back and to the right, m.
const Vec3 preference(-1e-7, -0.5e-7, 0);

/// Returns a height of the robot above which this part of it cannot touch the solid from above.
double highest_possible(const PlacedBody& part, const NearSolid& solid)
{
    constexpr double rounding = 1e-9;  // m
    double out = solid.bounds.max.z() - part.bounds.min.z();
    if (solid.triangle) out = std::min(out, height_bound(part, *solid.triangle));
    return out + rounding;
}

/// Marks the edge that two triangles share. Corner k of the first one is corner same[k] of the second one, -1: none.
void cover_edge(NearSolid& first, NearSolid& second, const std::array<int, 3>& same)
{
    constexpr double flat = 1e-13;  // m
    const auto edge_without = [](int corner) { return std::uint8_t(1 << (corner + 1) % 3); };
    const int alone = int(std::find(same.begin(), same.end(), -1) - same.begin()),
              other_alone = 3 - same[std::size_t(alone + 1) % 3] - same[std::size_t(alone + 2) % 3];
    second.wanted.covered_edges |= edge_without(other_alone);
    const auto &points = first.triangle->points, &others = second.triangle->points;
    const Vec3 &shared = points[std::size_t(alone + 1) % 3], &own = points[std::size_t(alone)],
               &other = others[std::size_t(other_alone)];
    const Vec2 edge = (points[std::size_t(alone + 2) % 3] - shared).head<2>();
    const bool is_overhang = !(cross(edge, (own - shared).head<2>()) * cross(edge, (other - shared).head<2>()) < 0);
    const bool is_ridge = first.triangle->normal.dot(other) - first.triangle->height < -flat;
    if (!is_overhang && !is_ridge) first.wanted.covered_edges |= edge_without(alone);
}

/// Marks what nothing comes to lie on from above, unless it also lies on another triangle: corners and edges that
/// several triangles share, in all but one of them; and edges in a valley or in a plane, in both triangles. Leaves out
/// triangles that may be walls, because what touches them is examined one by one.
void cover_shared(std::vector<NearSolid>& solids)
{
    constexpr std::size_t most = 48;  // of more triangles, the comparisons take longer than they save
    constexpr double steepest = 2;
    if (solids.size() > most) return;
    const auto is_same = [](const Vec3& p, const Vec3& q) {  // mostly, the first comparison decides
        return p.x() == q.x() && p.y() == q.y() && p.z() == q.z();
    };
    const auto is_ground = [](const NearSolid& solid) {
        return solid.triangle && solid.triangle->normal.head<2>().squaredNorm() <= steepest * steepest;
    };
    for (std::size_t i = 0; i < solids.size(); ++i) {
        if (!is_ground(solids[i])) continue;
        for (std::size_t j = i + 1; j < solids.size(); ++j) {
            if (!is_ground(solids[j]) || !solids[i].bounds.meets(solids[j].bounds)) continue;
            const auto &first = solids[i].triangle->points, &second = solids[j].triangle->points;
            std::array<int, 3> same{-1, -1, -1};  // the corner of the second one that is corner k of the first
            int count = 0;
            for (int k = 0; k < 3; ++k)
                for (int l = 0; l < 3; ++l)
                    if (is_same(first[std::size_t(k)], second[std::size_t(l)])) {
                        same[std::size_t(k)] = l;
                        solids[j].wanted.covered_points |= std::uint8_t(1 << l);
                        ++count;
                    }
            if (count == 2) cover_edge(solids[i], solids[j], same);
        }
    }
}

/// Returns a height of the robot below which this part of it cannot touch the solid from below.
double lowest_possible(const PlacedBody& part, const NearSolid& solid)
{
    return solid.bounds.min.z() - part.bounds.max.z();
}

double highest_of(const std::vector<Touch>& touches)
{
    double out = -std::numeric_limits<double>::infinity();
    for (const Touch& touch : touches) out = std::max(out, touch.height);
    return out;
}

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
    /// a plane with this normal (see Touch).
    Vec2 rise(const Vec3& r, const Vec3& normal) const
    {
        const Vec3 arm = r.cross(normal);
        return {-roll_axis.dot(arm), -pitch_axis.dot(arm)};
    }
};

/// The robot with a roll and a pitch, lowered onto the solids below it.
struct Lowered {
    Vec2 angles = Vec2::Zero();  ///< roll and pitch, rad
    double z = 0;                ///< of its origin, m
    std::vector<RestTouch> touches;
    bool has_room = false;
    std::optional<std::uint32_t> wall = {};  ///< if it has no room: the part of the scene
    /// Height of the origin from which on a solid above the robot touches it, m. Solids that touch it only above `seen`
    /// do not count.
    double ceiling = std::numeric_limits<double>::infinity(), seen = ceiling;
};

/// Returns the angle between the robot's z axis and the vertical for this roll and pitch, rad.
double tilt_of(const Vec2& angles)
{
    return std::acos(std::clamp(std::cos(angles[0]) * std::cos(angles[1]), -1.0, 1.0));
}

/// The edge of a polygon that is nearest to a point.
struct NearestEdge {
    double distance = std::numeric_limits<double>::infinity();  ///< negative: the point is outside
    Vec2 outward = Vec2::Zero();                                ///< normal of the edge, of length 1
    Vec2 from = Vec2::Zero(), to = Vec2::Zero();                ///< its ends
};

/// Returns the nearest edge of a convex polygon (counterclockwise, 2 or more corners; two are a line with two sides).
NearestEdge nearest_edge(const Polygon2& polygon, const Vec2& point)
{
    NearestEdge out;
    for (std::size_t k = 0; k < polygon.size(); ++k) {
        const Vec2 &p = polygon[k], &q = polygon[k + 1 < polygon.size() ? k + 1 : 0], along = q - p;
        const double t = std::clamp(along.dot(point - p) / along.squaredNorm(), 0.0, 1.0),
                     distance = (point - p - t * along).norm();
        if (distance < out.distance) out = {distance, edge_normal(p, q).normalized(), p, q};
    }
    if (!contains(polygon, point)) out.distance = -out.distance;
    return out;
}

/// Returns a convex polygon without corners that are there only by rounding: those very near to another corner or to
/// the line between their neighbours.
Polygon2 clear_corners(const Polygon2& polygon)
{
    constexpr double shortest_edge = 1e-6, straight = 1e-9;  // m
    Polygon2 apart, out;
    for (const Vec2& corner : polygon)
        if (apart.empty() ||
            ((corner - apart.back()).norm() >= shortest_edge && (corner - apart.front()).norm() >= shortest_edge))
            apart.push_back(corner);
    for (std::size_t k = 0; k < apart.size(); ++k) {
        const Vec2 &before = apart[(k + apart.size() - 1) % apart.size()], &after = apart[(k + 1) % apart.size()];
        if (std::abs(cross(after - before, apart[k] - before)) > straight * (after - before).norm())
            out.push_back(apart[k]);
    }
    return out;
}

/// Returns a segment from the middle of the smaller body to a near place in the other one. It ends inside both.
Convex segment_between(const Convex& body, const Convex& other)
{
    const Bounds a = body.bounds(), b = other.bounds();
    if ((a.max - a.min).norm() > (b.max - b.min).norm()) return segment_between(other, body);
    constexpr double inside = 0.5;  // of a ball, a cylinder or a capsule, these points are in the inside
    const auto middle_of = [](const Convex& convex) -> Vec3 {
        Vec3 sum = Vec3::Zero();
        for (const Vec3& point : convex.points) sum += point;
        return sum / double(convex.points.size());
    };
    const auto is_in_other = [&](const Vec3& point) {
        return std::all_of(other.planes.begin(), other.planes.end(),
                           [&](const Convex::Plane& plane) { return plane.normal.dot(point) < plane.offset; });
    };
    const Vec3 from = middle_of(body), middle = middle_of(other), half = inside / 2 * (b.max - b.min);
    Vec3 to = from.cwiseMax(middle - half).cwiseMin(middle + half);
    for (int step = 0; step < 10 && !is_in_other(to); ++step) to = (to + middle) / 2;
    Convex out;
    out.points = {from, to};
    out.edges = {{0, 1}};
    return out;
}

/// Returns segments that join parts of a robot between which there is a gap, so that all parts are one body. Uses the
/// parts' bounds. Source: Prim, Shortest connection networks and some generalizations, 1957.
std::vector<Convex> joints_of(const std::vector<Convex>& parts)
{
    constexpr double least_gap = 1e-9;  // m
    const auto gap = [](const Bounds& a, const Bounds& b) {
        return (a.min - b.max).cwiseMax(b.min - a.max).cwiseMax(0).norm();
    };
    std::vector<Bounds> bounds;
    for (const Convex& part : parts) bounds.push_back(part.bounds());
    std::vector<std::size_t> left, nearest(parts.size(), 0);  // nearest: of the parts that are joined already
    for (std::size_t p = 1; p < parts.size(); ++p) left.push_back(p);
    std::vector<Convex> out;
    while (!left.empty()) {
        const auto gap_of = [&](std::size_t p) { return gap(bounds[p], bounds[nearest[p]]); };
        const auto next = std::min_element(left.begin(), left.end(),
                                           [&](std::size_t p, std::size_t q) { return gap_of(p) < gap_of(q); });
        const std::size_t joined = *next;
        left.erase(next);
        if (gap_of(joined) > least_gap) out.push_back(segment_between(parts[joined], parts[nearest[joined]]));
        for (const std::size_t p : left)
            if (gap(bounds[p], bounds[joined]) < gap_of(p)) nearest[p] = joined;
    }
    return out;
}

}  // namespace

double Rest::tilt() const { return tilt_of({roll, pitch}); }

/// Robots on their way down, one after another.
class Settler::Descent {
public:
    explicit Descent(const Settler& settler) : settler_(settler)
    {
        for (const Convex& part : settler_.parts_) parts_.push_back({.body = part});
    }

    /// Lets the robot down between solids, which are relative to its place.
    Rest run(std::span<const NearSolid> solids, double yaw)
    {
        solids_ = solids;
        yaw_ = yaw;
        mass_ = settler_.mass_center_ + preference;
        drift_ = Vec2::Zero();
        limit_ = first_turn;
        level(at_);
        const double drop_z = settler_.options_.wants_drop && at_.has_room ? ceiling_above(at_) : at_.z;
        Rest::State state = Rest::State::Blocked;
        if (at_.has_room) {
            const Lowered start = at_;
            state = descend(0);
            if (state == Rest::State::Falling && is_stuck_) {  // again, without the stops in which it is stuck
                const Lowered stuck = std::exchange(at_, start);
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

private:
    Mat3 rotation(const Vec2& angles) const { return rotation_from_rpy(angles[0], angles[1], yaw_); }

    Vec3 mass_center(const Vec2& angles) const { return rotation(angles) * mass_; }

    /// Turns the robot until it stands or falls, or until a wall stops it. Up to `straight` (rad), it turns at once to
    /// where the touches let it rest, and may miss a rest before that. Otherwise, it stops at each new contact. At 0,
    /// it also stops there exactly, so that balance_ is known if it falls. Sets is_stuck_ if it is falling only because
    /// it found no turn with which the mass sinks.
    Rest::State descend(double straight)
    {
        balance_ = at_.angles;
        balance_z_ = at_.z;
        limit_ = first_turn;
        is_stuck_ = false;
        std::optional<std::uint32_t> wall;
        for (int step = 0; step < max_turns; ++step) {
            if (at_.touches.empty() || tilt_of(at_.angles) > settler_.options_.max_tilt) {
                lower(balance_, balance_z_, contact_tolerance, at_);
                return Rest::State::Falling;
            }
            if (stands()) return Rest::State::Standing;
            const Vec2 aim = falling_turn();
            if (aim.norm() < smallest_turn) break;
            bool is_to_kink = false;
            const Vec2 turn = aim.norm() <= straight ? aim : first_part(aim, is_to_kink);
            // A long turn may miss a rest just below the largest tilt.
            if (turn.norm() > exact_turn && tilt_of(at_.angles + turn) > settler_.options_.max_tilt) {
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
            const double sinks = at_.z - next_.z - drift_.dot(turn),
                         expected = at_.z - expected_z(turn) - drift_.dot(turn);
            if (!next_.has_room || sinks < 0.25 * expected - tie) {
                wall = next_.has_room ? std::nullopt : next_.wall;
                limit_ = turn.lpNorm<Eigen::Infinity>() / 4;
                continue;
            }
            wall.reset();
            std::swap(at_, next_);
            if (straight == 0 && is_to_kink && !at_.touches.empty()) land(turn);
        }
        at_.wall = wall;
        if (wall) return Rest::State::Blocked;
        // The mass does not sink any more, so the touches around it are equally high up to rounding.
        is_stuck_ = !is_balanced();
        return is_stuck_ ? Rest::State::Falling : Rest::State::Standing;
    }

    /// Returns whether the mass is above the contacts, up to rounding. They may form a line.
    bool is_balanced() const
    {
        const Polygon2 polygon = support_polygon(at_, rest_tolerance);
        const Vec2 mass = mass_center(at_.angles).head<2>();
        if (polygon.size() < 2) return false;
        return contains(polygon, mass) || -nearest_edge(polygon, mass).distance <= line_tolerance;
    }

    /// If the mass were beyond the nearest edge of the support polygon, the robot would turn about that edge. If it
    /// then comes to rest after little motion, it stands on the contacts of both poses. Adds them to a rest with a
    /// margin that is too small. If it only rolls on the contacts that it has, they carry the mass at any place up to
    /// there, so the edge is moved outwards to there.
    void rock(Rest& rest)
    {
        const Lowered rested = at_;
        const double enough = settler_.options_.min_stability;
        Polygon2 polygon = support_polygon(rested, contact_gap);
        const bool is_line = width(polygon) < enough;
        const Vec3 mass = settler_.mass_center_;
        const Mat3 rotated = rotation(rested.angles);
        for (int k = 0; k < max_rockings && polygon.size() >= 2; ++k) {
            const NearestEdge edge = nearest_edge(polygon, (rotated * mass).head<2>());
            if (edge.distance >= enough - contact_tolerance) break;
            const Vec3 beyond(edge.outward.x(), edge.outward.y(), 0);
            mass_ = mass + rotated.transpose() * (enough * beyond);
            at_ = rested;
            drift_ = Vec2::Zero();
            const Rest::State state = descend(straight_turn);
            if (state == Rest::State::Falling || !is_balanced()) break;  // next to a wall, it may be balanced, too
            std::vector<RestContact> more = rest_contacts(at_);
            std::erase_if(more, [&](const RestContact& contact) {
                return std::any_of(rest.contacts.begin(), rest.contacts.end(), [&](const RestContact& other) {
                    return (other.point - contact.point).head<2>().norm() < rocking_rise;
                });
            });
            const bool is_rolling = is_line || (more.empty() && width(support_polygon(at_, contact_gap)) < enough);
            if (is_far(at_, rested, is_rolling ? rolling_turn : rocking_turn)) break;
            for (const RestContact& contact : more) {
                rest.contacts.push_back(contact);
                polygon.push_back(contact.point.head<2>());
            }
            if (more.empty()) {
                const Vec2 outwards = (enough - edge.distance) * edge.outward;
                polygon.insert(polygon.end(), {edge.from + outwards, edge.to + outwards});
            }
            polygon = convex_hull(std::move(polygon));
        }
        if (polygon.size() >= 2) rest.margin = nearest_edge(polygon, (rotated * mass).head<2>()).distance;
    }

    bool is_far(const Lowered& a, const Lowered& b, double turn) const
    {
        const double trace = (rotation(a.angles).transpose() * rotation(b.angles)).trace();
        return std::abs(a.z - b.z) > rocking_rise || (trace - 1) / 2 < std::cos(turn);
    }

    /// Turns the parts of the robot.
    const std::vector<PlacedBody>& parts(const Mat3& rotation)
    {
        for (std::size_t p = 0; p < parts_.size(); ++p) place(parts_[p], settler_.parts_[p], rotation);
        return parts_;
    }

    /// A part of the robot and a solid.
    struct Pair {
        double possible;  ///< see highest_possible()
        std::uint32_t part, solid;
        // Only used by level(), NaN: not known yet
        double height = std::numeric_limits<double>::quiet_NaN();  ///< of the highest touch
        double bottom = std::numeric_limits<double>::quiet_NaN();  ///< the pair touches from this height on
        bool is_ceiling = false;
    };

    /// Sets pairs_ to the parts of the robot and the solids that overlap seen from above, except solids that are above
    /// the robot even if its origin is at height z. The pair that may be the highest is the first.
    void find_pairs(double z)
    {
        pairs_.clear();
        std::size_t first = 0;
        for (std::uint32_t p = 0; p < parts_.size(); ++p)
            for (std::uint32_t s = 0; s < solids_.size(); ++s) {
                if (!parts_[p].bounds.meets(solids_[s].bounds, 2) || lowest_possible(parts_[p], solids_[s]) > z)
                    continue;
                pairs_.push_back({highest_possible(parts_[p], solids_[s]), p, s});
                if (pairs_.back().possible > pairs_[first].possible) first = pairs_.size() - 1;
            }
        if (!pairs_.empty()) std::swap(pairs_[0], pairs_[first]);
    }

    /// Sets touches_ to those of a part of the robot with a solid, and returns the highest of them.
    double touch(const PlacedBody& part, const NearSolid& solid, const WantedTouches& wanted = {})
    {
        touches_.clear();
        if (solid.triangle)
            add_touches(part, *solid.triangle, touches_, wanted);
        else
            add_touches(part.body, solid.body, touches_, wanted);
        return highest_of(touches_);
    }

    /// Returns the lowest point of the robot on the vertical line through its origin, relative to the origin.
    std::optional<double> underside()
    {
        static const Convex origin = convex_of(Vec3(0, 0, 0));
        touches_.clear();
        for (const PlacedBody& part : parts_) add_touches(part.body, origin, touches_);
        return touches_.empty() ? std::nullopt : std::optional(-highest_of(touches_));
    }

    double top() const
    {
        double out = -std::numeric_limits<double>::infinity();
        for (const PlacedBody& part : parts_) out = std::max(out, part.bounds.max.z());
        return out;
    }

    /// Lets the level robot down to the lowest height where it has room above its layer.
    void level(Lowered& out)
    {
        parts(rotation(Vec2::Zero()));
        out = {};
        double z = -underside().value_or(top());
        find_pairs(settler_.options_.max_height);
        const auto raise = [&](double height, std::size_t solid) {
            z = height;
            out.wall = solids_[solid].part;
            for (Pair& pair : pairs_) pair.is_ceiling &= pair.bottom >= z + contact_tolerance;
        };
        // The pair that touches highest decides, unless it is a ceiling: then the next one.
        for (;;) {
            while (const auto between = solid_between_parts(z)) raise(between->height, between->solid);
            Pair* const highest = highest_above(z);
            if (highest == nullptr) break;
            highest->bottom = bottom_of(*highest, highest->height, z + contact_tolerance);
            highest->is_ceiling = highest->bottom >= z + contact_tolerance;
            if (!highest->is_ceiling) raise(highest->height, highest->solid);
        }
        if (z > settler_.options_.max_height) return;
        lower(Vec2::Zero(), z, contact_tolerance, out);
        if (const auto between = solid_between_parts(out.z)) {  // the parts find no hold above it
            out.has_room = false;
            out.wall = solids_[between->solid].part;
        }
    }

    struct Between {
        double height;  ///< of the level robot's origin, m
        std::size_t solid;
    };

    /// Returns a solid that is between two parts of the level robot at height z, and the height at which it is below
    /// both. A sheet may be there without touching a part: a foot would be below the ground.
    std::optional<Between> solid_between_parts(double z)
    {
        for (const Convex& joint : settler_.joints_) {
            PlacedBody placed{.body = joint};
            place(placed, joint, rotation(Vec2::Zero()));
            for (std::size_t s = 0; s < solids_.size(); ++s) {
                const Bounds& solid = solids_[s].bounds;
                if (!placed.bounds.meets(solid, 2) || solid.max.z() - placed.bounds.min.z() <= z ||
                    solid.min.z() - placed.bounds.max.z() >= z + contact_tolerance)
                    continue;
                const double highest = touch(placed, solids_[s], {.min_height = z});
                if (highest <= z + contact_tolerance) continue;
                if (blocked_heights(placed.body, solids_[s])->bottom < z + contact_tolerance)
                    return Between{highest, s};
            }
        }
        return std::nullopt;
    }

    /// Returns the pair whose highest touch is higher than z and higher than those of the others, without ceilings;
    /// nullptr if there is none.
    Pair* highest_above(double z)
    {
        Pair* out = nullptr;
        for (Pair& pair : pairs_) {
            if (pair.is_ceiling || pair.possible <= z) continue;
            if (std::isnan(pair.height))
                pair.possible = pair.height = touch(parts_[pair.part], solids_[pair.solid], {.min_height = z});
            if (pair.height <= z) continue;
            z = pair.height;
            out = &pair;
        }
        return out;
    }

    /// Returns the height from which on a pair touches, up to its highest touch. If that is below `enough`, returns any
    /// height between both.
    double bottom_of(const Pair& pair, double highest, double enough)
    {
        const Convex& body = parts_[pair.part].body;
        const NearSolid& solid = solids_[pair.solid];
        // Below its highest touch, the part overlaps the solid at least by its thickness there: mostly enough.
        touch(parts_[pair.part], solid, {.min_height = highest - contact_tolerance});
        for (const Touch& touch : touches_) {
            const auto top = upper_end(body, touch.point.x(), touch.point.y());
            const double bottom = top ? touch.point.z() + touch.height - *top : highest;
            if (bottom < enough) return bottom;
        }
        return blocked_heights(body, solid)->bottom;
    }

    static std::optional<Interval> blocked_heights(const Convex& body, const NearSolid& solid)
    {
        return spawnfield::blocked_heights(body, solid.triangle ? convex_of(solid.triangle->points) : solid.body);
    }

    /// Lowers the robot onto the solids that are not higher than about z. It has no room if a solid reaches from below
    /// z to more than `rise` above it: a wall.
    void lower(const Vec2& angles, double z, double rise, Lowered& out)
    {
        out.angles = angles;
        out.z = -std::numeric_limits<double>::infinity();
        out.touches.clear();
        out.has_room = false;
        out.wall.reset();
        out.ceiling = std::numeric_limits<double>::infinity();
        out.seen = z + rise;
        const double below = std::min(std::max(most_seen, large_seen * settler_.reach_),
                                      seen_share * settler_.reach_ * limit_);
        const Attitude attitude(angles, yaw_);
        parts(attitude.rotation);
        find_pairs(out.seen);
        for (const Pair& pair : pairs_) {
            const double least = std::max(out.z, z - rise) - below;
            if (pair.possible < least) continue;
            const PlacedBody& part = parts_[pair.part];
            const NearSolid& solid = solids_[pair.solid];
            WantedTouches wanted = solid.wanted;
            wanted.min_height = least;
            const double highest = touch(part, solid, wanted);
            if (highest > out.seen) {
                const double bottom = bottom_of(pair, highest, z - rise);
                if (bottom < out.ceiling) {
                    out.ceiling = bottom;
                    out.wall = solid.part;
                }
                if (bottom < z - rise) return;
                continue;
            }
            out.z = std::max(out.z, highest);
            for (const Touch& touch : touches_)
                out.touches.push_back({touch, attitude.rise(touch.point, touch.normal), pair.part, pair.solid});
        }
        if (out.touches.empty()) out.z = z;  // nothing is below it
        out.has_room = out.z <= out.ceiling;
    }

    /// Returns the height of the robot's origin at which the robot, raised without turning, meets something. parts_
    /// must have its attitude.
    double ceiling_above(const Lowered& at)
    {
        double out = at.ceiling;
        find_pairs(at.z + settler_.options_.headroom);
        for (const Pair& pair : pairs_) {
            const PlacedBody& part = parts_[pair.part];
            const NearSolid& solid = solids_[pair.solid];
            const double lowest = lowest_possible(part, solid);
            if (lowest <= at.seen || lowest >= out || pair.possible <= at.z) continue;
            if (touch(part, solid, {.min_height = at.z}) <= at.z + contact_tolerance) continue;
            out = std::min(out, blocked_heights(part.body, solid)->bottom);
        }
        return out;
    }

    /// Returns the share of a turn, which leads beyond the largest tilt, with which the robot tilts so much.
    double share_to_largest_tilt(const Vec2& turn) const
    {
        double low = 0, high = 1;
        for (int step = 0; step < 10; ++step) {
            const double middle = (low + high) / 2;
            (tilt_of(at_.angles + middle * turn) > settler_.options_.max_tilt ? high : low) = middle;
        }
        return low;
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

    /// Sets next_ to the robot after a turn.
    void turn_by(const Vec2& turn)
    {
        lower(at_.angles + turn, expected_z(turn), 4 * settler_.reach_ * turn.norm() + contact_tolerance, next_);
    }

    /// Returns the part of the turn `aim` (of falling_turn()) during which the touches that carry the robot at its
    /// beginning do so, before another one takes over; all of it if none does. At its end, these touches and the new
    /// one are equally high.
    Vec2 first_part(const Vec2& aim, bool& is_to_kink)
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
    std::optional<Vec2> leveled(const Vec2& turn, std::span<const RestTouch* const> touches)
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
    /// predict. Returns the predicted one if it finds no other.
    double exact_kink(const Vec2& turn, double predicted, const RestTouch& carried, const RestTouch& next)
    {
        double share = predicted, change = (next.rise - carried.rise).dot(turn), last = 0, last_difference = 0;
        for (int step = 0; step < 6; ++step) {
            const Mat3 rotated = rotation(at_.angles + share * turn);
            const auto height = touch_height(next, rotated), carried_height = touch_height(carried, rotated);
            if (!height || !carried_height) return predicted;
            const double difference = *height - *carried_height;
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
    std::optional<double> touch_height(const RestTouch& old, const Mat3& rotated)
    {
        const Convex& body = settler_.parts_[old.part];
        const NearSolid& solid = solids_[old.solid];
        if (solid.triangle && old.touch.kind != Touch::Kind::Other)
            return height_after(old.touch, body, rotated, *solid.triangle);
        place(parts_[old.part], body, rotated);
        touch(parts_[old.part], solid, {.min_height = old.touch.height - most_seen});
        const Vec3 point = rotated * (rotation(at_.angles).transpose() * old.touch.point);
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

    /// Turns the robot a little, forth or back along its last turn, until two touches are equally high there.
    void land(const Vec2& turn)
    {
        for (int step = 0; step < 8; ++step) {
            const double share = nearest_kink(turn);
            if (std::abs(share) * turn.norm() < smallest_turn) return;
            turn_by(share * turn);
            if (!next_.has_room || next_.touches.empty()) return;
            std::swap(at_, next_);
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
    const RestTouch& contact_at(const Vec2& place) const
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
    void level_contacts()
    {
        for (int step = 0; step < 4; ++step) {
            const Polygon2 polygon = support_polygon(at_);
            const Vec2 mass = mass_center(at_.angles).head<2>();
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

    /// Returns the turn with which the mass sinks most, at most `limit_` in roll and pitch. The mass sinks as it does
    /// while the robot turns about its contacts, which friction holds: as if all touching surfaces were level. But x
    /// and y stay the same, so on a slope the robot also rises or sinks because the contacts move along it. `drift_` is
    /// the gradient of the mass's height without that. It depends on how the weight is spread over the touches, which
    /// the linear program returns; so that is repeated a few times.
    Vec2 falling_turn()
    {
        const Attitude attitude(at_.angles, yaw_);
        const Vec3 mass = attitude.rotation * mass_;
        // How the mass rises with roll and pitch while the robot turns about one of its points.
        const auto rise_of_mass = [&](const Vec3& about) -> Vec2 {
            return attitude.rise(mass - about, -Vec3::UnitZ());
        };
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

    static Polygon2 support_polygon(const Lowered& at, double tolerance = contact_tolerance)
    {
        Polygon2 points;
        points.reserve(at.touches.size());
        for (const RestTouch& t : at.touches)
            if (t.touch.height >= at.z - tolerance) points.push_back(t.touch.point.head<2>());
        return convex_hull(std::move(points));
    }

    /// Returns whether the robot stands. Remembers a pose in which it would only have to balance.
    bool stands()
    {
        const auto is_contact = [&](const RestTouch& t) { return t.touch.height >= at_.z - contact_tolerance; };
        if (std::count_if(at_.touches.begin(), at_.touches.end(), is_contact) < 3) return false;
        const Polygon2 polygon = support_polygon(at_);
        if (polygon.size() < 3) return false;
        balance_ = at_.angles;
        balance_z_ = at_.z;
        return contains(polygon, mass_center(at_.angles).head<2>());
    }

    std::vector<RestContact> rest_contacts(const Lowered& at) const
    {
        std::vector<RestContact> out;
        for (const RestTouch& t : at.touches)
            if (t.touch.height >= at.z - contact_gap)
                out.push_back({t.touch.point + at.z * Vec3::UnitZ(), t.touch.normal.normalized(), t.part,
                               solids_[t.solid].part, solids_[t.solid].label});
        return out;
    }

    /// Returns the angle by which the robot must be turned about an edge of the support polygon until its mass is above
    /// the edge: the smallest of all edges.
    double tip_over(const Polygon2& polygon, const std::vector<RestContact>& contacts, const Vec3& mass) const
    {
        std::vector<Vec3> corners;
        for (const Vec2& corner : clear_corners(polygon))
            for (const RestContact& contact : contacts)
                if (contact.point.head<2>() == corner) {
                    corners.push_back(contact.point);
                    break;
                }
        if (corners.size() < 3) return 0;  // a line
        double out = std::numbers::pi / 2;
        for (std::size_t k = 0; k < corners.size(); ++k) {
            const Vec3 &p = corners[k], side = corners[k + 1 < corners.size() ? k + 1 : 0] - p;
            const Vec3 along = side.normalized();
            const Vec3 up = Vec3::UnitZ() - along.z() * along, inward = up.cross(along), arm = mass - p;
            out = std::min(out, std::atan2(arm.dot(inward), arm.dot(up)));
        }
        return out;
    }

    /// Returns the smallest vertical distance of the solids from the parts of the robot that do not touch them.
    double belly(const std::vector<RestContact>& contacts)
    {
        double out = std::numeric_limits<double>::infinity();
        for (std::size_t p = 0; p < parts_.size(); ++p) {
            if (std::any_of(contacts.begin(), contacts.end(), [&](const RestContact& c) { return c.part == p; }))
                continue;
            for (const NearSolid& solid : solids_) {
                if (!parts_[p].bounds.meets(solid.bounds, 2) || at_.z - highest_possible(parts_[p], solid) >= out)
                    continue;
                const double highest = touch(parts_[p], solid, {.min_height = at_.z - out});
                if (highest <= at_.z) out = std::min(out, at_.z - highest);
            }
        }
        return std::isfinite(out) ? out : 0;
    }

    Rest rest(Rest::State state)
    {
        parts(rotation(at_.angles));
        Rest out;
        out.state = state;
        out.wall = at_.wall;
        out.z = at_.z;
        out.roll = at_.angles[0];
        out.pitch = at_.angles[1];
        if (state == Rest::State::Blocked) return out;
        const Polygon2 polygon = support_polygon(at_, contact_gap);
        const Vec3 mass = rotation(at_.angles) * settler_.mass_center_;
        out.headroom = ceiling_above(at_) - at_.z;
        out.contacts = rest_contacts(at_);
        out.belly = belly(out.contacts);
        out.underside = underside().value_or(0);
        if (polygon.size() == 1) out.margin = -(mass.head<2>() - polygon[0]).norm();
        if (polygon.size() >= 2) out.margin = nearest_edge(polygon, mass.head<2>()).distance;
        if (polygon.size() < 3) return out;
        out.tip_over = tip_over(polygon, out.contacts, mass + at_.z * Vec3::UnitZ());
        return out;
    }

    const Settler& settler_;
    std::span<const NearSolid> solids_;
    double yaw_ = 0;
    Vec3 mass_ = Vec3::Zero();          ///< the centre of mass in the robot's frame, moved a little
    std::vector<PlacedBody> parts_;     ///< of the robot, at the attitude that was examined last
    std::vector<Pair> pairs_;           ///< at the attitude that was examined last
    std::vector<Touch> touches_;        ///< of the pair that was examined last
    std::vector<MinimaxPlane> planes_;  ///< see falling_turn()
    Lowered at_, next_;
    Vec2 balance_ = Vec2::Zero();  ///< angles at which it last touched the ground with an area
    double balance_z_ = 0;
    double limit_ = first_turn;  ///< of the next step in roll and pitch, rad
    bool is_stuck_ = false;      ///< see descend()
    Vec2 drift_ = Vec2::Zero();  ///< see falling_turn()
    Minimax aim_;                ///< the last result of falling_turn(), with the touches that carry the robot there
};

Settler::Settler(const Geometry& geometry, const Robot& robot, const Options& options)
    : geometry_(geometry), options_(options), mass_center_(mass_center_of(robot)), reach_(0)
{
    for (const RobotPart& part : robot.parts) {
        parts_.push_back(convex_of(part));
        const Convex& body = parts_.back();
        for (const Vec3& point : body.points) reach_ = std::max(reach_, point.norm() + body.ball + body.disc);
    }
    joints_ = joints_of(parts_);
}

/// How the robot rests on a horizontal plane at z = 0. It depends only on the yaw.
struct Settler::FlatRest {
    double yaw;
    Rest rest;
    std::vector<Bounds> parts;  ///< of the robot at rest, m
};

struct Settler::Workspace::Kept {
    std::optional<Descent> descent = {};
    std::vector<FlatRest> flats = {};
    Vec3 origin = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
    std::vector<NearSolid> solids = {};  ///< relative to `origin`
};

Settler::Workspace::Workspace() : kept_(std::make_unique<Kept>()) {}

Settler::Workspace::~Workspace() = default;

/// Sets `out` to the solids that the robot may meet, relative to the origin.
void Settler::find_solids_near(const Vec3& origin, std::vector<NearSolid>& out) const
{
    out.clear();
    const double x = origin.x(), y = origin.y();
    geometry_.impl().visit_in(x - reach_, y - reach_, x + reach_, y + reach_, [&](const Tile& tile, auto element) {
        if (tile.label(element) == Label::Water || tile.label(element) == Label::Ignore) return;
        NearSolid& solid = out.emplace_back();
        solid.part = tile.part(element);
        solid.label = tile.label(element);
        if (tile.is_triangle(element)) {
            std::array<Vec3, 3> corners = tile.corners(element);
            for (Vec3& corner : corners) corner -= origin;
            for (const Vec3& corner : corners) solid.bounds.extend(corner);
            solid.triangle = touch_triangle_of(corners);
            if (!solid.triangle) solid.body = convex_of(corners);
        } else {
            solid.body = moved(convex_of(tile.primitive(element).shape()), {-origin, Mat3::Identity()});
            solid.bounds = solid.body.bounds();
        }
    });
    cover_shared(out);
}

Settler::FlatRest Settler::flat_rest(double yaw, Descent& descent) const
{
    const double far = 10 * reach_;
    NearSolid plane;
    plane.triangle = touch_triangle_of({Vec3(-far, -far, 0), Vec3(2 * far, -far, 0), Vec3(-far, 2 * far, 0)});
    for (const Vec3& corner : plane.triangle->points) plane.bounds.extend(corner);
    FlatRest out{yaw, descent.run({&plane, 1}, yaw), {}};
    const Mat3 rotation = rotation_from_rpy(out.rest.roll, out.rest.pitch, yaw);
    for (const Convex& part : parts_) {
        Bounds& bounds = out.parts.emplace_back(moved(part, {Vec3::Zero(), rotation}).bounds());
        bounds.min.z() += out.rest.z;
        bounds.max.z() += out.rest.z;
    }
    for (const Convex& joint : joints_) out.parts.push_back(moved(joint, {Vec3(0, 0, out.rest.z), rotation}).bounds());
    return out;
}

/// Returns how the robot rests on a plane at this yaw. Keeps it for the next robots.
const Settler::FlatRest& Settler::flat_rest(double yaw, Workspace& workspace) const
{
    constexpr std::size_t most = 64;  // no rule has more headings (HeadingRule::most)
    std::vector<FlatRest>& flats = workspace.kept_->flats;
    const auto found = std::find_if(flats.begin(), flats.end(), [&](const FlatRest& flat) { return flat.yaw == yaw; });
    if (found != flats.end()) return *found;
    if (flats.size() == most) flats.clear();
    return flats.emplace_back(flat_rest(yaw, *workspace.kept_->descent));
}

/// Returns the rest on ground that is horizontal below all contacts, and equally high to the bit, if no other solid is
/// near enough to touch the robot or to be a ceiling. So the way down over a plane and over this ground is the same.
std::optional<Rest> Settler::rest_on_flat_ground(double yaw, Workspace& workspace) const
{
    const std::vector<NearSolid>& solids = workspace.kept_->solids;
    constexpr double same_layer = 1e-9;  // m
    const NearSolid* ground = nullptr;
    const auto is_level = [](const NearSolid& solid) {
        return solid.triangle && solid.triangle->normal.head<2>().isZero(0);
    };
    for (const NearSolid& solid : solids)
        if (is_level(solid) && std::abs(solid.triangle->height) <= same_layer) ground = &solid;
    if (ground == nullptr) return std::nullopt;
    const FlatRest& flat = flat_rest(yaw, workspace);
    if (flat.rest.state != Rest::State::Standing) return std::nullopt;
    const double z = ground->triangle->height;
    const auto is_ground = [&](const NearSolid& solid) { return is_level(solid) && solid.triangle->height == z; };
    for (const NearSolid& solid : solids) {
        if (is_ground(solid) && solid.label == ground->label) continue;
        if (!is_ground(solid) && solid.bounds.max.z() <= z) continue;
        for (const Bounds& part : flat.parts)
            if (part.meets(solid.bounds, 2) && solid.bounds.min.z() - part.max.z() - z <= options_.headroom)
                return std::nullopt;
    }
    Rest out = flat.rest;
    out.z += z;
    out.drop_z += z;
    for (RestContact& contact : out.contacts) {
        const auto carries = [&](const NearSolid& solid) {
            return is_ground(solid) && solid.triangle->is_over(contact.point);
        };
        const auto below = std::find_if(solids.begin(), solids.end(), carries);
        if (below == solids.end()) return std::nullopt;
        contact.point.z() += z;
        contact.ground = below->part;
        contact.label = below->label;
    }
    return out;
}

Rest Settler::settle(double x, double y, double yaw, double layer, Workspace& workspace) const
{
    Workspace::Kept& kept = *workspace.kept_;
    if (!kept.descent) kept.descent.emplace(*this);
    const Vec3 origin(x, y, layer);
    if (kept.origin != origin) {
        find_solids_near(origin, kept.solids);
        kept.origin = origin;
    }
    std::optional<Rest> rest = rest_on_flat_ground(yaw, workspace);
    if (!rest) rest = kept.descent->run(kept.solids, yaw);
    rest->z += layer;
    rest->drop_z += layer;
    for (RestContact& contact : rest->contacts) contact.point += origin;
    return *std::move(rest);
}

Rest Settler::settle(double x, double y, double yaw, double layer) const
{
    Workspace workspace;
    return settle(x, y, yaw, layer, workspace);
}

}  // namespace spawnfield
