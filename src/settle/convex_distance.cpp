#include "settle/convex_distance.h"

#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <limits>
#include <optional>

namespace spawnfield {
namespace {

constexpr double precise = 1e-10;  // m: the length is not improved by less than this

/// Points of the difference of two bodies, with the newest one first.
struct Simplex {
    std::array<Vec3, 4> points;
    std::size_t size = 0;

    bool has(const Vec3& point) const
    {
        return std::find(points.begin(), points.begin() + std::ptrdiff_t(size), point) !=
               points.begin() + std::ptrdiff_t(size);
    }
};

/// Returns the point of the plane, line or space through N + 1 points that is nearest to the origin, if it is strictly
/// between them. Returns nothing for points that nearly lie in a smaller space.
template <int N>
std::optional<Vec3> nearest_inside(const std::array<const Vec3*, 4>& points)
{
    Eigen::Matrix<double, 3, N> sides;
    double scale = 1;
    for (int k = 0; k < N; ++k) {
        sides.col(k) = *points[std::size_t(k) + 1] - *points[0];
        scale *= sides.col(k).squaredNorm();
    }
    const Eigen::Matrix<double, N, N> products = sides.transpose() * sides;
    constexpr double flat = 1e-22;
    if (!(products.determinant() > flat * scale)) return std::nullopt;
    const Eigen::Matrix<double, N, 1> shares = products.inverse() * (-(sides.transpose() * *points[0]));
    if (!(shares.minCoeff() > 0) || !(shares.sum() < 1)) return std::nullopt;
    return Vec3(*points[0] + sides * shares);
}

/// Returns the point of the simplex that is nearest to the origin, and leaves only the points of the face that has it.
/// That face has the newest point, or else that point would not have been nearer to the origin than the others.
Vec3 reduce(Simplex& simplex)
{
    Vec3 nearest = simplex.points[0];
    std::size_t best = 1;  // bit k is set for point k
    for (std::size_t face = 3; face < (std::size_t{1} << simplex.size); face += 2) {
        std::array<const Vec3*, 4> points{};
        std::size_t count = 0;
        for (std::size_t k = 0; k < simplex.size; ++k)
            if ((face >> k & 1) != 0) points[count++] = &simplex.points[k];
        const std::optional<Vec3> found = count == 2   ? nearest_inside<1>(points)
                                          : count == 3 ? nearest_inside<2>(points)
                                                       : nearest_inside<3>(points);
        if (!found || !(found->squaredNorm() < nearest.squaredNorm())) continue;
        nearest = *found;
        best = face;
    }
    std::size_t kept = 0;
    for (std::size_t k = 0; k < simplex.size; ++k)
        if ((best >> k & 1) != 0) simplex.points[kept++] = simplex.points[k];
    simplex.size = kept;
    return nearest;
}

/// Returns a point that is farthest in a direction, of the body without its balls.
Vec3 core_support(const Convex& body, const Vec3& direction)
{
    if (body.ball == 0) return body.support(direction);
    return *std::max_element(body.points.begin(), body.points.end(),
                             [&](const Vec3& p, const Vec3& q) { return p.dot(direction) < q.dot(direction); });
}

}  // namespace

Vec3 shortest_way(const Convex& a, const Convex& b)
{
    constexpr int most_steps = 200;
    Simplex simplex;
    Vec3 way = b.points.front() - a.points.front();
    for (int step = 0; step < most_steps; ++step) {
        const double length = way.norm();
        if (length <= precise) return Vec3::Zero();
        const Vec3 point = core_support(b, -way) - core_support(a, way);
        if (way.dot(way - point) <= precise * length || simplex.has(point)) break;
        std::copy_backward(simplex.points.begin(), simplex.points.begin() + std::ptrdiff_t(simplex.size),
                           simplex.points.begin() + std::ptrdiff_t(simplex.size) + 1);
        simplex.points[0] = point;
        ++simplex.size;
        const Vec3 next = reduce(simplex);
        if (step > 0 && !(next.squaredNorm() < way.squaredNorm())) break;
        way = next;
        if (simplex.size == 4) return Vec3::Zero();
    }
    const double length = way.norm(), balls = a.ball + b.ball;
    return length <= balls ? Vec3(Vec3::Zero()) : Vec3(way * (1 - balls / length));
}

}  // namespace spawnfield
