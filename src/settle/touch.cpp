#include "settle/touch.h"

#include "base/polygon2.h"
#include "settle/minimax.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <utility>

namespace spawnfield {
namespace {

constexpr double steepest = 1e5;    ///< largest slope of a touching surface; a steeper one is a wall
constexpr double rounding = 1e-12;  // m
/// Edges count as parallel if the z of their cross product is at most this share of the product of their lengths.
constexpr double parallel = 1e-12;
/// If the sine of the angle between a disc and a face is at most this, the disc may come to lie on the face. Then its
/// rim also counts as a polygon with this number of corners.
constexpr double flat_disc = 0.5;
constexpr int rim_corners = 32;
constexpr int max_steps = 500;  // of highest_touch()
/// The newest planes that highest_touch() keeps after a step, besides those that hold the lowest point.
constexpr std::size_t most_planes = 12;

/// An end of the part of a vertical line that is inside a polyhedron.
struct End {
    double z;
    Vec3 normal;              ///< of the face there, outwards
    std::uint32_t plane = 0;  ///< of a Convex: its index
};

/// Returns the lower end (sign -1) or the upper end (sign 1) of the vertical line through (x, y) in a polyhedron, if
/// the line meets it.
std::optional<End> end_of(const Convex& body, double x, double y, double sign)
{
    double low = -std::numeric_limits<double>::infinity(), high = -low;
    const Convex::Plane *lowest = nullptr, *highest = nullptr;
    for (const Convex::Plane& plane : body.planes) {
        const double remainder = plane.offset - plane.normal.x() * x - plane.normal.y() * y;  // >= normal.z * z
        if (std::abs(plane.normal.z()) * steepest < 1) {
            if (remainder < -rounding) return std::nullopt;
            continue;
        }
        const double z = remainder / plane.normal.z();
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
    return End{sign > 0 ? high : low, face->normal, std::uint32_t(face - body.planes.data())};
}

Touch touch_at(double height, const Vec3& point, const Vec3& normal, Touch::Kind kind = Touch::Kind::Other,
               std::size_t body = 0, std::size_t ground = 0)
{
    return {height, point, normal / normal.z(), kind, std::uint32_t(body), std::uint32_t(ground)};
}

/// Returns the height at which two edges touch, of the body and of the ground, both infinitely long.
double height_of_crossing(const Vec3& from, const Vec3& along, const Vec3& other, const Vec3& across)
{
    const Vec2 apart = (other - from).head<2>();
    const double crossing = cross(along.head<2>(), across.head<2>());
    const double s = cross(apart, across.head<2>()) / crossing, t = cross(apart, along.head<2>()) / crossing;
    return other.z() + t * across.z() - from.z() - s * along.z();
}

/// The upper side of a convex solid, onto which bodies are lowered. FaceTop has the same functions, see below.
class Top {
public:
    explicit Top(const Convex& solid) : points(solid.points), edges(solid.edges), solid_(solid)
    {
        for (const Vec3& point : points) highest_ = std::max(highest_, point.z());
    }

    const std::vector<Vec3>& points;
    const std::vector<std::array<int, 2>>& edges;

    std::optional<End> end(double x, double y) const { return end_of(solid_, x, y, 1); }

    /// Returns how far a point must be raised at most until it is not below the solid's top, m.
    double height_bound(const Vec3& point) const { return highest_ - point.z(); }

    /// Calls visit(normal, z) for each upper face: its unit normal, and a function that returns the z of its plane at
    /// the x and y of a point, or nothing if the top is not on the face there (to 1e-9 m).
    template <class Visit>
    void visit_faces(const Visit& visit) const
    {
        for (std::size_t f = 0; f < solid_.face_count(); ++f) {
            const Convex::Plane& plane = solid_.planes[f];
            if (plane.normal.z() * steepest < 1) continue;
            visit(plane.normal, [&](const Vec3& point) -> std::optional<double> {
                const double z = (plane.offset - plane.normal.head<2>().dot(point.head<2>())) / plane.normal.z();
                const auto top = end(point.x(), point.y());
                return top && top->z >= z - 1e-9 ? std::optional(z) : std::nullopt;
            });
        }
    }

private:
    const Convex& solid_;
    double highest_ = -std::numeric_limits<double>::infinity();
};

/// The same for a face.
class FaceTop {
public:
    explicit FaceTop(const TouchFace& face) : points(face.points()), edges(face.edges()), face_(face) {}

    const std::span<const Vec3> points;
    const std::span<const std::array<int, 2>> edges;

    std::optional<End> end(double x, double y) const
    {
        if (!face_.is_over({x, y, 0})) return std::nullopt;
        return End{face_.z_at({x, y, 0}), face_.normal};
    }

    /// Returns how far a point must be raised until it is on the face's plane, m.
    double height_bound(const Vec3& point) const { return face_.z_at(point) - point.z(); }

    const TouchFace& face() const { return face_; }

    template <class Visit>
    void visit_faces(const Visit& visit) const
    {
        visit(face_.normal.normalized(), [&](const Vec3& point) -> std::optional<double> {
            const auto top = end(point.x(), point.y());
            return top ? std::optional(top->z) : std::nullopt;
        });
    }

private:
    const TouchFace& face_;
};

/// Adds the touches of corners of the ground below a polyhedron, without those below wanted.min_height.
template <class Ground>
void add_corners_below(const Convex& body, const Bounds& bounds, const Ground& ground, const WantedTouches& wanted,
                       std::vector<Touch>& out)
{
    for (std::size_t k = 0; k < ground.points.size(); ++k) {
        const Vec3& point = ground.points[k];
        if (point.z() - bounds.min.z() < wanted.min_height || !wanted.wants_point(k) ||
            !bounds.contains_xy(point.x(), point.y(), rounding))
            continue;
        if (const auto end = end_of(body, point.x(), point.y(), -1))
            out.push_back(touch_at(point.z() - end->z, {point.x(), point.y(), end->z}, end->normal,
                                   Touch::Kind::CornerUnderFace, end->plane, k));
    }
}

/// Adds the touch of edge j of a polyhedron and edge k of the ground, if they cross seen from above.
template <class Ground>
void add_crossing(const Convex& body, std::size_t j, const Ground& ground, std::size_t k, std::vector<Touch>& out)
{
    const auto& [a, b] = body.edges[j];
    const auto& [c, d] = ground.edges[k];
    const Vec3 &from = body.points[std::size_t(a)], along = body.points[std::size_t(b)] - from;
    const Vec3 &other = ground.points[std::size_t(c)], across = ground.points[std::size_t(d)] - other;
    const Vec2 apart = (other - from).head<2>();
    const double crossing = cross(along.head<2>(), across.head<2>());
    const double s = cross(apart, across.head<2>()) / crossing, t = cross(apart, along.head<2>()) / crossing;
    if (!(s >= 0 && s <= 1 && t >= 0 && t <= 1)) return;
    const Vec3 normal = along.cross(across);
    const double square = crossing * crossing;
    if (square <= parallel * parallel * along.squaredNorm() * across.squaredNorm() ||
        square * steepest * steepest < normal.squaredNorm())
        return;
    const Vec3 point = from + s * along;
    out.push_back(touch_at(other.z() + t * across.z() - point.z(), point, normal, Touch::Kind::EdgeOnEdge, j, k));
}

/// Adds the touches of two polyhedra: corners of one on the other, and pairs of edges that cross seen from above.
/// Leaves out corners and edges that touch below wanted.min_height.
void add_polyhedra(const Convex& body, const Top& ground, const WantedTouches& wanted, std::vector<Touch>& out)
{
    for (std::size_t j = 0; j < body.points.size(); ++j) {
        const Vec3& point = body.points[j];
        if (ground.height_bound(point) < wanted.min_height) continue;
        if (const auto end = ground.end(point.x(), point.y()))
            out.push_back(touch_at(end->z - point.z(), point, end->normal, Touch::Kind::CornerOnFace, j));
    }
    add_corners_below(body, body.bounds(), ground, wanted, out);
    for (std::size_t j = 0; j < body.edges.size(); ++j) {
        const auto& [a, b] = body.edges[j];
        const Vec3 &from = body.points[std::size_t(a)], &to = body.points[std::size_t(b)];
        if (!body.is_lower_edge(j) || std::max(ground.height_bound(from), ground.height_bound(to)) < wanted.min_height)
            continue;
        for (std::size_t k = 0; k < ground.edges.size(); ++k)
            if (wanted.wants_edge(k)) add_crossing(body, j, ground, k, out);
    }
}

/// Bits of a point beside the sides of a face, seen from above: bit k is set if the point is outside of side k by more
/// than rounding, bit 4 + k if it is inside of side k by more than rounding. They are as wide as a double, so that
/// several are computed at a time.
using SideBits = std::int64_t;

template <std::size_t Count>
struct FaceSides {
    static constexpr SideBits all = (1 << Count) - 1;

    static SideBits outside_of(SideBits bits) { return bits & all; }
    static SideBits inside_of(SideBits bits) { return bits >> TouchFace::most & all; }

    /// Sets the bits of each corner of a body. Returns the bits that all corners have.
    static SideBits compare(const PlacedBody::Corners& corners, const TouchFace& face, SideBits* bits)
    {
        const double *const x = corners.x.data(), *const y = corners.y.data();
        std::array<double, Count> a, b, c;
        for (std::size_t k = 0; k < Count; ++k) {
            a[k] = face.sides[k].inward.x();
            b[k] = face.sides[k].inward.y();
            c[k] = face.sides[k].offset;
        }
        const std::size_t count = corners.x.size();
        SideBits common = ~SideBits{0};
#pragma omp simd reduction(& : common)
        for (std::size_t j = 0; j < count; ++j) {
            SideBits here = 0;
            for (std::size_t k = 0; k < Count; ++k) {
                const double inside = a[k] * x[j] + b[k] * y[j] - c[k];
                here |= (inside < -rounding ? SideBits{1} << k : 0) |
                        (inside > rounding ? SideBits{1} << (TouchFace::most + k) : 0);
            }
            bits[j] = here;
            common &= here;
        }
        return common;
    }
};

/// The same for a polyhedron on a face with this number of corners. Seen from above, an edge can cross a side of the
/// face only if its corners are on different sides of it.
template <std::size_t Count>
void add_polyhedra(const PlacedBody& placed, const FaceTop& ground, const WantedTouches& wanted,
                   std::vector<Touch>& out)
{
    using Sides = FaceSides<Count>;
    constexpr std::size_t few =
        32;  // no allocation for boxes and small hulls, because this is called millions of times
    std::array<SideBits, few> few_bits;
    const PlacedBody::Corners& corners = placed.lower_corners;
    std::vector<SideBits> many_bits(corners.x.size() > few ? corners.x.size() : 0);
    SideBits* const bits = many_bits.empty() ? few_bits.data() : many_bits.data();
    const TouchFace& face = ground.face();
    const SideBits common = Sides::compare(corners, face, bits);
    if (Sides::outside_of(common) != 0) return;
    const auto height_of = [&](std::size_t j) {
        return face.height - face.normal.x() * corners.x[j] - face.normal.y() * corners.y[j] - corners.z[j];
    };
    for (std::size_t j = 0; j < corners.indices.size(); ++j) {
        if (Sides::outside_of(bits[j]) != 0) continue;
        const double height = height_of(j);
        if (height >= wanted.min_height)
            out.push_back({height,
                           {corners.x[j], corners.y[j], corners.z[j]},
                           face.normal,
                           Touch::Kind::CornerOnFace,
                           corners.indices[j],
                           0});
    }
    add_corners_below(placed.body, placed.bounds, ground, wanted, out);
    const SideBits wanted_sides = ~SideBits{wanted.covered_edges} & ~Sides::inside_of(common) & Sides::all;
    if (wanted_sides == 0) return;
    for (const PlacedBody::Edge& edge : placed.lower_edges) {
        const SideBits both = bits[edge.from] & bits[edge.to], crossed = ~Sides::inside_of(both) & wanted_sides;
        if (Sides::outside_of(both) != 0 || crossed == 0 ||
            std::max(height_of(edge.from), height_of(edge.to)) < wanted.min_height)
            continue;
        for (std::size_t k = 0; k < Count; ++k)
            if (crossed >> k & 1) add_crossing(placed.body, edge.index, ground, k, out);
    }
}

/// Adds the touches of a ball.
template <class Ground>
void add_ball(const Vec3& centre, double radius, const Ground& ground, const WantedTouches& wanted,
              std::vector<Touch>& out)
{
    const auto add = [&](const Vec3& on_ground, const Vec3& normal) {  // the normal has length 1
        if (normal.z() * steepest < 1) return;
        const Vec3 point = centre - radius * normal;
        out.push_back(touch_at(on_ground.z() - point.z(), point, normal));
    };
    const double bottom = centre.z() - radius;
    ground.visit_faces([&](const Vec3& normal, const auto& z_at) {
        const Vec3 point = centre - radius * normal;
        if (const auto z = z_at(point)) add({point.x(), point.y(), *z}, normal);
    });
    for (std::size_t k = 0; k < ground.edges.size(); ++k) {
        if (!wanted.wants_edge(k)) continue;
        const auto& [a, b] = ground.edges[k];
        const Vec3 &from = ground.points[std::size_t(a)], along = ground.points[std::size_t(b)] - from;
        const double length = along.head<2>().norm();
        if (std::max(from.z(), from.z() + along.z()) - bottom < wanted.min_height || length * steepest < along.norm())
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
        if (!wanted.wants_point(k)) continue;
        const Vec3& corner = ground.points[k];
        const Vec2 off = (centre - corner).head<2>();
        if (corner.z() - bottom < wanted.min_height || off.squaredNorm() >= radius * radius) continue;
        const double up = std::sqrt(radius * radius - off.squaredNorm());
        add(corner, Vec3(off.x(), off.y(), up) / radius);
    }
}

/// Adds the touches of a cylinder, except those of its rims: corners of the ground below it, and edges of the ground
/// below its side. Also used for the side of a capsule.
template <class Ground>
void add_tube(const std::array<Vec3, 2>& ends, double radius, const Ground& ground, const WantedTouches& wanted,
              std::vector<Touch>& out)
{
    const Vec3 axis = (ends[1] - ends[0]).normalized();
    const double length = (ends[1] - ends[0]).norm(), bottom = std::min(ends[0].z(), ends[1].z()) - radius;
    const auto add = [&](const Vec3& on_ground, const Vec3& point, const Vec3& normal) {
        if (normal.z() * steepest >= normal.norm()) out.push_back(touch_at(on_ground.z() - point.z(), point, normal));
    };
    for (std::size_t k = 0; k < ground.points.size(); ++k) {
        if (!wanted.wants_point(k)) continue;
        const Vec3& corner = ground.points[k];
        if (corner.z() - bottom < wanted.min_height) continue;
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
        if (!wanted.wants_edge(k)) continue;
        const auto& [a, b] = ground.edges[k];
        const Vec3 &from = ground.points[std::size_t(a)], along = ground.points[std::size_t(b)] - from;
        if (std::max(from.z(), from.z() + along.z()) - bottom < wanted.min_height) continue;
        Vec3 normal = axis.cross(along);
        if (std::abs(normal.z()) * steepest < normal.norm() || normal.norm() <= parallel * along.norm()) continue;
        normal *= (normal.z() < 0 ? -1 : 1) / normal.norm();
        // The side can touch the edge only on the line parallel to the axis at -radius * normal. Seen from above, that
        // line crosses the edge at s (m along the line) and t (share of the edge).
        const Vec3 line = ends[0] - radius * normal;
        const Vec2 apart = (from - line).head<2>();
        const double crossing = cross(axis.head<2>(), along.head<2>());
        const double s = cross(apart, along.head<2>()) / crossing, t = cross(apart, axis.head<2>()) / crossing;
        if (s >= 0 && s <= length && t >= 0 && t <= 1) add(from + t * along, line + s * axis, normal);
    }
}

/// Returns the cosines and sines of the directions of rim_corners corners.
const std::array<std::pair<double, double>, rim_corners>& rim_directions()
{
    static const auto out = [] {
        std::array<std::pair<double, double>, rim_corners> all;
        for (std::size_t k = 0; k < all.size(); ++k) {
            const double angle = 2 * std::numbers::pi * double(k) / rim_corners;
            all[k] = {std::cos(angle), std::sin(angle)};
        }
        return all;
    }();
    return out;
}

/// Adds the touches of the rim of the disc around a point of the body.
template <class Ground>
void add_rim(const Convex& body, std::size_t index, const Ground& ground, const WantedTouches& wanted,
             std::vector<Touch>& out)
{
    const double radius = body.disc;
    const Vec3 &centre = body.points[index], &axis = body.axis, &u = body.across, v = axis.cross(u);
    ground.visit_faces([&](const Vec3& normal, const auto& z_at) {
        const auto add = [&](const Vec3& point, Touch::Kind kind) {
            if (const auto z = z_at(point)) out.push_back(touch_at(*z - point.z(), point, normal, kind, index));
        };
        const Vec3 across = normal - normal.dot(axis) * axis;
        const double length = across.norm();
        if (length >= 1e-14) add(centre - (radius / length) * across, Touch::Kind::RimOnFace);
        // A disc that comes to lie on a face touches it at its whole rim, not only at its lowest point.
        const double highest = ground.height_bound(centre) + radius * length / normal.z();
        if (length > flat_disc || highest + rounding < wanted.min_height) return;
        for (const auto& [cosine, sine] : rim_directions()) {
            const Vec3 point = centre + radius * (cosine * u + sine * v);
            if (ground.height_bound(point) >= wanted.min_height) add(point, Touch::Kind::Other);
        }
    });
    const double bottom = centre.z() - radius * std::sqrt(std::max(0.0, 1 - axis.z() * axis.z()));
    for (std::size_t k = 0; k < ground.edges.size(); ++k) {
        if (!wanted.wants_edge(k)) continue;
        const auto& [a, b] = ground.edges[k];
        const Vec3 &from = ground.points[std::size_t(a)], along = ground.points[std::size_t(b)] - from;
        if (std::max(from.z(), from.z() + along.z()) - bottom < wanted.min_height) continue;
        const Vec2 flat = along.head<2>(), aside(-flat.y(), flat.x());
        // A point of the rim is centre + radius * (u cos a + v sin a). It has the same x and y as a point of the edge's
        // line where p cos a + q sin a = r.
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
template <class Ground>
void add_round(const Convex& body, const Ground& ground, const WantedTouches& wanted, std::vector<Touch>& out)
{
    for (std::size_t k = 0; k < body.points.size(); ++k)
        if (body.ball > 0)
            add_ball(body.points[k], body.ball, ground, wanted, out);
        else
            add_rim(body, k, ground, wanted, out);
    if (body.points.size() == 2)
        add_tube({body.points[0], body.points[1]}, std::max(body.ball, body.disc), ground, wanted, out);
}

/// For a direction n with n.z = 1, let f(n) be the largest value of n . (g - b) for points g of the ground and b of the
/// body. A body that is raised by more than f(n) does not overlap the ground. So the height of the highest touch is the
/// smallest value of f, which is convex. Cutting planes find it (Kelley, The cutting-plane method for solving convex
/// programs, 1960): each of them comes from one n, with the points g and b that give f(n). Returns nothing as soon as
/// one of them shows that the touch is below `min_height`.
std::optional<Touch> highest_touch_above(const Convex& body, const Convex& ground, double min_height)
{
    struct Farthest {
        Vec3 on_body;  ///< the body's farthest point along -n
        Vec3 apart;    ///< the farthest point of (ground - body) along n
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
    std::vector<MinimaxPlane> around_best;
    std::vector<Farthest> kept;
    std::optional<Minimax> before;  // the last result, with the indices that its planes have now
    for (int step = 0; least >= min_height; ++step) {
        around_best.clear();
        for (const Farthest& plane : planes) around_best.push_back({reach(plane, best) - least, plane.apart.head<2>()});
        const Minimax lowest = lowest_of_highest(around_best, limit, before);
        if (lowest.value >= -rounding || step == max_steps) {  // after max_steps: an upper bound
            Vec3 point = Vec3::Zero();
            double weights = 0;
            for (std::size_t k = 0; k < 3; ++k) {
                if (lowest.planes[k] < 0) continue;
                point += lowest.weights[k] * planes[std::size_t(lowest.planes[k])].on_body;
                weights += lowest.weights[k];
            }
            return Touch{least, point / weights, {best.x(), best.y(), 1}};
        }
        const Vec2 slope = best + lowest.at;
        if (slope.norm() > steepest) return std::nullopt;
        const Farthest there = farthest(slope);
        const double decrease = least - reach(there, slope);
        if (decrease < lowest.value)  // the value grows by more than it was predicted to decrease
            limit = lowest.at.lpNorm<Eigen::Infinity>() / 2;
        else if (lowest.is_at_limit())
            limit *= 4;
        if (decrease > 0) {
            best = slope;
            least -= decrease;
        }
        const std::size_t newest = planes.size() > most_planes ? planes.size() - most_planes : 0;
        kept.assign(planes.begin() + std::ptrdiff_t(newest), planes.end());
        before = lowest;
        for (int& plane : before->planes) {
            if (plane < 0) continue;
            const auto k = std::size_t(plane);
            plane = int(k >= newest ? k - newest : kept.size());
            if (k < newest) kept.push_back(planes[k]);
        }
        kept.push_back(there);
        std::swap(planes, kept);
    }
    return std::nullopt;
}

}  // namespace

std::optional<Touch> highest_touch(const Convex& body, const Convex& ground)
{
    return highest_touch_above(body, ground, -std::numeric_limits<double>::infinity());
}

void add_touches(const Convex& body, const Convex& ground, std::vector<Touch>& out, const WantedTouches& wanted)
{
    if (body.is_polyhedron() && ground.is_polyhedron()) return add_polyhedra(body, Top(ground), wanted, out);
    if (ground.is_polyhedron()) return add_round(body, Top(ground), wanted, out);
    if (body.is_polyhedron()) {  // turned upside down, the ground is lowered onto the body: the heights are the same
        const std::size_t first = out.size();
        const Convex upper = upside_down(body);
        add_round(upside_down(ground), Top(upper), {.min_height = wanted.min_height}, out);
        for (std::size_t k = first; k < out.size(); ++k) {  // from the ground's point to that of the body
            Touch& touch = out[k];
            touch.point.z() = -touch.point.z() - touch.height;
            touch.normal.head<2>() *= -1;
            touch.kind = Touch::Kind::Other;
        }
        return;
    }
    const auto add = [&](const Convex& a, const Convex& b) {
        if (const auto touch = highest_touch_above(a, b, wanted.min_height)) out.push_back(*touch);
    };
    add(body, ground);
    for (const Convex& end : ends_of(body)) add(end, ground);
    for (const Convex& end : ends_of(ground)) add(body, end);
}

void add_touches(const PlacedBody& placed, const TouchFace& ground, std::vector<Touch>& out,
                 const WantedTouches& wanted)
{
    const FaceTop top(ground);
    if (!placed.body.is_polyhedron()) return add_round(placed.body, top, wanted, out);
    if (ground.count == 3) return add_polyhedra<3>(placed, top, wanted, out);
    add_polyhedra<4>(placed, top, wanted, out);
}

namespace {

/// Returns a bit for each plane of a polyhedron that looks downwards; nothing if there are too many planes.
std::optional<std::uint64_t> planes_below(const Convex& body)
{
    if (body.planes.size() > 64) return std::nullopt;
    std::uint64_t out = 0;
    for (std::size_t k = 0; k < body.planes.size(); ++k) out |= std::uint64_t(body.planes[k].normal.z() < 0) << k;
    return out;
}

/// Chooses the corners and edges of a polyhedron that belong to faces that look downwards.
void choose_lower(PlacedBody& out)
{
    constexpr auto none = std::numeric_limits<std::uint32_t>::max();
    const Convex& body = out.body;
    std::vector<std::uint32_t>& corners = out.lower_corners.indices;
    corners.clear();
    out.lower_edges.clear();
    std::vector<std::uint32_t> places(body.points.size(), none);  // of the body's points in `corners`
    const auto place_of = [&](int point) {
        std::uint32_t& place = places[std::size_t(point)];
        if (place == none) {
            place = std::uint32_t(corners.size());
            corners.push_back(std::uint32_t(point));
        }
        return place;
    };
    for (std::size_t edge = 0; edge < body.edges.size(); ++edge) {
        if (!body.is_lower_edge(edge)) continue;
        const auto& [a, b] = body.edges[edge];
        const std::uint32_t from = place_of(a), to = place_of(b);
        out.lower_edges.push_back({from, to, std::uint32_t(edge)});
    }
    if (body.edges.empty())
        for (std::size_t point = 0; point < body.points.size(); ++point) place_of(int(point));
}

}  // namespace

void place(PlacedBody& out, const Convex& body, const Mat3& rotation)
{
    set_rotated(out.body, body, rotation);
    out.bounds = out.body.bounds();
    if (!body.is_polyhedron()) return;
    const std::optional<std::uint64_t> lower_planes = planes_below(out.body);
    PlacedBody::Corners& corners = out.lower_corners;
    if (!lower_planes || lower_planes != out.lower_planes) choose_lower(out);
    out.lower_planes = lower_planes;
    const std::size_t count = corners.indices.size(), even = count + count % 2;
    corners.x.resize(even);
    corners.y.resize(even);
    corners.z.resize(even);
    for (std::size_t j = 0; j < even; ++j) {
        const Vec3& point = out.body.points[corners.indices[std::min(j, count - 1)]];
        corners.x[j] = point.x();
        corners.y[j] = point.y();
        corners.z[j] = point.z();
    }
}

double height_bound(const PlacedBody& placed, const TouchFace& face)
{
    if (!placed.body.is_polyhedron()) return face.height - face.normal.dot(placed.body.support(-face.normal));
    const PlacedBody::Corners& corners = placed.lower_corners;
    const double *const x = corners.x.data(), *const y = corners.y.data(), *const z = corners.z.data();
    const double height = face.height, slope_x = face.normal.x(), slope_y = face.normal.y();
    double out = -std::numeric_limits<double>::infinity();
#pragma omp simd reduction(max : out)
    for (std::size_t j = 0; j < corners.x.size(); ++j)
        out = std::max(out, height - slope_x * x[j] - slope_y * y[j] - z[j]);
    return out;
}

std::optional<double> height_after(const Touch& touch, const Convex& body, const Mat3& rotation,
                                   const TouchFace& ground)
{
    const auto raised = [&](const Vec3& point) { return ground.z_at(point) - point.z(); };
    double out = std::numeric_limits<double>::quiet_NaN();
    switch (touch.kind) {
    case Touch::Kind::CornerOnFace: out = raised(rotation * body.points[touch.body]); break;
    case Touch::Kind::RimOnFace: {
        const Vec3 axis = rotation * body.axis, across = ground.normal - ground.normal.dot(axis) * axis;
        out = raised(rotation * body.points[touch.body] - body.disc * across.normalized());
        break;
    }
    case Touch::Kind::CornerUnderFace: {
        const Convex::Plane& plane = body.planes[touch.body];
        const Vec3 normal = rotation * plane.normal;
        out = (normal.dot(ground.corners[touch.ground]) - plane.offset) / normal.z();
        break;
    }
    case Touch::Kind::EdgeOnEdge: {
        const auto& [a, b] = body.edges[touch.body];
        const auto& [c, d] = ground.edges()[touch.ground];
        const Vec3 &from = body.points[std::size_t(a)], &other = ground.corners[std::size_t(c)];
        out = height_of_crossing(rotation * from, rotation * (body.points[std::size_t(b)] - from), other,
                                 ground.corners[std::size_t(d)] - other);
        break;
    }
    case Touch::Kind::Other: break;
    }
    return std::isfinite(out) ? std::optional(out) : std::nullopt;
}

namespace {

std::array<Vec3, 3> sides_of(const std::array<Vec3, 3>& triangle)
{
    const auto& [a, b, c] = triangle;
    return {b - a, c - b, a - c};
}

void set(TouchFace& out, const TriangleShape& shape, const std::array<Vec3, 3>& triangle)
{
    const Vec3& normal = shape.unit_normal;
    out.count = triangle.size();
    std::copy(triangle.begin(), triangle.end(), out.corners.begin());
    out.normal = normal / normal.z();
    out.height = normal.dot(triangle[0]) / normal.z();
    for (std::size_t k = 0; k < out.count; ++k)
        out.sides[k] = {shape.inwards[k], shape.inwards[k].dot(triangle[k].head<2>())};
}

}  // namespace

std::optional<TriangleShape> triangle_shape_of(const std::array<Vec3, 3>& triangle)
{
    TriangleShape out;
    out.sides = sides_of(triangle);
    out.unit_normal = out.sides[0].cross(triangle[2] - triangle[0]).normalized();
    const double up = out.unit_normal.z();
    if (!(std::abs(up) * TouchFace::steepest >= 1)) return std::nullopt;
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec2 along = out.sides[k].head<2>();
        out.inwards[k] = Vec2(-along.y(), along.x()) / (up < 0 ? -along.norm() : along.norm());
    }
    return out;
}

std::optional<TouchFace> touch_face_of(const std::array<Vec3, 3>& triangle)
{
    std::optional<TouchFace> out;
    set_touch_face(out, triangle, triangle_shape_of(triangle));
    return out;
}

void set_touch_face(std::optional<TouchFace>& out, const std::array<Vec3, 3>& triangle,
                    const std::optional<TriangleShape>& known)
{
    const bool is_same = known && known->sides == sides_of(triangle);
    const std::optional<TriangleShape> shape = is_same ? std::nullopt : triangle_shape_of(triangle);
    if (!is_same && !shape) return out.reset();
    if (!out) out.emplace();
    set(*out, is_same ? *known : *shape, triangle);
}

TouchFace top_of(const Bounds& box)
{
    const double x0 = box.min.x(), y0 = box.min.y(), x1 = box.max.x(), y1 = box.max.y(), z = box.max.z();
    return {4,
            {Vec3(x0, y0, z), Vec3(x1, y0, z), Vec3(x1, y1, z), Vec3(x0, y1, z)},
            Vec3::UnitZ(),
            z,
            {{{{0, 1}, y0}, {{-1, 0}, -x1}, {{0, -1}, -y1}, {{1, 0}, x0}}}};
}

std::span<const std::array<int, 2>> TouchFace::edges() const
{
    static constexpr std::array<std::array<int, 2>, 3> of_triangle{{{0, 1}, {1, 2}, {2, 0}}};
    static constexpr std::array<std::array<int, 2>, 4> of_rectangle{{{0, 1}, {1, 2}, {2, 3}, {3, 0}}};
    if (count == 3) return of_triangle;
    return of_rectangle;
}

bool TouchFace::is_over(const Vec3& p) const
{
    return std::all_of(sides.begin(), sides.begin() + std::ptrdiff_t(count), [&](const Side& side) {
        return side.inward.x() * p.x() + side.inward.y() * p.y() >= side.offset - rounding;
    });
}

std::optional<double> upper_end(const Convex& body, double x, double y)
{
    if (body.is_polyhedron()) {
        const auto end = end_of(body, x, y, 1);
        return end ? std::optional(end->z) : std::nullopt;
    }
    // Round bodies are the same seen from below, so the lower end on the opposite line is used.
    const Vec3 middle = (body.points.front() + body.points.back()) / 2;
    const Convex opposite = convex_of(Vec3(2 * middle.x() - x, 2 * middle.y() - y, 0));
    std::vector<Touch> touches;
    add_touches(body, opposite, touches);
    double low = std::numeric_limits<double>::infinity();
    for (const Touch& touch : touches) low = std::min(low, -touch.height);
    return std::isfinite(low) ? std::optional(2 * middle.z() - low) : std::nullopt;
}

std::optional<double> lower_end(const PlacedBody& placed, double x, double y)
{
    if (placed.body.is_polyhedron()) {
        if (!placed.bounds.contains_xy(x, y, rounding)) return std::nullopt;
        const auto end = end_of(placed.body, x, y, -1);
        return end ? std::optional(end->z) : std::nullopt;
    }
    const Convex point = convex_of(Vec3(x, y, 0));
    std::vector<Touch> touches;
    add_touches(placed.body, point, touches);
    double low = std::numeric_limits<double>::infinity();
    for (const Touch& touch : touches) low = std::min(low, -touch.height);
    return std::isfinite(low) ? std::optional(low) : std::nullopt;
}

namespace {

double highest_touch_of(const Convex& body, const Convex& solid)
{
    std::vector<Touch> touches;
    add_touches(body, solid, touches);
    double out = -std::numeric_limits<double>::infinity();
    for (const Touch& touch : touches) out = std::max(out, touch.height);
    return out;
}

}  // namespace

std::optional<Interval> blocked_heights(const Convex& body, const Convex& solid)
{
    const double top = highest_touch_of(body, solid);
    if (!std::isfinite(top)) return std::nullopt;
    return Interval{lowest_blocked(body, solid), top};
}

double lowest_blocked(const Convex& body, const Convex& solid)
{
    return -highest_touch_of(upside_down(body), upside_down(solid));
}

}  // namespace spawnfield
