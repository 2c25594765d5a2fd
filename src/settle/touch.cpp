#include "settle/touch.h"

#include "base/polygon2.h"
#include "settle/minimax.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

namespace spawnfield {
namespace {

constexpr double steepest = 1e5;         ///< largest slope of a touching surface; a steeper one is a wall
constexpr double rounding = 1e-12;       // m
constexpr double parallel = 1e-12;       // of the product of lengths: sine of the angle between parallel edges
constexpr int max_steps = 500;           // of the general method
constexpr std::size_t most_planes = 12;  // kept from step to step

/// The lower or the upper end of a vertical line in a polyhedron.
struct End {
    double z;
    Vec3 normal;  ///< of the face there, outwards
};

/// Returns the lower end (sign -1) or the upper end (sign 1) of the vertical line through (x, y) in a polyhedron, if
/// the line meets it.
std::optional<End> end_of(const Convex& body, double x, double y, double sign)
{
    double low = -std::numeric_limits<double>::infinity(), high = -low;
    const Convex::Plane *lowest = nullptr, *highest = nullptr;
    for (const Convex::Plane& plane : body.planes) {
        const double rest = plane.offset - plane.normal.x() * x - plane.normal.y() * y;  // >= normal.z * z
        if (std::abs(plane.normal.z()) * steepest < 1) {
            if (rest < -rounding) return std::nullopt;
            continue;
        }
        const double z = rest / plane.normal.z();
        if (plane.normal.z() > 0 && z < high) {
            high = z;
            highest = &plane;
        }
        if (plane.normal.z() < 0 && z > low) {
            low = z;
            lowest = &plane;
        }
    }
    const Convex::Plane* const face = sign > 0 ? highest : lowest;
    if (face == nullptr || low > high + rounding * steepest) return std::nullopt;
    return End{sign > 0 ? high : low, face->normal};
}

Touch touch_at(double height, const Vec3& body, const Vec3& normal) { return {height, body, normal / normal.z()}; }

/// Returns the height of a polyhedron's top at the x and y of a point, if it is on the face with this plane.
std::optional<double> height_on(const Convex::Plane& plane, const Convex& ground, const Vec3& point)
{
    if (plane.normal.z() * steepest < 1) return std::nullopt;
    const double z = (plane.offset - plane.normal.head<2>().dot(point.head<2>())) / plane.normal.z();
    const auto top = end_of(ground, point.x(), point.y(), 1);
    return top && top->z >= z - 1e-9 ? std::optional(z) : std::nullopt;
}

double highest_point(const Convex& body)
{
    double out = -std::numeric_limits<double>::infinity();
    for (const Vec3& point : body.points) out = std::max(out, point.z());
    return out;
}

double lowest_point(const Convex& body)
{
    double out = std::numeric_limits<double>::infinity();
    for (const Vec3& point : body.points) out = std::min(out, point.z());
    return out;
}

/// Adds the touches of two polyhedra: the corners of the overlay of both, seen from above. Leaves out pairs of corners
/// and edges whose heights show that they touch below `least`.
void add_polyhedra(const Convex& body, const Convex& ground, const WantedTouches& wanted, std::vector<Touch>& out)
{
    const double top = highest_point(ground), bottom = lowest_point(body);
    for (const Vec3& point : body.points) {
        if (top - point.z() < wanted.least) continue;
        if (const auto end = end_of(ground, point.x(), point.y(), 1))
            out.push_back(touch_at(end->z - point.z(), point, end->normal));
    }
    for (std::size_t k = 0; k < ground.points.size(); ++k) {
        const Vec3& point = ground.points[k];
        if (point.z() - bottom < wanted.least || !wanted.has_point(k)) continue;
        if (const auto end = end_of(body, point.x(), point.y(), -1))
            out.push_back(touch_at(point.z() - end->z, {point.x(), point.y(), end->z}, end->normal));
    }
    for (const auto& [a, b] : body.edges) {
        const Vec3 &from = body.points[std::size_t(a)], &to = body.points[std::size_t(b)];
        const double low = std::min(from.z(), to.z());
        if (top - low < wanted.least) continue;
        const Vec3 along = to - from;
        for (std::size_t k = 0; k < ground.edges.size(); ++k) {
            const auto& [c, d] = ground.edges[k];
            const Vec3 &other = ground.points[std::size_t(c)], &end = ground.points[std::size_t(d)];
            if (!wanted.has_edge(k) || std::max(other.z(), end.z()) - low < wanted.least) continue;
            const Vec2 apart = (other - from).head<2>();
            const double left = cross(along.head<2>(), apart), right = cross(along.head<2>(), (end - from).head<2>());
            if ((left > 0 && right > 0) || (left < 0 && right < 0)) continue;
            const Vec3 across = end - other;
            const double crossing = along.x() * across.y() - along.y() * across.x();
            const double s = cross(apart, across.head<2>()) / crossing, t = cross(apart, along.head<2>()) / crossing;
            if (!(s >= 0 && s <= 1 && t >= 0 && t <= 1)) continue;
            const Vec3 normal = along.cross(across);
            if (std::abs(crossing) <= parallel * along.norm() * across.norm() ||
                std::abs(crossing) * steepest < normal.norm())
                continue;
            const Vec3 point = from + s * along;
            out.push_back(touch_at(other.z() + t * across.z() - point.z(), point, normal));
        }
    }
}

/// Adds the touches of a ball.
void add_ball(const Vec3& centre, double radius, const Convex& ground, const WantedTouches& wanted,
              std::vector<Touch>& out)
{
    const auto add = [&](const Vec3& on_ground, const Vec3& normal) {  // the normal has length 1
        if (normal.z() * steepest < 1) return;
        const Vec3 point = centre - radius * normal;
        out.push_back(touch_at(on_ground.z() - point.z(), point, normal));
    };
    const double bottom = centre.z() - radius;
    for (std::size_t f = 0; f < ground.face_count(); ++f) {
        const Convex::Plane& plane = ground.planes[f];
        const Vec3 point = centre - radius * plane.normal;
        if (const auto z = height_on(plane, ground, point)) add({point.x(), point.y(), *z}, plane.normal);
    }
    for (std::size_t k = 0; k < ground.edges.size(); ++k) {
        if (!wanted.has_edge(k)) continue;
        const auto& [a, b] = ground.edges[k];
        const Vec3 &from = ground.points[std::size_t(a)], along = ground.points[std::size_t(b)] - from;
        const double length = along.head<2>().norm();
        if (std::max(from.z(), from.z() + along.z()) - bottom < wanted.least || length * steepest < along.norm())
            continue;
        const Vec3 aside = Vec3(-along.y(), along.x(), 0) / length;  // perpendicular to the vertical plane of the edge
        const double off = aside.dot(centre - from);
        if (std::abs(off) >= radius) continue;
        const Vec3 up = along.cross(aside).normalized() * (along.cross(aside).z() < 0 ? -1 : 1);
        const Vec3 normal = (off * aside + std::sqrt(radius * radius - off * off) * up) / radius;
        const double t = (centre - radius * normal - from).head<2>().dot(along.head<2>()) / (length * length);
        if (t >= 0 && t <= 1) add(from + t * along, normal);
    }
    for (std::size_t k = 0; k < ground.points.size(); ++k) {
        if (!wanted.has_point(k)) continue;
        const Vec3& corner = ground.points[k];
        const Vec2 off = (centre - corner).head<2>();
        if (corner.z() - bottom < wanted.least || off.squaredNorm() >= radius * radius) continue;
        const double up = std::sqrt(radius * radius - off.squaredNorm());
        add(corner, Vec3(off.x(), off.y(), up) / radius);
    }
}

/// Adds the touches of a cylinder without its rims: corners below it, and edges below its side.
void add_tube(const std::array<Vec3, 2>& ends, double radius, const Convex& ground, const WantedTouches& wanted,
              std::vector<Touch>& out)
{
    const Vec3 axis = (ends[1] - ends[0]).normalized();
    const double length = (ends[1] - ends[0]).norm(), bottom = std::min(ends[0].z(), ends[1].z()) - radius;
    const auto add = [&](const Vec3& on_ground, const Vec3& point, const Vec3& normal) {
        if (normal.z() * steepest >= normal.norm()) out.push_back(touch_at(on_ground.z() - point.z(), point, normal));
    };
    for (std::size_t k = 0; k < ground.points.size(); ++k) {
        if (!wanted.has_point(k)) continue;
        const Vec3& corner = ground.points[k];
        if (corner.z() - bottom < wanted.least) continue;
        // Along the vertical line (corner.x, corner.y, z), the distance from the axis is |off + z * rise|, and the
        // place along the axis is `place + z * axis.z`.
        const Vec3 from(corner.x() - ends[0].x(), corner.y() - ends[0].y(), -ends[0].z());
        const double place = from.dot(axis);
        const Vec3 off = from - place * axis, rise = Vec3::UnitZ() - axis.z() * axis;
        const double a = rise.squaredNorm(), b = off.dot(rise), c = off.squaredNorm() - radius * radius;
        double low = -std::numeric_limits<double>::infinity(), high = -low;
        Vec3 normal = Vec3::Zero();
        if (a * steepest * steepest > 1) {
            if (b * b < a * c) continue;
            const double root = std::sqrt(b * b - a * c);
            low = (-b - root) / a;
            high = (-b + root) / a;
            normal = -(off + low * rise);
        } else if (c > 0) {
            continue;
        }
        if (std::abs(axis.z()) * steepest > 1) {
            const double first = -place / axis.z(), last = (length - place) / axis.z();
            if (std::min(first, last) > low) {
                low = std::min(first, last);
                normal = axis * (axis.z() < 0 ? -1 : 1);
            }
            high = std::min(high, std::max(first, last));
        } else if (place < 0 || place > length) {
            continue;
        }
        if (low <= high) add(corner, {corner.x(), corner.y(), low}, normal);
    }
    for (std::size_t k = 0; k < ground.edges.size(); ++k) {
        if (!wanted.has_edge(k)) continue;
        const auto& [a, b] = ground.edges[k];
        const Vec3 &from = ground.points[std::size_t(a)], along = ground.points[std::size_t(b)] - from;
        if (std::max(from.z(), from.z() + along.z()) - bottom < wanted.least) continue;
        Vec3 normal = axis.cross(along);
        if (std::abs(normal.z()) * steepest < normal.norm() || normal.norm() <= parallel * along.norm()) continue;
        normal *= (normal.z() < 0 ? -1 : 1) / normal.norm();
        // Seen from above, the line below the axis at -radius * normal crosses the edge.
        const Vec3 line = ends[0] - radius * normal;
        const Vec2 apart = (from - line).head<2>();
        const double crossing = cross(axis.head<2>(), along.head<2>());
        const double s = cross(apart, along.head<2>()) / crossing, t = cross(apart, axis.head<2>()) / crossing;
        if (s >= 0 && s <= length && t >= 0 && t <= 1) add(from + t * along, line + s * axis, normal);
    }
}

/// Adds the touches of the rim of a disc.
void add_rim(const Vec3& centre, const Vec3& axis, double radius, const Convex& ground, const WantedTouches& wanted,
             std::vector<Touch>& out)
{
    for (std::size_t f = 0; f < ground.face_count(); ++f) {
        const Convex::Plane& plane = ground.planes[f];
        const Vec3 across = plane.normal - plane.normal.dot(axis) * axis;
        if (plane.normal.z() * steepest < 1 || across.norm() < 1e-14) continue;
        const Vec3 point = centre - radius * across.normalized();
        if (const auto z = height_on(plane, ground, point))
            out.push_back(touch_at(*z - point.z(), point, plane.normal));
    }
    const double bottom = centre.z() - radius * std::sqrt(std::max(0.0, 1 - axis.z() * axis.z()));
    const Vec3 u = axis.unitOrthogonal(), v = axis.cross(u);
    for (std::size_t k = 0; k < ground.edges.size(); ++k) {
        if (!wanted.has_edge(k)) continue;
        const auto& [a, b] = ground.edges[k];
        const Vec3 &from = ground.points[std::size_t(a)], along = ground.points[std::size_t(b)] - from;
        if (std::max(from.z(), from.z() + along.z()) - bottom < wanted.least) continue;
        const Vec2 flat = along.head<2>(), aside(-flat.y(), flat.x());
        // The rim's points at an angle: centre + radius * (u cos + v sin). They lie above the edge's line where
        // p cos + q sin = r.
        const double p = radius * aside.dot(u.head<2>()), q = radius * aside.dot(v.head<2>()),
                     r = aside.dot((from - centre).head<2>()), square = p * p + q * q;
        if (square <= r * r) continue;
        const double root = std::sqrt(square - r * r);
        for (const double sign : {-1.0, 1.0}) {
            const double cosine = (p * r - sign * q * root) / square, sine = (q * r + sign * p * root) / square;
            const Vec3 point = centre + radius * (cosine * u + sine * v);
            const double t = (point - from).head<2>().dot(flat) / flat.squaredNorm();
            if (t < 0 || t > 1) continue;
            const Vec3 normal = along.cross(cosine * v - sine * u);
            if (std::abs(normal.z()) * steepest < normal.norm()) continue;
            out.push_back(touch_at(from.z() + t * along.z() - point.z(), point, normal));
        }
    }
}

/// Adds the touches of a round body and a polyhedron.
void add_round(const Convex& body, const Convex& ground, const WantedTouches& wanted, std::vector<Touch>& out)
{
    for (const Vec3& point : body.points)
        if (body.ball > 0)
            add_ball(point, body.ball, ground, wanted, out);
        else
            add_rim(point, body.axis, body.disc, ground, wanted, out);
    if (body.points.size() == 2)
        add_tube({body.points[0], body.points[1]}, std::max(body.ball, body.disc), ground, wanted, out);
}

}  // namespace

/// The bodies do not overlap if the body is raised above the smallest value, over all slopes n with n.z = 1, of the
/// farthest point of (ground - body) along n. That is a convex function of n, whose smallest value is found with
/// cutting planes (Kelley, The cutting-plane method for solving convex programs, 1960): each farthest point is a plane.
std::optional<Touch> highest_touch(const Convex& body, const Convex& ground)
{
    struct Farthest {
        Vec3 on_body, apart;  ///< of (ground - body)
    };
    const auto farthest = [&](const Vec2& slope) {
        const Vec3 direction(slope.x(), slope.y(), 1), on_body = body.support(-direction);
        return Farthest{on_body, ground.support(direction) - on_body};
    };
    const auto reach = [](const Farthest& at, const Vec2& slope) {
        return at.apart.head<2>().dot(slope) + at.apart.z();
    };
    Vec2 best = Vec2::Zero();
    std::vector<Farthest> planes{farthest(best)};
    double least = reach(planes[0], best), limit = 1;  // of a step from the best slope
    for (int step = 0;; ++step) {
        std::vector<MinimaxRow> rows;
        for (const Farthest& plane : planes) rows.push_back({reach(plane, best) - least, plane.apart.head<2>()});
        const Minimax lowest = lowest_of_highest(rows, limit);
        const bool is_found = lowest.value >= -rounding || step == max_steps;
        if (is_found) {
            Vec3 point = Vec3::Zero();
            double weights = 0;
            for (std::size_t k = 0; k < 3; ++k) {
                if (lowest.rows[k] < 0) continue;
                point += lowest.weights[k] * planes[std::size_t(lowest.rows[k])].on_body;
                weights += lowest.weights[k];
            }
            return Touch{least, point / weights, {best.x(), best.y(), 1}};
        }
        const Vec2 slope = best + lowest.at;
        if (slope.norm() > steepest) return std::nullopt;
        const Farthest there = farthest(slope);
        const double sinks = least - reach(there, slope);
        if (sinks < lowest.value)
            limit = lowest.at.lpNorm<Eigen::Infinity>() / 2;
        else if (lowest.is_at_limit())
            limit *= 4;
        if (sinks > 0) {
            best = slope;
            least -= sinks;
        }
        std::vector<Farthest> kept;
        for (std::size_t k = planes.size() > most_planes ? planes.size() - most_planes : 0; k < planes.size(); ++k)
            kept.push_back(planes[k]);
        for (const int row : lowest.rows)
            if (row >= 0 && std::size_t(row) + most_planes < planes.size()) kept.push_back(planes[std::size_t(row)]);
        kept.push_back(there);
        planes = std::move(kept);
    }
}

void add_touches(const Convex& body, const Convex& ground, std::vector<Touch>& out, const WantedTouches& wanted)
{
    if (body.is_polyhedron() && ground.is_polyhedron()) return add_polyhedra(body, ground, wanted, out);
    if (ground.is_polyhedron()) return add_round(body, ground, wanted, out);
    if (body.is_polyhedron()) {  // the same seen from below, where the ground is lowered onto the body
        const std::size_t first = out.size();
        add_round(upside_down(ground), upside_down(body), {.least = wanted.least}, out);
        for (std::size_t k = first; k < out.size(); ++k) {
            Touch& touch = out[k];
            touch.body.z() = -touch.body.z() - touch.height;
            touch.slope.head<2>() *= -1;
        }
        return;
    }
    const auto add = [&](const Convex& a, const Convex& b) {
        if (const auto touch = highest_touch(a, b)) out.push_back(*touch);
    };
    add(body, ground);
    for (const Convex& end : ends_of(body)) add(end, ground);
    for (const Convex& end : ends_of(ground)) add(body, end);
}

std::optional<Interval> blocked_heights(const Convex& body, const Convex& solid)
{
    const auto highest = [](const Convex& a, const Convex& b) {
        std::vector<Touch> touches;
        add_touches(a, b, touches);
        double out = -std::numeric_limits<double>::infinity();
        for (const Touch& touch : touches) out = std::max(out, touch.height);
        return out;
    };
    const double top = highest(body, solid);
    if (!std::isfinite(top)) return std::nullopt;
    return Interval{-highest(upside_down(body), upside_down(solid)), top};
}

}  // namespace spawnfield
