#include "scene/moving_part.h"

#include "mesh/face_pieces.h"
#include "robot/hull.h"
#include "scene/pieces.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <stdexcept>

namespace spawnfield {
namespace {

/// A short piece of a path.
struct PathStep {
    Pose from, to;
    double growth;  ///< m by which points may leave the straight ways between the two poses
};

Eigen::AngleAxisd turn_between(const Pose& a, const Pose& b)
{
    return Eigen::AngleAxisd(Mat3(a.rotation.transpose() * b.rotation));
}

/// Returns the pose at a share (0 to 1) of the way between two poses. Both ends are returned as they are.
Pose pose_between(const Pose& a, const Pose& b, double share)
{
    if (share <= 0) return a;
    if (share >= 1) return b;
    const Vec3 position = a.position + share * (b.position - a.position);
    if (a.rotation == b.rotation) return {position, a.rotation};
    const Eigen::AngleAxisd turn = turn_between(a, b);
    return {position, a.rotation * Eigen::AngleAxisd(share * turn.angle(), turn.axis()).toRotationMatrix()};
}

Pose pose_at(const TimedPath& path, double time)
{
    const auto after = std::upper_bound(path.begin(), path.end(), time,
                                        [](double t, const TimedPose& p) { return t < p.time; });
    if (after == path.begin()) return path.front().pose;
    if (after == path.end()) return path.back().pose;
    const TimedPose &a = *(after - 1), &b = *after;
    return pose_between(a.pose, b.pose, (time - a.time) / (b.time - a.time));
}

/// Appends the steps between two poses of a path. `reach` is the largest distance of the part's points from its origin,
/// m.
void append_steps(const Pose& a, const Pose& b, double reach, std::vector<PathStep>& steps)
{
    if (a.rotation == b.rotation) {
        if (a.position != b.position) steps.push_back({a, b, 0});
        return;
    }
    constexpr double rounding = 1e-9;  // m, of the rotations
    const double angle = turn_between(a, b).angle();
    const double count = std::max(1.0, std::ceil(angle / std::sqrt(8 * most_growth / std::max(reach, most_growth))));
    for (double k = 0; k < count; ++k) {
        const double step = angle / count;
        steps.push_back(
            {pose_between(a, b, k / count), pose_between(a, b, (k + 1) / count), reach * step * step / 8 + rounding});
    }
}

/// Returns the steps of a path in a window; none if the part stands still.
std::vector<PathStep> steps_of(const TimedPath& path, const TimeWindow& window, double reach)
{
    std::vector<PathStep> out;
    Pose last = pose_at(path, window.from);
    for (const TimedPose& next : path) {
        if (next.time <= window.from || next.time >= window.to) continue;
        append_steps(last, next.pose, reach, out);
        last = next.pose;
    }
    append_steps(last, pose_at(path, window.to), reach, out);
    return out;
}

void append_primitive(Scene& scene, std::uint32_t part, const Shape& shape)
{
    scene.primitives.push_back({shape, part, scene.parts[part].label});
    ++scene.parts[part].solid_pieces;
}

/// Appends the triangles as one piece, which is filled.
void append_solid(Scene& scene, std::uint32_t part, const std::vector<Vec3>& vertices,
                  const std::vector<Triangle>& triangles)
{
    append_sheet(scene, part, vertices, triangles, false);
    --scene.parts[part].sheet_pieces;
    ++scene.parts[part].solid_pieces;
    scene.pieces.back().solid = true;
    for (const std::uint32_t open : find_pieces(triangles).open_edges) scene.pieces.back().open |= open > 0;
}

/// Appends the convex hull of the points, each of which grows to a cube if `growth` (m, half its side) is > 0. Returns
/// false, and appends nothing, if the points lie in a plane.
bool append_hull(Scene& scene, std::uint32_t part, const std::vector<Vec3>& points, double growth)
{
    std::vector<Vec3> corners;
    for (const Vec3& point : points)
        for (int corner = 0; corner < (growth > 0 ? 8 : 1); ++corner)
            corners.push_back(point + growth * Vec3(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1));
    try {
        const RobotPart hull = convex_hull(corners);
        std::vector<Triangle> triangles;
        for (const auto& [a, b, c] : hull.hull_faces)
            triangles.push_back({std::uint32_t(a), std::uint32_t(b), std::uint32_t(c)});
        append_solid(scene, part, hull.hull_vertices, triangles);
    } catch (const std::domain_error&) {
        return false;
    }
    return true;
}

/// Returns the points at both ends of a step.
std::vector<Vec3> at_both_ends(const std::vector<Vec3>& points, const PathStep& step)
{
    std::vector<Vec3> out;
    for (const Pose* const pose : {&step.from, &step.to})
        for (const Vec3& point : points) out.push_back(pose->rotation * point + pose->position);
    return out;
}

/// Appends the space that a ball sweeps whose centre is a point of the part.
void append_ball(Scene& scene, std::uint32_t part, const Vec3& centre, double radius, const PathStep& step)
{
    const std::vector<Vec3> ends = at_both_ends({centre}, step);
    const Vec3 way = ends[1] - ends[0];
    const double length = way.norm(), grown = radius + (centre.isZero() ? 0 : step.growth);
    if (length == 0)
        append_primitive(scene, part, sphere_shape(grown, ends[0]));
    else
        append_primitive(scene, part,
                         capsule_shape(grown, length,
                                       {(ends[0] + ends[1]) / 2,
                                        Eigen::Quaterniond::FromTwoVectors(Vec3::UnitZ(), way).toRotationMatrix()}));
}

/// Returns the corners of a box, or those of the prism around a cylinder or around the straight part of a capsule.
std::vector<Vec3> corners_of(const Shape& shape)
{
    std::vector<Vec3> out;
    if (shape.kind == ShapeKind::Box) {
        for (int corner = 0; corner < 8; ++corner)
            out.push_back(shape.size.cwiseProduct(
                Vec3(corner & 1 ? 0.5 : -0.5, corner & 2 ? 0.5 : -0.5, corner & 4 ? 0.5 : -0.5)));
        return out;
    }
    constexpr int sides = 64;
    const double radius = shape.size[0] / std::cos(std::numbers::pi / sides);
    for (int side = 0; side < sides; ++side)
        for (const double z : {-shape.size[1] / 2, shape.size[1] / 2}) {
            const double angle = 2 * std::numbers::pi * side / sides;
            out.push_back({radius * std::cos(angle), radius * std::sin(angle), z});
        }
    return out;
}

double reach_of(const std::vector<Vec3>& points)
{
    double out = 0;
    for (const Vec3& point : points) out = std::max(out, point.norm());
    return out;
}

/// Appends a piece of a mesh at a pose.
void append_piece(Scene& scene, std::uint32_t part, const Scene& mesh, const Piece& piece, const Pose& pose)
{
    std::map<std::uint32_t, std::uint32_t> numbers;  // of the mesh's vertices in the piece
    std::vector<Vec3> vertices;
    std::vector<Triangle> triangles(mesh.triangles.begin() + piece.first_triangle,
                                    mesh.triangles.begin() + piece.first_triangle + piece.triangle_count);
    for (Triangle& triangle : triangles)
        for (std::uint32_t& corner : triangle) {
            const auto [entry, is_new] = numbers.try_emplace(corner, std::uint32_t(vertices.size()));
            if (is_new) vertices.push_back(pose.rotation * mesh.vertices[corner] + pose.position);
            corner = entry->second;
        }
    if (piece.solid)
        append_solid(scene, part, vertices, triangles);
    else
        append_sheet(scene, part, vertices, triangles, false);
}

/// Appends the space that a triangle sweeps. A triangle that moves in its own plane sweeps the faces of a flat prism.
void append_triangle(Scene& scene, std::uint32_t part, const std::vector<Vec3>& corners, const PathStep& step)
{
    const std::vector<Vec3> points = at_both_ends(corners, step);
    if (append_hull(scene, part, points, step.growth)) return;
    append_sheet(scene, part, points,
                 {{0, 1, 2}, {3, 4, 5}, {0, 1, 3}, {1, 3, 4}, {1, 2, 4}, {2, 4, 5}, {2, 0, 5}, {0, 5, 3}}, false);
}

}  // namespace

bool is_half_turn(const Pose& a, const Pose& b) { return turn_between(a, b).angle() > std::numbers::pi - 1e-6; }

void append_swept(Scene& scene, std::uint32_t part, const Shape& shape, const TimedPath& path, const TimeWindow& window)
{
    const bool is_sphere = shape.kind == ShapeKind::Sphere;
    const std::vector<Vec3> corners = is_sphere ? std::vector<Vec3>{} : corners_of(shape);
    const std::vector<PathStep> steps = steps_of(path, window, reach_of(corners));
    if (steps.empty()) append_primitive(scene, part, {shape.kind, shape.size, pose_at(path, window.from)});
    for (const PathStep& step : steps) {
        if (is_sphere) append_ball(scene, part, Vec3::Zero(), shape.size[0], step);
        if (shape.kind == ShapeKind::Capsule)
            for (const double end : {-0.5, 0.5})
                append_ball(scene, part, {0, 0, end * shape.size[1]}, shape.size[0], step);
        if (!is_sphere) append_hull(scene, part, at_both_ends(corners, step), step.growth);
    }
}

void append_swept(Scene& scene, std::uint32_t part, const Scene& mesh, const TimedPath& path, const TimeWindow& window)
{
    const std::vector<PathStep> steps = steps_of(path, window, reach_of(mesh.vertices));
    const Pose first = pose_at(path, window.from);
    for (const Piece& piece : mesh.pieces)
        if (piece.solid || steps.empty()) append_piece(scene, part, mesh, piece, first);
    for (const Triangle& triangle : mesh.triangles) {
        std::vector<Vec3> corners;
        for (const std::uint32_t corner : triangle) corners.push_back(mesh.vertices[corner]);
        for (const PathStep& step : steps) append_triangle(scene, part, corners, step);
    }
}

}  // namespace spawnfield
