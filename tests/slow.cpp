#include "slow.h"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

using namespace spawnfield;

namespace slow {
namespace {

using Real = long double;
constexpr double infinity = std::numeric_limits<double>::infinity();

// ---- Convex bodies ----

/// All points within `radius` of the hull of `corners`. The hull is a point, a segment, a triangle or a solid polytope.
struct Convex {
    std::vector<Vec3> corners;
    std::vector<std::array<int, 2>> edges;  ///< a point has one edge, which leads to itself
    std::vector<std::array<int, 3>> faces;
    std::vector<Vec3> normals, directions;  ///< of faces and edges, unit length; one of several parallel ones is enough
    double radius = 0;

    bool has_volume() const { return faces.size() > 1; }
};

enum class Rounding { Inscribed, Circumscribed };

Vec3 moved(const Pose& pose, const Vec3& point) { return pose.rotation * point + pose.position; }

Convex segment(const Vec3& a, const Vec3& b, double radius)
{
    return {{a, b}, {{0, 1}}, {}, {}, {(b - a).normalized()}, radius};
}

Convex polytope(std::vector<Vec3> corners, std::vector<std::array<int, 3>> faces)
{
    Convex body;
    std::set<std::array<int, 2>> edges;
    for (const auto& [a, b, c] : faces) {
        body.normals.push_back((corners[b] - corners[a]).cross(corners[c] - corners[a]).normalized());
        for (const auto& [from, to] : {std::array{a, b}, {b, c}, {c, a}})
            edges.insert({std::min(from, to), std::max(from, to)});
    }
    for (const auto& [a, b] : edges) body.directions.push_back((corners[b] - corners[a]).normalized());
    body.edges.assign(edges.begin(), edges.end());
    body.corners = std::move(corners);
    body.faces = std::move(faces);
    return body;
}

/// Returns an upright prism over a polygon that is symmetric about the origin, moved to its pose.
Convex prism(const std::vector<Eigen::Vector2d>& polygon, double half_height, const Pose& pose)
{
    const int n = int(polygon.size());
    Convex body;
    for (const double z : {-half_height, half_height})
        for (const auto& corner : polygon) body.corners.push_back(moved(pose, {corner.x(), corner.y(), z}));
    const Vec3 axis = pose.rotation.col(2);
    body.normals = body.directions = {axis};
    for (int i = 0; i < n; ++i) {
        const int next = (i + 1) % n;
        body.edges.insert(body.edges.end(), {{i, next}, {n + i, n + next}, {i, n + i}});
        body.faces.insert(body.faces.end(), {{i, next, n + next}, {i, n + next, n + i}});
        if (i > 1) body.faces.insert(body.faces.end(), {{0, i - 1, i}, {n, n + i - 1, n + i}});
        if (i >= n / 2) continue;  // this side is parallel to the opposite one
        body.directions.push_back((body.corners[next] - body.corners[i]).normalized());
        body.normals.push_back(body.directions.back().cross(axis).normalized());
    }
    return body;
}

std::vector<Eigen::Vector2d> polygon_of_circle(double radius, Rounding rounding)
{
    constexpr int sides = 96;
    const double reach = rounding == Rounding::Inscribed ? radius : radius / std::cos(M_PI / sides);
    std::vector<Eigen::Vector2d> polygon;
    for (int i = 0; i < sides; ++i)
        polygon.emplace_back(reach * std::cos(2 * M_PI * i / sides), reach * std::sin(2 * M_PI * i / sides));
    return polygon;
}

Convex convex_of(const Shape& shape, const Pose& pose, Rounding rounding)
{
    const Vec3 half = shape.size / 2;
    const Vec3 along = pose.rotation.col(2) * half.y();
    switch (shape.kind) {
    case ShapeKind::Box:
        return prism({{-half.x(), -half.y()}, {half.x(), -half.y()}, {half.x(), half.y()}, {-half.x(), half.y()}},
                     half.z(), pose);
    case ShapeKind::Cylinder: return prism(polygon_of_circle(shape.size.x(), rounding), half.y(), pose);
    case ShapeKind::Capsule: return segment(pose.position - along, pose.position + along, shape.size.x());
    case ShapeKind::Sphere:
    case ShapeKind::Hull: break;  // hulls store their corners elsewhere
    }
    return {{pose.position}, {{0, 0}}, {}, {}, {}, shape.size.x()};
}

Convex convex_of(const RobotPart& part, const Pose& scene_from_robot, Rounding rounding)
{
    if (part.shape.kind != ShapeKind::Hull) return convex_of(part.shape, scene_from_robot * part.shape.pose, rounding);
    std::vector<Vec3> corners;
    for (const Vec3& corner : part.hull_vertices) corners.push_back(moved(scene_from_robot, corner));
    return polytope(std::move(corners), part.hull_faces);
}

Vec3 middle(const Convex& body)
{
    Vec3 sum = Vec3::Zero();
    for (const Vec3& corner : body.corners) sum += corner;
    return sum / double(body.corners.size());
}

// ---- Distances ----

double distance_to_segment(const Vec3& point, const Vec3& a, const Vec3& b)
{
    const double length2 = (b - a).squaredNorm();
    const double t = length2 > 0 ? std::clamp((point - a).dot(b - a) / length2, 0.0, 1.0) : 0.0;
    return (a + t * (b - a) - point).norm();
}

/// Returns the distance of two segments. It is reached where the two lines are nearest, if that point is on both
/// segments, or else at one of the four ends.
double distance_of_segments(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
{
    double best = std::min({distance_to_segment(a, c, d), distance_to_segment(b, c, d), distance_to_segment(c, a, b),
                            distance_to_segment(d, a, b)});
    const Vec3 u = b - a, v = d - c, w = a - c;
    const double uu = u.dot(u), uv = u.dot(v), vv = v.dot(v), determinant = uu * vv - uv * uv;
    if (!(determinant > 1e-18 * uu * vv))
        return best;  // parallel segments or a point: an end is one of the nearest points
    const double s = (uv * v.dot(w) - vv * u.dot(w)) / determinant;
    const double t = (uu * v.dot(w) - uv * u.dot(w)) / determinant;
    if (s < 0 || s > 1 || t < 0 || t > 1) return best;
    return std::min(best, (w + s * u - t * v).norm());
}

/// Returns whether the line through `point` along the normal of the triangle runs through the triangle.
bool is_over(const Vec3& point, const std::array<Vec3, 3>& triangle, const Vec3& normal)
{
    for (int i = 0; i < 3; ++i) {
        const Vec3& from = triangle[i];
        if ((triangle[(i + 1) % 3] - from).cross(point - from).dot(normal) < 0) return false;
    }
    return true;
}

double distance_to_triangle(const Vec3& point, const std::array<Vec3, 3>& triangle)
{
    const auto& [a, b, c] = triangle;
    const Vec3 normal = (b - a).cross(c - a).normalized();
    if (normal.squaredNorm() > 0.5 && is_over(point, triangle, normal)) return std::abs((point - a).dot(normal));
    return std::min(
        {distance_to_segment(point, a, b), distance_to_segment(point, b, c), distance_to_segment(point, c, a)});
}

bool crosses(const Vec3& from, const Vec3& to, const std::array<Vec3, 3>& triangle)
{
    const Vec3 normal = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]).normalized();
    const double before = (from - triangle[0]).dot(normal), after = (to - triangle[0]).dot(normal);
    if (before * after > 0 || before == after) return false;
    return is_over(from + (to - from) * (before / (before - after)), triangle, normal);
}

/// Returns the distance from the corners and edges of one body to the faces of the other.
double distance_to_faces(const Convex& body, const Convex& other)
{
    double best = infinity;
    for (const auto& [a, b, c] : other.faces) {
        const std::array<Vec3, 3> triangle = {other.corners[a], other.corners[b], other.corners[c]};
        for (const Vec3& corner : body.corners) best = std::min(best, distance_to_triangle(corner, triangle));
        for (const auto& [from, to] : body.edges)
            if (crosses(body.corners[from], body.corners[to], triangle)) return 0;
    }
    return best;
}

/// Returns the distance between the hulls of the corners, without the radii; 0 if their surfaces meet. Two convex
/// bodies are nearest each other between a corner and a face, or between two edges.
double distance(const Convex& a, const Convex& b)
{
    double best = std::min(distance_to_faces(a, b), distance_to_faces(b, a));
    for (const auto& [a0, a1] : a.edges)
        for (const auto& [b0, b1] : b.edges)
            best = std::min(best, distance_of_segments(a.corners[a0], a.corners[a1], b.corners[b0], b.corners[b1]));
    return best;
}

// ---- Separating axes ----

double gap_along(const Vec3& axis, const Convex& a, const Convex& b)
{
    const auto range = [&](const Convex& body) {
        std::array<double, 2> ends = {infinity, -infinity};
        for (const Vec3& corner : body.corners) {
            const double place = axis.dot(corner);
            ends = {std::min(ends[0], place), std::max(ends[1], place)};
        }
        return ends;
    };
    const auto [a0, a1] = range(a);
    const auto [b0, b1] = range(b);
    return std::max(b0 - a1, a0 - b1);
}

/// Returns the widest gap between the hulls along any axis that matters. A negative value is minus the shift that would
/// separate them. Stops at the first gap wider than `enough`. Source: Gottschalk, Separating axis theorem, 1996.
double widest_gap(const Convex& a, const Convex& b, double enough)
{
    std::vector<Vec3> axes = a.normals;
    axes.insert(axes.end(), b.normals.begin(), b.normals.end());
    for (const Vec3& u : a.directions)
        for (const Vec3& v : b.directions) axes.push_back(u.cross(v));
    double widest = -infinity;
    for (const Vec3& axis : axes) {
        if (axis.norm() < 1e-9) continue;  // the edges are parallel; the faces beside them give the axis
        widest = std::max(widest, gap_along(axis.normalized(), a, b));
        if (widest > enough) break;
    }
    return widest;
}

bool touches(const Convex& a, const Convex& b, double grow)
{
    const double reach = a.radius + b.radius + grow;
    for (int i = 0; i < 3; ++i)
        if (gap_along(Vec3::Unit(i), a, b) > reach) return false;  // a quick test: any axis may separate them
    if (a.has_volume() || b.has_volume()) {                        // in a common plane the axes would miss contacts
        const double gap = widest_gap(a, b, reach);
        if (gap > reach) return false;
        if (gap <= 0) return true;
    }
    return distance(a, b) <= reach;
}

// ---- Lines through meshes ----

/// A line through a point. While it rises by 1, it moves by `lean_x` and `lean_y`. It is vertical if both are 0.
struct Line {
    Vec3 through;
    double lean_x = 0, lean_y = 0;
};

struct Crossing {
    double z = 0;
    Label label = Label::Obstacle;
    bool from_above = false;  ///< whether the side from which the triangle is counterclockwise faces up
};

using Point2 = std::array<Real, 2>;

Real area(const Point2& a, const Point2& b, const Point2& c)
{
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/// Returns the same answer for an edge in both of its triangles, so that a line through an edge crosses only one of
/// them.
bool is_left_of(const Point2& from, const Point2& to, const Point2& point)
{
    if (to < from) return !is_left_of(to, from, point);
    return area(from, to, point) > 0;
}

std::optional<Crossing> crossing(const Scene& scene, std::uint32_t triangle, const Line& line)
{
    std::array<Point2, 3> seen;  // seen along the line
    std::array<Real, 3> z;
    for (int i = 0; i < 3; ++i) {
        const Vec3& vertex = scene.vertices[scene.triangles[triangle][i]];
        z[i] = vertex.z();
        const Real rise = z[i] - Real(line.through.z());
        seen[i] = {vertex.x() - line.lean_x * rise, vertex.y() - line.lean_y * rise};
    }
    const Point2 point = {line.through.x(), line.through.y()};
    const bool left = is_left_of(seen[0], seen[1], point);
    if (is_left_of(seen[1], seen[2], point) != left || is_left_of(seen[2], seen[0], point) != left) return {};
    const Real a = area(seen[1], seen[2], point), b = area(seen[2], seen[0], point), c = area(seen[0], seen[1], point);
    if (a + b + c == 0) return {};
    const auto [low, high] = std::minmax_element(z.begin(), z.end());
    const Real height = std::clamp((a * z[0] + b * z[1] + c * z[2]) / (a + b + c), *low, *high);
    return Crossing{double(height), scene.triangle_labels[triangle], left};
}

/// Returns the crossings of a piece, sorted from the lowest to the highest.
std::vector<Crossing> crossings(const Scene& scene, const Piece& piece, const Line& line)
{
    std::vector<Crossing> found;
    for (std::uint32_t i = 0; i < piece.triangle_count; ++i)
        if (const auto hit = crossing(scene, piece.first_triangle + i, line)) found.push_back(*hit);
    std::sort(found.begin(), found.end(), [](const Crossing& a, const Crossing& b) { return a.z < b.z; });
    return found;
}

bool is_inside(const Scene& scene, const Piece& piece, const Vec3& point)
{
    if (!piece.solid || scene.triangle_labels[piece.first_triangle] == Label::Water) return false;
    // The slopes of the line are not round numbers, so that it meets edges of walls and floors only by chance.
    const auto found = crossings(scene, piece, {point, 0.0917, 0.0583});
    return std::count_if(found.begin(), found.end(), [&](const Crossing& hit) { return hit.z > point.z(); }) % 2 == 1;
}

// ---- Collision of one robot part ----

bool is_solid(Label label) { return label == Label::Terrain || label == Label::Obstacle; }

bool touches_triangles(const Scene& scene, const Convex& body, double grow)
{
    Bounds near;
    for (const Vec3& corner : body.corners) near.extend(corner);
    near.min.array() -= body.radius + std::max(grow, 0.0);
    near.max.array() += body.radius + std::max(grow, 0.0);
    for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
        if (!is_solid(scene.triangle_labels[i])) continue;
        const Triangle& t = scene.triangles[i];
        const Vec3 &a = scene.vertices[t[0]], &b = scene.vertices[t[1]], &c = scene.vertices[t[2]];
        const bool beside = (a.cwiseMin(b).cwiseMin(c).array() > near.max.array()).any() ||
                            (a.cwiseMax(b).cwiseMax(c).array() < near.min.array()).any();
        if (!beside && touches(body, polytope({a, b, c}, {{0, 1, 2}}), grow)) return true;
    }
    return false;
}

bool touches_primitives(const Scene& scene, const Convex& body, double grow, Rounding rounding)
{
    return std::any_of(scene.primitives.begin(), scene.primitives.end(), [&](const Primitive& primitive) {
        return is_solid(primitive.label) &&
               touches(body, convex_of(primitive.shape, primitive.shape.pose, rounding), grow);
    });
}

/// Returns whether the body is inside a filled mesh. A body that touches no triangle is completely inside or completely
/// outside.
bool is_inside_mesh(const Scene& scene, const Convex& body)
{
    const Vec3 point = middle(body);
    return std::any_of(scene.pieces.begin(), scene.pieces.end(),
                       [&](const Piece& piece) { return is_inside(scene, piece, point); });
}

// ---- Vertical lines through primitives ----

/// An interval of a line, by the parameter of the line.
struct Stretch {
    Real from = -infinity, to = infinity;

    bool is_empty() const { return !(from <= to); }
    void clip(const Stretch& other) { *this = {std::max(from, other.from), std::min(to, other.to)}; }
};
constexpr Stretch nowhere = {1, 0};

/// Returns the interval in which |start + t * step| <= half.
Stretch within_slab(Real start, Real step, Real half)
{
    if (std::abs(step) < 1e-15L) return std::abs(start) <= half ? Stretch{} : nowhere;
    const Real s = (-half - start) / step, t = (half - start) / step;
    return {std::min(s, t), std::max(s, t)};
}

/// Returns the interval in which a t^2 + 2 b t + c <= 0, for a >= 0.
Stretch below_zero(Real a, Real b, Real c)
{
    if (a < 1e-24L) return c <= 0 ? Stretch{} : nowhere;
    const Real discriminant = b * b - a * c;
    if (discriminant < 0) return nowhere;
    const Real root = std::sqrt(discriminant);
    return {(-b - root) / a, (-b + root) / a};
}

using Real3 = Eigen::Matrix<Real, 3, 1>;

Stretch within_ball(Real3 start, const Real3& step, const Real3& centre, Real radius)
{
    start -= centre;
    return below_zero(step.dot(step), start.dot(step), start.dot(start) - radius * radius);
}

Stretch within_tube(const Real3& start, const Real3& step, Real radius, Real half_length)
{
    const Real a = step.x() * step.x() + step.y() * step.y();
    const Real b = start.x() * step.x() + start.y() * step.y();
    const Real c = start.x() * start.x() + start.y() * start.y() - radius * radius;
    Stretch stretch = below_zero(a, b, c);
    stretch.clip(within_slab(start.z(), step.z(), half_length));
    return stretch;
}

Stretch within_capsule(const Real3& start, const Real3& step, Real radius, Real half_length)
{
    Stretch all = nowhere;
    for (const Stretch& part :
         {within_tube(start, step, radius, half_length), within_ball(start, step, {0, 0, half_length}, radius),
          within_ball(start, step, {0, 0, -half_length}, radius)}) {
        if (part.is_empty()) continue;
        all = all.is_empty() ? part : Stretch{std::min(all.from, part.from), std::max(all.to, part.to)};
    }
    return all;
}

/// Returns the interval of z in which the vertical line through (x, y) is inside the shape.
Stretch vertical_stretch(const Shape& shape, double x, double y)
{
    const Eigen::Matrix<Real, 3, 3> shape_from_scene = shape.pose.rotation.transpose().cast<Real>();
    const Real3 start = shape_from_scene * (Real3{x, y, 0} - shape.pose.position.cast<Real>());
    const Real3 step = shape_from_scene.col(2);
    const Real3 size = shape.size.cast<Real>();
    switch (shape.kind) {
    case ShapeKind::Sphere: return within_ball(start, step, Real3::Zero(), size.x());
    case ShapeKind::Cylinder: return within_tube(start, step, size.x(), size.y() / 2);
    case ShapeKind::Capsule: return within_capsule(start, step, size.x(), size.y() / 2);
    case ShapeKind::Box:
    case ShapeKind::Hull: break;  // scenes contain no hulls
    }
    Stretch stretch;
    for (int i = 0; i < 3; ++i) stretch.clip(within_slab(start[i], step[i], size[i] / 2));
    return stretch;
}

/// The same for a part of a robot.
Stretch vertical_stretch(const RobotPart& part, const Pose& scene_from_robot, double x, double y)
{
    if (part.shape.kind != ShapeKind::Hull) {
        Shape shape = part.shape;
        shape.pose = scene_from_robot * shape.pose;
        return vertical_stretch(shape, x, y);
    }
    const Convex hull = convex_of(part, scene_from_robot, Rounding::Inscribed);
    Stretch stretch;
    for (std::size_t i = 0; i < hull.faces.size() && !stretch.is_empty(); ++i) {
        const Real3 out = hull.normals[i].cast<Real>();
        const Real at_zero = out.dot(Real3{x, y, 0} - hull.corners[hull.faces[i][0]].cast<Real>());
        if (std::abs(out.z()) < 1e-15L)
            stretch.clip(at_zero <= 0 ? Stretch{} : nowhere);
        else
            stretch.clip(out.z() > 0 ? Stretch{-infinity, -at_zero / out.z()} : Stretch{-at_zero / out.z(), infinity});
    }
    return stretch;
}

/// Returns how far the robot's lowest point on the vertical line through (x, y) is above its origin; 0 if it is not
/// above the origin.
double underside(const Robot& robot, const Pose& scene_from_robot, double x, double y)
{
    Real lowest = infinity;
    for (const RobotPart& part : robot.parts) {
        const Stretch stretch = vertical_stretch(part, scene_from_robot, x, y);
        if (!stretch.is_empty()) lowest = std::min(lowest, stretch.from);
    }
    return lowest == infinity ? 0 : std::max(0.0, double(lowest) - scene_from_robot.position.z());
}

// ---- Columns ----

constexpr double touch = 1e-9;  // surfaces that are closer than this are one, and terrain wins

/// Adds the interval of a solid that lies under one triangle or primitive.
void add_solid(Column& column, double bottom, double top, Label label, std::size_t owner)
{
    if (label == Label::Water)
        column.water.push_back(top);
    else if (is_solid(label))
        column.spans.push_back({bottom, top, label == Label::Terrain, owner});
}

/// Adds a filled piece, which is solid between odd and even crossings. Joins two intervals if the second begins where
/// the first ends, because there is no gap to stand in.
void add_filled_piece(Column& column, const std::vector<Crossing>& hits, std::size_t owner)
{
    for (std::size_t i = 0; i + 1 < hits.size(); i += 2) {
        const double bottom = hits[i].z;
        while (i + 3 < hits.size() && hits[i + 2].z - hits[i + 1].z <= touch) i += 2;
        add_solid(column, bottom, hits[i + 1].z, hits[i + 1].label, owner);
    }
}

void add_sheet(Column& column, const std::vector<Crossing>& hits, const Piece& piece, std::size_t owner)
{
    for (const Crossing& hit : hits) {
        const bool hidden = piece.sides_up && !hit.from_above && hit.label == Label::Terrain;
        add_solid(column, hit.z, hit.z, hidden ? Label::Obstacle : hit.label, owner);
    }
}

// ---- The verdict table ----

struct Limits {
    const Bounds& bounds;
    double max_height, max_water_depth;
    double above = 0;  ///< m; ground counts up to this height above the origin
};

/// A verdict without collisions: Valid if nothing else applies.
struct Footing {
    Verdict verdict = Verdict::Valid;
    std::optional<Span> ground;
};

std::optional<Span> ground_below(const Column& column, double z)
{
    std::optional<Span> ground;
    for (const Span& span : column.spans)
        if (span.top <= z && (!ground || span.top > ground->top)) ground = span;
    for (const Span& span : column.spans)
        if (ground && span.top <= z && span.top >= ground->top - touch) ground->terrain |= span.terrain;
    return ground;
}

/// Returns the verdict without collisions. Raises the water by `rise` m.
Footing footing(const Column& column, const Vec3& position, const Limits& limits, double rise)
{
    const std::optional<Span> ground = ground_below(column, position.z() + limits.above);
    if (!limits.bounds.contains_xy(position.x(), position.y(), 0)) return {Verdict::Outside, ground};
    if (!ground || position.z() - ground->top > limits.max_height) return {Verdict::Aerial, ground};
    if (!ground->terrain) return {Verdict::OffTerrain, ground};
    const bool wet = std::any_of(column.water.begin(), column.water.end(), [&](double surface) {
        const double depth = surface + rise - ground->top;
        return depth >= 0 && depth <= limits.max_water_depth;
    });
    return {wet ? Verdict::Submerged : Verdict::Valid, ground};
}

/// Returns whether two footings are the same. The ground of one piece may change quickly because it is steep; between
/// two pieces any step is another ground.
bool is_same(const Footing& a, const Footing& b, double margin)
{
    if (a.verdict != b.verdict || a.ground.has_value() != b.ground.has_value()) return false;
    if (!a.ground) return true;
    const double limit = a.ground->owner == b.ground->owner ? 20 * margin : 1e-6;
    return std::abs(a.ground->top - b.ground->top) <= limit;
}

/// Returns the places around a position at distance margin.
std::vector<Vec3> neighbours(const Vec3& position, double margin)
{
    std::vector<Vec3> out;
    for (int i = 0; i < 8; ++i)
        out.push_back(position + margin * Vec3{std::cos(M_PI / 4 * i), std::sin(M_PI / 4 * i), 0});
    return out;
}

bool is_unchanged_nearby(const Scene& scene, const Vec3& position, const Limits& limits, const Footing& here,
                         double margin)
{
    for (const Vec3& neighbour : neighbours(position, margin))
        if (!is_same(here, footing(column(scene, neighbour.x(), neighbour.y()), neighbour, limits, 0), margin))
            return false;
    const Column centre = column(scene, position.x(), position.y());
    for (const double shift : {-margin, margin}) {
        if (!is_same(here, footing(centre, position + Vec3{0, 0, shift}, limits, 0), margin)) return false;
        if (!is_same(here, footing(centre, position, limits, shift), margin)) return false;
    }
    return true;
}

}  // namespace

bool collides(const Scene& scene, const Robot& robot, const Pose& scene_from_robot, double grow)
{
    const Rounding rounding = grow < 0 ? Rounding::Inscribed : Rounding::Circumscribed;
    return std::any_of(robot.parts.begin(), robot.parts.end(), [&](const RobotPart& part) {
        const Convex body = convex_of(part, scene_from_robot, rounding);
        return touches_triangles(scene, body, grow) || touches_primitives(scene, body, grow, rounding) ||
               is_inside_mesh(scene, body);
    });
}

Answer collision(const Scene& scene, const Robot& robot, const Pose& scene_from_robot, double margin)
{
    if (!collides(scene, robot, scene_from_robot, margin)) return Answer::No;
    return collides(scene, robot, scene_from_robot, -margin) ? Answer::Yes : Answer::TooClose;
}

Column column(const Scene& scene, double x, double y)
{
    Column column;
    for (std::size_t i = 0; i < scene.pieces.size(); ++i) {
        const Piece& piece = scene.pieces[i];
        const auto hits = crossings(scene, piece, {{x, y, 0}, 0, 0});
        if (piece.solid)
            add_filled_piece(column, hits, i);
        else
            add_sheet(column, hits, piece, i);
    }
    for (std::size_t i = 0; i < scene.primitives.size(); ++i) {
        const Stretch stretch = vertical_stretch(scene.primitives[i].shape, x, y);
        if (stretch.is_empty()) continue;
        add_solid(column, double(stretch.from), double(stretch.to), scene.primitives[i].label, scene.pieces.size() + i);
    }
    return column;
}

std::vector<double> layers(const Scene& scene, double x, double y)
{
    constexpr double tolerance = 1e-6;
    std::vector<Span> terrain = column(scene, x, y).spans;
    std::erase_if(terrain, [](const Span& span) { return !span.terrain; });
    std::sort(terrain.begin(), terrain.end(), [](const Span& a, const Span& b) { return a.bottom < b.bottom; });
    std::vector<double> tops;
    for (const Span& span : terrain) {
        if (!tops.empty() && span.bottom <= tops.back() + tolerance)
            tops.back() = std::max(tops.back(), span.top);
        else
            tops.push_back(span.top);
    }
    std::reverse(tops.begin(), tops.end());
    return tops;
}

namespace {

/// Returns the verdict with the ground up to limits.above over the origin.
Decision decide(const Scene& scene, const Robot& robot, const Pose& scene_from_robot, const Limits& limits,
                double margin)
{
    const Vec3& position = scene_from_robot.position;
    const Footing here = footing(column(scene, position.x(), position.y()), position, limits, 0);
    Decision decision;
    if (here.ground) decision.ground = here.ground->top;
    if (!is_unchanged_nearby(scene, position, limits, here, margin)) return decision;
    decision.verdict = here.verdict;
    if (here.verdict != Verdict::Valid) return decision;
    switch (collision(scene, robot, scene_from_robot, margin)) {
    case Answer::No: break;
    case Answer::Yes: decision.verdict = Verdict::Collision; break;
    case Answer::TooClose: decision.verdict.reset(); break;
    }
    return decision;
}

}  // namespace

Decision decide(const Scene& scene, const Bounds& map_bounds, const Robot& robot, const Pose& scene_from_robot,
                double max_height, double max_water_depth, double margin)
{
    Limits limits = {map_bounds, max_height, max_water_depth};
    const Decision decision = decide(scene, robot, scene_from_robot, limits, margin);
    constexpr std::array for_its_ground = {Verdict::Aerial, Verdict::OffTerrain, Verdict::Submerged};
    if (!decision.verdict || std::ranges::find(for_its_ground, *decision.verdict) == for_its_ground.end())
        return decision;
    // It is also valid if it is valid with the ground between its origin and its underside.
    const Vec3& position = scene_from_robot.position;
    limits.above = underside(robot, scene_from_robot, position.x(), position.y());
    for (const Vec3& neighbour : neighbours(position, margin))
        if (std::abs(underside(robot, scene_from_robot, neighbour.x(), neighbour.y()) - limits.above) > 20 * margin)
            return {.verdict = {}, .ground = decision.ground};
    if (limits.above == 0) return decision;
    const Decision over = decide(scene, robot, scene_from_robot, limits, margin);
    if (over.verdict == Verdict::Valid) return over;
    return over.verdict ? decision : Decision{.verdict = {}, .ground = decision.ground};
}

// ---- Footing ----

namespace {

/// The data of a pose that decide its footing.
struct Stand {
    std::vector<Vec3> contacts;  ///< scene frame
    Vec3 origin;                 ///< on the ground
    double lowest;               ///< z of the robot's lowest point
    double limit;                ///< tangent of the steepest slope
};

/// Returns the upper end of the highest solid that begins at or below z, joined with everything that touches it above.
std::optional<double> surface(const Scene& scene, const Vec3& above, double z)
{
    const Column here = column(scene, above.x(), above.y());
    std::optional<double> top;
    for (const Span& span : here.spans)
        if (span.bottom <= z && (!top || span.top > *top)) top = span.top;
    for (bool grows = top.has_value(); grows;) {
        grows = false;
        for (const Span& span : here.spans)
            if (span.bottom <= *top + 1e-6 && span.top > *top) {
                top = span.top;
                grows = true;
            }
    }
    return top;
}

/// Returns a, b and c of the plane z = a + b x + c y that fits the points best (least squares).
Real3 plane_through(const std::vector<Vec3>& points)
{
    Eigen::Matrix<Real, 3, 3> normal = Eigen::Matrix<Real, 3, 3>::Zero();
    Real3 right = Real3::Zero();
    for (const Vec3& point : points) {
        const Real3 row(1, point.x() - points[0].x(), point.y() - points[0].y());
        normal += row * row.transpose();
        right += row * Real(point.z());
    }
    Real3 plane = normal.fullPivLu().solve(right);
    plane[0] -= plane[1] * points[0].x() + plane[2] * points[0].y();
    return plane;
}

Verdict footing(const Scene& scene, const Stand& stand)
{
    std::vector<Vec3> points;
    bool in_reach = true;
    for (const Vec3& contact : stand.contacts) {
        const auto height = surface(scene, contact, std::max(contact.z(), stand.lowest));
        if (!height) return Verdict::Unstable;
        points.emplace_back(contact.x(), contact.y(), *height);
        const double distance = (contact - stand.origin).head<2>().norm();
        if (std::abs(*height - stand.origin.z()) > distance * stand.limit + 0.02) in_reach = false;
    }
    const Real3 plane = plane_through(points);
    points.push_back(stand.origin);
    Real off = 0, low = infinity, high = -infinity;
    for (const Vec3& point : points) {
        off = std::max(off, std::abs(plane[0] + plane[1] * point.x() + plane[2] * point.y() - point.z()));
        low = std::min<Real>(low, point.z());
        high = std::max<Real>(high, point.z());
    }
    const bool steep = std::hypot(plane[1], plane[2]) > stand.limit;
    if (in_reach) return steep ? Verdict::Steep : Verdict::Valid;
    return steep && off <= 0.02 + 0.1 * (high - low) ? Verdict::Steep : Verdict::Unstable;
}

}  // namespace

std::optional<Verdict> footing(const Scene& scene, const Robot& robot, const std::vector<Vec3>& contacts,
                               const Pose& scene_from_robot, double ground, double max_slope, double margin)
{
    Stand stand = {{}, scene_from_robot.position, infinity, std::tan(max_slope)};
    stand.origin.z() = ground;
    for (const Vec3& contact : contacts) stand.contacts.push_back(moved(scene_from_robot, contact));
    for (const RobotPart& part : robot.parts) {
        const Convex body = convex_of(part, scene_from_robot, Rounding::Inscribed);
        for (const Vec3& corner : body.corners) stand.lowest = std::min(stand.lowest, corner.z() - body.radius);
    }
    std::vector<Stand> variants;
    const auto vary = [&](const Vec3& shift, double rise, double steeper) {
        Stand other = stand;
        for (Vec3& contact : other.contacts) contact += shift;
        other.lowest += shift.z();
        other.origin.z() += rise;
        other.limit *= 1 + steeper;
        variants.push_back(other);
    };
    for (int i = 0; i < 8; ++i) vary(margin * Vec3{std::cos(M_PI / 4 * i), std::sin(M_PI / 4 * i), 0}, 0, 0);
    for (const double sign : {-1.0, 1.0}) {
        vary({0, 0, sign * margin}, 0, 0);
        vary(Vec3::Zero(), sign * margin, 0);
        vary(Vec3::Zero(), 0, sign * margin);
    }
    const Verdict verdict = footing(scene, stand);
    for (const Stand& variant : variants)
        if (footing(scene, variant) != verdict) return {};
    return verdict;
}

}  // namespace slow
