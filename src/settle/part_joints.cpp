#include "settle/part_joints.h"

#include <algorithm>

namespace spawnfield {
namespace {

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

}  // namespace

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

}  // namespace spawnfield
