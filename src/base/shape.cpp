#include "base/number.h"
#include "base/shape_fault.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace spawnfield {
namespace {

/// A vertical line in a shape's own frame: origin + t * direction, where t is the height above the shape's centre.
struct LocalLine {
    Vec3 origin, direction;
};

LocalLine local_line(const Shape& shape, double x, double y)
{
    const Vec3 offset(x - shape.pose.position.x(), y - shape.pose.position.y(), 0);
    return {shape.pose.rotation.transpose() * offset, shape.pose.rotation.row(2).transpose()};
}

/// Clips [t.bottom, t.top] to the part where |origin + t * direction| <= half on one axis. Returns false if nothing
/// remains.
bool clip_slab(double origin, double direction, double half, Interval& t)
{
    const double reach = half + touch_tolerance;
    if (std::abs(direction) < 1e-15) return std::abs(origin) <= reach;
    double near = (-half - origin) / direction;
    double far = (half - origin) / direction;
    if (near > far) std::swap(near, far);
    t.bottom = std::max(t.bottom, near);
    t.top = std::min(t.top, far);
    if (t.bottom <= t.top) return true;
    // A line that grazes an edge misses it only by rounding.
    if (t.bottom - t.top > touch_tolerance) return false;
    t.bottom = t.top;
    return true;
}

std::optional<Interval> ball_interval(double radius, double distance_squared)
{
    const double reach = radius + touch_tolerance;
    if (distance_squared > reach * reach) return std::nullopt;
    const double half = std::sqrt(std::max(0.0, radius * radius - distance_squared));
    return Interval{-half, half};
}

std::optional<Interval> cylinder_interval(double radius, double length, const LocalLine& line)
{
    Interval t{-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
    const double a = line.direction.head<2>().squaredNorm();
    const double b = line.origin.head<2>().dot(line.direction.head<2>());
    const double c = line.origin.head<2>().squaredNorm();
    const double reach = radius + touch_tolerance;
    if (a < 1e-24) {
        if (c > reach * reach) return std::nullopt;
    } else {
        const double closest = c - b * b / a;  // squared distance of the line from the axis
        if (closest > reach * reach) return std::nullopt;
        const double half = std::sqrt(std::max(0.0, radius * radius - closest) / a);
        t = {-b / a - half, -b / a + half};
    }
    if (!clip_slab(line.origin.z(), line.direction.z(), length / 2, t)) return std::nullopt;
    return t;
}

std::optional<Interval> box_interval(const Vec3& size, const LocalLine& line)
{
    Interval t{-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
    for (int axis = 0; axis < 3; ++axis)
        if (!clip_slab(line.origin[axis], line.direction[axis], size[axis] / 2, t)) return std::nullopt;
    return t;
}

/// Returns the interval of a capsule. It is convex, so the interval spans those of the cylinder and of the two end
/// balls.
std::optional<Interval> capsule_interval(double radius, double length, const LocalLine& line)
{
    std::optional<Interval> joined = cylinder_interval(radius, length, line);
    for (const double end : {-length / 2, length / 2}) {
        const Vec3 from_end = line.origin - Vec3(0, 0, end);
        const double along = -from_end.dot(line.direction);  // t of the closest point
        const auto ball = ball_interval(radius, (from_end + along * line.direction).squaredNorm());
        if (!ball) continue;
        const Interval here{along + ball->bottom, along + ball->top};
        joined = joined ? Interval{std::min(joined->bottom, here.bottom), std::max(joined->top, here.top)} : here;
    }
    return joined;
}

std::optional<Interval> local_interval(const Shape& shape, double x, double y)
{
    const LocalLine line = local_line(shape, x, y);
    switch (shape.kind) {
    case ShapeKind::Box: return box_interval(shape.size, line);
    case ShapeKind::Cylinder: return cylinder_interval(shape.size[0], shape.size[1], line);
    case ShapeKind::Capsule: return capsule_interval(shape.size[0], shape.size[1], line);
    case ShapeKind::Sphere: {
        const double dx = x - shape.pose.position.x(), dy = y - shape.pose.position.y();
        return ball_interval(shape.size[0], dx * dx + dy * dy);
    }
    case ShapeKind::Hull: break;
    }
    assert(false && "hulls have no closed form");
    return std::nullopt;
}

/// Returns whether the elements of Shape::size that the kind of shape uses are finite and > 0.
bool has_sizes(const Shape& shape)
{
    const auto used = shape.size.head(shape.kind == ShapeKind::Box ? 3 : shape.kind == ShapeKind::Sphere ? 1 : 2);
    return used.allFinite() && (used.array() > 0).all();
}

}  // namespace

bool has_extent(const Shape& shape)
{
    return shape.pose.position.allFinite() && shape.pose.rotation.allFinite() && shape.size.allFinite() &&
           has_sizes(shape);
}

std::string shape_fault(const Shape& shape)
{
    if (!shape.pose.position.allFinite() || !shape.pose.rotation.allFinite())
        return "has a pose with a number that is not finite";
    if (has_sizes(shape)) return "has a size that its kind does not use and that is not finite; set it to 0";
    const Vec3& size = shape.size;
    std::string sizes = "radius " + number(size[0]) + " m";
    if (shape.kind == ShapeKind::Box)
        sizes = number(size[0]) + " x " + number(size[1]) + " x " + number(size[2]) + " m";
    else if (shape.kind != ShapeKind::Sphere)
        sizes += " and length " + number(size[1]) + " m";
    return std::string("is a ") + to_string(shape.kind) + " of " + sizes + ", needs finite sizes > 0 m";
}

const char* to_string(ShapeKind kind)
{
    switch (kind) {
    case ShapeKind::Box: return "box";
    case ShapeKind::Sphere: return "sphere";
    case ShapeKind::Cylinder: return "cylinder";
    case ShapeKind::Capsule: return "capsule";
    case ShapeKind::Hull: break;
    }
    return "hull";
}

std::optional<Interval> vertical_interval(const Shape& shape, double x, double y)
{
    auto interval = local_interval(shape, x, y);
    if (!interval) return std::nullopt;
    return Interval{shape.pose.position.z() + interval->bottom, shape.pose.position.z() + interval->top};
}

Bounds bounds_of(const Shape& shape)
{
    const Mat3& r = shape.pose.rotation;
    Vec3 half = Vec3::Zero();
    switch (shape.kind) {
    case ShapeKind::Box: half = r.cwiseAbs() * (shape.size / 2); break;
    case ShapeKind::Sphere: half = Vec3::Constant(shape.size[0]); break;
    case ShapeKind::Capsule: half = r.col(2).cwiseAbs() * (shape.size[1] / 2) + Vec3::Constant(shape.size[0]); break;
    case ShapeKind::Cylinder: {
        // A disc with normal n reaches radius * sqrt(1 - n_i^2) along axis i.
        const Vec3 disc = (Vec3::Ones() - r.col(2).cwiseAbs2()).cwiseMax(0.0).cwiseSqrt() * shape.size[0];
        half = r.col(2).cwiseAbs() * (shape.size[1] / 2) + disc;
        break;
    }
    case ShapeKind::Hull: assert(false && "a hull's corners are not in its Shape"); break;
    }
    return {shape.pose.position - half, shape.pose.position + half};
}

}  // namespace spawnfield
