#include "robot/contacts.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace spawnfield {
namespace {

constexpr int disc_corners = 32;
constexpr int capsule_balls = 17;      ///< spheres along the straight part of a capsule
constexpr double least_spread = 1e-6;  // m

void add_circle(const Vec3& centre, const Vec3& u, const Vec3& v, std::vector<Vec3>& out)
{
    for (int k = 0; k < disc_corners; ++k) {
        const double angle = 2 * std::numbers::pi * k / disc_corners;
        out.push_back(centre + std::cos(angle) * u + std::sin(angle) * v);
    }
}

/// Adds the widest circle of a ball at or below height z. Adds nothing if the whole ball is above z.
void add_cap(const Vec3& centre, double radius, double z, std::vector<Vec3>& out)
{
    const double level = std::min(z, centre.z()), depth = centre.z() - level;
    if (depth > radius) return;
    const double reach = std::sqrt(radius * radius - depth * depth);
    add_circle({centre.x(), centre.y(), level}, reach * Vec3::UnitX(), reach * Vec3::UnitY(), out);
}

/// Returns points of the part whose convex hull is about as wide as the part at and below height z: the corners of
/// hulls and boxes, and points on circles of round shapes.
std::vector<Vec3> corners_of(const RobotPart& part, double z)
{
    const Pose& pose = part.shape.pose;
    const Vec3& size = part.shape.size;
    const Vec3 half_axis = size[1] / 2 * pose.rotation.col(2);
    std::vector<Vec3> out;
    switch (part.shape.kind) {
    case ShapeKind::Hull: return part.hull_vertices;
    case ShapeKind::Box:
        for (int corner = 0; corner < 8; ++corner) {
            const Vec3 side(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
            out.push_back(pose.rotation * (0.5 * size.cwiseProduct(side)) + pose.position);
        }
        break;
    case ShapeKind::Sphere: add_cap(pose.position, size[0], z, out); break;
    case ShapeKind::Cylinder:
        for (const double end : {-1.0, 1.0})
            add_circle(pose.position + end * half_axis, size[0] * pose.rotation.col(0), size[0] * pose.rotation.col(1),
                       out);
        break;
    case ShapeKind::Capsule:
        for (int k = 0; k < capsule_balls; ++k)
            add_cap(pose.position + (2.0 * k / (capsule_balls - 1) - 1) * half_axis, size[0], z, out);
        break;
    }
    return out;
}

/// Cuts the convex hull of the corners at height z. Adds points, seen from above, whose convex hull is the part at or
/// below z.
void add_below(const std::vector<Vec3>& corners, double z, Polygon2& out)
{
    for (const Vec3& low : corners) {
        if (low.z() > z) continue;
        out.push_back(low.head<2>());
        for (const Vec3& high : corners)
            if (high.z() > z) out.push_back((low + (z - low.z()) / (high.z() - low.z()) * (high - low)).head<2>());
    }
}

double distance_to_line(const Vec2& p, const Vec2& from, const Vec2& to)
{
    const double length = (to - from).norm();
    return length > 0 ? std::abs(cross(to - from, p - from)) / length : (p - from).norm();
}

/// Returns the hull without the corners that lie, apart from rounding, on the line between others: rounding could leave
/// such a corner on one side of a symmetric robot and not on the other. Goes round from the corner farthest from the
/// mean, which is certainly not such a corner.
Polygon2 without_flat_corners(const Polygon2& hull)
{
    if (hull.size() < 4) return hull;
    const std::size_t n = hull.size();
    const Vec2 mean = std::accumulate(hull.begin(), hull.end(), Vec2(Vec2::Zero())) / double(n);
    const auto is_nearer = [&](const Vec2& a, const Vec2& b) { return (a - mean).norm() < (b - mean).norm(); };
    const std::size_t first = std::size_t(std::max_element(hull.begin(), hull.end(), is_nearer) - hull.begin());
    const auto corner = [&](std::size_t k) -> const Vec2& { return hull[(first + k) % n]; };
    const auto are_flat = [&](std::size_t from, std::size_t to) {  // all corners between the two
        for (std::size_t k = from + 1; k < to; ++k)
            if (distance_to_line(corner(k), corner(from), corner(to)) > least_spread) return false;
        return true;
    };
    Polygon2 out;
    for (std::size_t kept = 0; kept < n;) {
        out.push_back(corner(kept));
        std::size_t next = kept + 1;
        while (next < n && are_flat(kept, next + 1)) ++next;
        kept = next;
    }
    return out;
}

}  // namespace

bool span_area(std::span<const Vec3> points)
{
    Vec2 mean = Vec2::Zero();
    for (const Vec3& p : points) mean += p.head<2>() / double(points.size());
    double xx = 0, xy = 0, yy = 0;
    for (const Vec3& p : points) {
        const Vec2 from_mean = p.head<2>() - mean;
        xx += from_mean.x() * from_mean.x();
        xy += from_mean.x() * from_mean.y();
        yy += from_mean.y() * from_mean.y();
    }
    // The smaller eigenvalue of the scatter matrix is its determinant divided by the larger eigenvalue. This form
    // avoids cancellation.
    const double larger = (xx + yy) / 2 + std::hypot((xx - yy) / 2, xy);
    return xx * yy - xy * xy > least_spread * least_spread * double(points.size()) * larger;
}

Polygon2 lowest_footprint(const Robot& robot)
{
    const double z = robot.bounds().min.z() + contact_depth;
    Polygon2 points;
    for (const RobotPart& part : robot.parts) add_below(corners_of(part, z), z, points);
    return without_flat_corners(convex_hull(std::move(points)));
}

std::vector<Vec3> contacts_of(const Robot& robot)
{
    if (span_area(robot.contacts)) return robot.contacts;
    const double z = robot.bounds().min.z() + contact_depth;
    std::vector<Vec3> out;
    for (const Vec2& corner : lowest_footprint(robot)) out.emplace_back(corner.x(), corner.y(), z);
    return out;
}

RobotContacts robot_contacts(const Robot& robot) { return {contacts_of(robot), span_area(robot.contacts)}; }

}  // namespace spawnfield
