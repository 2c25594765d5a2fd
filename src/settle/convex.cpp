#include "settle/convex.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace spawnfield {
namespace {

/// Adds the edges and planes of a polyhedron whose faces are triangles. Edges between faces in one plane are left out.
void add_faces(Convex& body, const std::vector<std::array<int, 3>>& faces)
{
    struct Side {
        std::array<int, 2> edge;
        int plane;
    };
    std::vector<Side> sides;
    for (const auto& face : faces) {
        const Vec3 &a = body.points[std::size_t(face[0])], &b = body.points[std::size_t(face[1])],
                   &c = body.points[std::size_t(face[2])];
        const Vec3 normal = (b - a).cross(c - a).normalized();
        if (!(normal.squaredNorm() > 0)) continue;  // a face without area
        const auto is_same = [&](const Convex::Plane& plane) { return (plane.normal - normal).norm() < 1e-9; };
        const auto found = std::find_if(body.planes.begin(), body.planes.end(), is_same);
        const int plane = int(found - body.planes.begin());
        if (found == body.planes.end()) body.planes.push_back({normal, normal.dot(a)});
        for (std::size_t k = 0; k < 3; ++k)
            sides.push_back({{std::min(face[k], face[(k + 1) % 3]), std::max(face[k], face[(k + 1) % 3])}, plane});
    }
    std::stable_sort(sides.begin(), sides.end(), [](const Side& l, const Side& r) { return l.edge < r.edge; });
    for (std::size_t i = 0; i < sides.size(); ++i) {
        if (i > 0 && sides[i].edge == sides[i - 1].edge) continue;
        const bool is_shared = i + 1 < sides.size() && sides[i + 1].edge == sides[i].edge;
        const int plane = sides[i].plane, other = is_shared ? sides[i + 1].plane : plane;
        if (is_shared && plane == other) continue;
        body.edges.push_back(sides[i].edge);
        body.edge_planes.push_back({plane, other});
    }
}

}  // namespace

Vec3 Convex::support(const Vec3& direction) const
{
    const Vec3* best = &points.front();
    double farthest = best->dot(direction);
    for (const Vec3& point : points) {
        const double reach = point.dot(direction);
        if (reach <= farthest) continue;
        farthest = reach;
        best = &point;
    }
    if (ball > 0) return *best + ball * direction.normalized();
    if (disc == 0) return *best;
    Vec3 outward = direction - direction.dot(axis) * axis;
    if (outward.norm() <= 1e-14 * direction.norm()) return *best;
    outward -= outward.dot(axis) * axis;  // repeated: in a short vector, the first rounding error is a large share
    return *best + disc * outward.normalized();
}

Bounds Convex::bounds() const
{
    Bounds out;
    for (const Vec3& point : points) out.extend(point);
    Vec3 around = Vec3::Constant(ball);
    if (disc > 0) around = disc * (Vec3::Ones() - axis.cwiseProduct(axis)).cwiseMax(0).cwiseSqrt();
    out.min -= around;
    out.max += around;
    return out;
}

Convex convex_of(const Shape& shape)
{
    Convex out;
    switch (shape.kind) {
    case ShapeKind::Box: {
        for (int corner = 0; corner < 8; ++corner)
            out.points.push_back(
                0.5 * shape.size.cwiseProduct(Vec3(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1)));
        for (int corner = 0; corner < 8; ++corner)
            for (int along = 0; along < 3; ++along) {
                if (corner & 1 << along) continue;
                const auto face = [&](int axis) { return 2 * axis + (corner >> axis & 1); };  // index in planes
                out.edges.push_back({corner, corner | 1 << along});
                out.edge_planes.push_back({face((along + 1) % 3), face((along + 2) % 3)});
            }
        for (int axis = 0; axis < 3; ++axis)
            for (const double sign : {-1.0, 1.0}) out.planes.push_back({sign * Vec3::Unit(axis), shape.size[axis] / 2});
        break;
    }
    case ShapeKind::Sphere:
        out.points = {Vec3::Zero()};
        out.ball = shape.size[0];
        break;
    case ShapeKind::Cylinder:
    case ShapeKind::Capsule:
        out.points = {{0, 0, -shape.size[1] / 2}, {0, 0, shape.size[1] / 2}};
        (shape.kind == ShapeKind::Capsule ? out.ball : out.disc) = shape.size[0];
        break;
    case ShapeKind::Hull: break;
    }
    return moved(out, shape.pose);
}

Convex convex_of(const RobotPart& part)
{
    if (part.shape.kind != ShapeKind::Hull) return convex_of(part.shape);
    Convex out;
    out.points = part.hull_vertices;
    add_faces(out, part.hull_faces);
    return out;
}

Convex convex_of(const std::array<Vec3, 3>& triangle)
{
    Convex out;
    out.points.assign(triangle.begin(), triangle.end());
    out.is_triangle = true;
    const auto& [a, b, c] = triangle;
    const Vec3 normal = (b - a).cross(c - a).normalized();
    const bool has_area = normal.squaredNorm() > 0;  // otherwise, only its edges and corners can touch
    if (has_area) {
        out.planes.push_back({normal, normal.dot(a)});
        out.planes.push_back({-normal, -normal.dot(a)});
    }
    for (int k = 0; k < 3; ++k) {
        out.edges.push_back({k, (k + 1) % 3});
        if (!has_area) continue;
        const Vec3 &from = triangle[std::size_t(k)], &to = triangle[std::size_t(k + 1) % 3];
        const Vec3 side = (to - from).cross(normal).normalized();
        out.planes.push_back({side, side.dot(from)});
    }
    return out;
}

Convex convex_of(const Vec3& point)
{
    Convex out;
    out.points = {point};
    return out;
}

Convex moved(const Convex& body, const Pose& parent_from_body)
{
    Convex out = body;
    for (Vec3& point : out.points) point = parent_from_body.rotation * point + parent_from_body.position;
    out.axis = parent_from_body.rotation * body.axis;
    out.across = parent_from_body.rotation * body.across;
    for (Convex::Plane& plane : out.planes) {
        plane.normal = parent_from_body.rotation * plane.normal;
        plane.offset += plane.normal.dot(parent_from_body.position);
    }
    return out;
}

void set_rotated(Convex& out, const Convex& body, const Mat3& rotation)
{
    for (std::size_t k = 0; k < body.points.size(); ++k) out.points[k] = rotation * body.points[k];
    out.axis = rotation * body.axis;
    out.across = rotation * body.across;
    for (std::size_t k = 0; k < body.planes.size(); ++k) out.planes[k].normal = rotation * body.planes[k].normal;
}

Convex upside_down(const Convex& body)
{
    Convex out = body;
    for (Vec3& point : out.points) point.z() = -point.z();
    out.axis.z() = -out.axis.z();
    out.across.z() = -out.across.z();
    for (Convex::Plane& plane : out.planes) plane.normal.z() = -plane.normal.z();
    return out;
}

std::vector<Convex> ends_of(const Convex& body)
{
    if (body.is_polyhedron() || body.points.size() < 2) return {};
    std::vector<Convex> out(body.points.size(), body);
    for (std::size_t k = 0; k < out.size(); ++k) out[k].points = {body.points[k]};
    return out;
}

}  // namespace spawnfield
