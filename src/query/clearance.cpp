#include "query/clearance.h"

#include "base/bits.h"
#include "base/polygon2.h"
#include "geometry/geometry_impl.h"
#include "settle/element_body.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace spawnfield {
namespace {

constexpr double precise = 1e-9;  // m: shifts are not improved by less than this
constexpr double level = 1e-12;   // m: points that are not higher or lower than this lie at height 0

Vec2 nearest_on_segment(const Vec2& a, const Vec2& b)
{
    const Vec2 way = b - a;
    const double squared = way.squaredNorm();
    return squared > 0 ? Vec2(a + std::clamp(-a.dot(way) / squared, 0.0, 1.0) * way) : a;
}

/// Returns false also if the origin is on an edge, or nearly.
bool has_origin_inside(const Vec2& a, const Vec2& b, const Vec2& c)
{
    constexpr double rounding = 1e-13;  // m2
    const double ab = cross(a, b), bc = cross(b, c), ca = cross(c, a);
    return (ab > rounding && bc > rounding && ca > rounding) || (ab < -rounding && bc < -rounding && ca < -rounding);
}

/// Returns the point of the convex hull of these points that is nearest to the origin.
Vec2 nearest_in_hull(const std::vector<Vec2>& points)
{
    Vec2 a = points.front(), b = a, nearest = a;
    for (std::size_t step = 0; step < 4 * points.size(); ++step) {
        const auto farther = [&](const Vec2& p, const Vec2& q) { return p.dot(nearest) < q.dot(nearest); };
        const Vec2 c = *std::min_element(points.begin(), points.end(), farther);
        if (c.dot(nearest) >= nearest.squaredNorm() * (1 - 1e-14)) break;
        if (has_origin_inside(a, b, c)) return Vec2::Zero();
        const Vec2 on_a = nearest_on_segment(a, c), on_b = nearest_on_segment(b, c);
        const bool is_a = on_a.squaredNorm() < on_b.squaredNorm();
        (is_a ? b : a) = c;
        const Vec2 found = is_a ? on_a : on_b;
        if (!(found.squaredNorm() < nearest.squaredNorm())) break;
        nearest = found;
    }
    return nearest;
}

/// Points of a convex set, and where their hull meets the plane z = 0.
class SlicedHull {
public:
    void add(const Vec3& point)
    {
        for (const Vec3& other : points_) add_crossing(point, other);
        if (std::abs(point.z()) <= level) crossings_.push_back(point.head<2>());
        points_.push_back(point);
    }

    bool has(const Vec3& point) const { return std::find(points_.begin(), points_.end(), point) != points_.end(); }
    bool is_sliced() const { return !crossings_.empty(); }
    Vec2 nearest() const { return nearest_in_hull(crossings_); }

    /// Returns a slope w with which no point of the hull is nearer than the nearest one, in the direction (u, w), where
    /// u is the direction of that one. `distance` is that of the nearest one.
    double slope_at(const Vec2& u, double distance) const
    {
        double low = -std::numeric_limits<double>::infinity(), high = -low;
        for (const Vec3& point : points_) {
            const double missing = distance - u.dot(point.head<2>());
            if (point.z() > level) low = std::max(low, missing / point.z());
            if (point.z() < -level) high = std::min(high, missing / point.z());
        }
        return low > high ? (low + high) / 2 : std::clamp(0.0, low, high);  // low is above high by rounding only
    }

private:
    void add_crossing(const Vec3& a, const Vec3& b)
    {
        if (std::abs(a.z()) <= level || std::abs(b.z()) <= level || (a.z() > 0) == (b.z() > 0)) return;
        crossings_.push_back((a + a.z() / (a.z() - b.z()) * (b - a)).head<2>());
    }

    std::vector<Vec3> points_;
    std::vector<Vec2> crossings_;
};

/// Returns a lower limit of the horizontal distance; infinity if one box is higher than all of the other.
double distance_of_boxes(const Bounds& a, const Bounds& b)
{
    const Vec3 gap = (a.min - b.max).cwiseMax(b.min - a.max).cwiseMax(0);
    return gap.z() > 0 ? std::numeric_limits<double>::infinity() : gap.head<2>().norm();
}

}  // namespace

double horizontal_distance(const Convex& a, const Convex& b, double most)
{
    constexpr int most_steps = 100;
    const auto least = [&](const Vec3& way) -> Vec3 { return b.support(-way) - a.support(way); };
    SlicedHull hull;
    hull.add(least(Vec3::UnitZ()));
    hull.add(least(-Vec3::UnitZ()));
    if (!hull.is_sliced()) return std::numeric_limits<double>::infinity();
    double distance = 0;
    for (int step = 0; step < most_steps; ++step) {
        const Vec2 nearest = hull.nearest();
        distance = nearest.norm();
        if (distance <= precise) return 0;
        const Vec2 u = nearest / distance;
        const Vec3 way(u.x(), u.y(), hull.slope_at(u, distance));
        const Vec3 point = least(way);
        const double lower_limit = point.dot(way);
        if (lower_limit > most) return std::numeric_limits<double>::infinity();
        // If the farthest point is known already, only rounding could make the distance smaller.
        if (lower_limit >= distance - precise || hull.has(point)) break;
        hull.add(point);
    }
    return distance;
}

ClearanceMeter::ClearanceMeter(const Geometry& geometry, const Robot& robot) : geometry_(geometry)
{
    for (const RobotPart& part : robot.parts) parts_.push_back(convex_of(part));
}

std::vector<Convex> ClearanceMeter::parts_at(const Mat3& rotation) const
{
    std::vector<Convex> out;
    for (const Convex& part : parts_) out.push_back(moved(part, {Vec3::Zero(), rotation}));
    return out;
}

double ClearanceMeter::clearance_at(const Pose& pose, Nearest* neighbour) const
{
    constexpr double first_reach = most / 16;
    // Elements that are farther away than the nearest one by at most this are measured, too. So the clearance is the
    // least of the same distances, in whichever order they are measured.
    constexpr double tie = 2 * precise;
    const std::vector<Convex> parts = parts_at(pose.rotation);
    std::vector<Bounds> boxes;
    Bounds robot;
    for (const Convex& part : parts) {
        boxes.push_back(part.bounds());
        robot.extend(boxes.back().min);
        robot.extend(boxes.back().max);
    }
    double out = most;
    const auto distance_to = [&](const Convex& body, const Bounds& box) {
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t k = 0; k < parts.size(); ++k)
            if (distance_of_boxes(boxes[k], box) <= std::min(least, out) + tie)
                least = std::min(least, horizontal_distance(parts[k], body, std::min(least, out) + tie));
        return least;
    };
    const auto measure = [&](const Tile& tile, std::uint32_t element) {
        Bounds box = tile.bounds(element);
        box.min -= pose.position;
        box.max -= pose.position;
        if (!(distance_of_boxes(robot, box) <= out + tie)) return;
        Convex body = body_of(tile, element, pose.position);
        const double distance = distance_to(body, box);
        if (!(distance < out)) return;
        out = distance;
        if (neighbour != nullptr) *neighbour = {std::move(body), pose.position, true};
    };
    // Looks near the robot first: if something is there, most of what is farther away need not be looked at.
    double reach = first_reach;
    if (neighbour != nullptr && neighbour->is_known) {
        const Convex body = moved(neighbour->body, {neighbour->origin - pose.position, Mat3::Identity()});
        out = std::min(most, distance_to(body, body.bounds()) + tie);
        if (out < most) reach = out + tie;
    }
    for (;; reach *= 2) {
        const Vec3 by(reach, reach, 0);
        const Bounds near{robot.min + pose.position - by, robot.max + pose.position + by};
        geometry_.impl().visit_tiles(near, [&](const Tile& tile, const ElementBox&) {
            for_each_bit(tile.near(near), [&](std::uint32_t element) {
                if (tile.label(element) == Label::Obstacle) measure(tile, element);
            });
        });
        if (out + tie <= reach || reach >= most) return out;
    }
}

}  // namespace spawnfield
