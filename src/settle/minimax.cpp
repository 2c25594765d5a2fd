#include "settle/minimax.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>

namespace spawnfield {
namespace {

constexpr int max_pivots = 1000;  // degenerate planes could make the method go in circles

/// An inequality of the linear program: normal . (u, d.x, d.y) >= offset, where u is the height that is minimised.
struct Inequality {
    Vec3 normal;
    double offset;
    int index;  ///< see Minimax::planes
};

Inequality of_plane(std::span<const MinimaxPlane> planes, std::size_t index)
{
    const MinimaxPlane& plane = planes[index];
    return {{1, -plane.gradient.x(), -plane.gradient.y()}, plane.height, int(index)};
}

/// Returns sign * d[axis] >= -limit.
Inequality of_limit(int axis, double sign, double limit)
{
    Vec3 normal = Vec3::Zero();
    normal[axis + 1] = sign;
    return {normal, -limit, -1 - 2 * axis - (sign > 0)};
}

Inequality of_index(std::span<const MinimaxPlane> planes, double limit, int index)
{
    if (index >= 0) return of_plane(planes, std::size_t(index));
    return of_limit((-1 - index) / 2, (-1 - index) % 2 == 1 ? 1 : -1, limit);
}

/// Returns constraints with weights >= 0: the highest plane at d = 0, and the limits towards which it falls.
std::array<Inequality, 3> first_basis(std::span<const MinimaxPlane> planes, double limit)
{
    const auto is_lower = [](const MinimaxPlane& a, const MinimaxPlane& b) { return a.height < b.height; };
    const auto first = std::size_t(std::max_element(planes.begin(), planes.end(), is_lower) - planes.begin());
    const Vec2& slope = planes[first].gradient;
    return {of_plane(planes, first), of_limit(0, slope.x() < 0 ? -1 : 1, limit),
            of_limit(1, slope.y() < 0 ? -1 : 1, limit)};
}

/// Returns the inverse of the matrix whose rows are the normals of the constraints.
Mat3 inverse_of(const std::array<Inequality, 3>& basis)
{
    Mat3 normals;
    for (int k = 0; k < 3; ++k) normals.row(k) = basis[std::size_t(k)].normal.transpose();
    return normals.inverse();
}

/// Returns the largest size of a height that the planes may have within the limits.
double largest_height(std::span<const MinimaxPlane> planes, double limit)
{
    double out = 0;
#pragma omp simd reduction(max : out)
    for (std::size_t k = 0; k < planes.size(); ++k) {
        const MinimaxPlane& plane = planes[k];
        out = std::max(out,
                       std::abs(plane.height) + limit * (std::abs(plane.gradient.x()) + std::abs(plane.gradient.y())));
    }
    return out;
}

/// Returns the constraint (see Minimax::planes) that a point (u, d.x, d.y) violates most, and sets `worst` to by how
/// much. Violations by at most `plane_noise` or `limit_noise` do not count; without others, `worst` remains 0.
int most_violated(std::span<const MinimaxPlane> planes, double limit, const Vec3& point, double plane_noise,
                  double limit_noise, double& worst)
{
    int out = -1;
    double highest = point[0] + plane_noise;
    for (std::size_t k = 0; k < planes.size(); ++k) {
        const MinimaxPlane& plane = planes[k];
        const double height = plane.height + plane.gradient.x() * point[1] + plane.gradient.y() * point[2];
        if (height <= highest) continue;
        highest = height;
        worst = highest - point[0];
        out = int(k);
    }
    for (int axis = 0; axis < 2; ++axis)
        for (const double sign : {-1.0, 1.0}) {
            const double violation = -limit - sign * point[axis + 1];
            if (violation <= std::max(worst, limit_noise)) continue;
            worst = violation;
            out = -1 - 2 * axis - (sign > 0);
        }
    return out;
}

}  // namespace

bool Minimax::is_at_limit() const
{
    for (std::size_t k = 0; k < 3; ++k)
        if (planes[k] < 0 && weights[k] > 0) return true;
    return false;
}

Minimax lowest_of_highest(std::span<const MinimaxPlane> planes, double limit, const std::optional<Minimax>& near)
{
    std::array<Inequality, 3> basis;
    Mat3 inverse;
    bool is_good = false;
    if (near) {
        for (std::size_t k = 0; k < 3; ++k) basis[k] = of_index(planes, limit, near->planes[k]);
        inverse = inverse_of(basis);
        is_good = inverse.allFinite() && inverse.row(0).minCoeff() >= 0;
    }
    if (!is_good) {
        basis = first_basis(planes, limit);
        inverse = inverse_of(basis);
    }
    constexpr double rounding = 4 * std::numeric_limits<double>::epsilon();
    const double noise = rounding * largest_height(planes, limit);  // less than this is not a violation

    Minimax out;
    for (int pivot = 0;; ++pivot) {
        const Vec3 offsets(basis[0].offset, basis[1].offset, basis[2].offset);
        const Vec3 point = inverse * offsets, weights = inverse.row(0).transpose();
        out.value = point[0];
        out.at = point.tail<2>();
        for (int k = 0; k < 3; ++k) {
            out.planes[std::size_t(k)] = basis[std::size_t(k)].index;
            out.weights[std::size_t(k)] = std::max(0.0, weights[k]);
        }
        if (pivot == max_pivots) return out;

        double worst = 0;
        const int violated = most_violated(planes, limit, point, noise, rounding * limit, worst);
        if (worst == 0) return out;

        const Inequality entering = of_index(planes, limit, violated);
        const Vec3 share = inverse.transpose() * entering.normal;  // entering = the sum of share[k] * basis[k]
        int leaving = -1;
        double least = std::numeric_limits<double>::infinity();
        for (int k = 0; k < 3; ++k) {
            if (share[k] <= 1e-12) continue;
            const double ratio = std::max(0.0, weights[k]) / share[k];
            if (ratio < least) {
                least = ratio;
                leaving = k;
            }
        }
        if (leaving < 0) return out;  // only rounding leads here: u has no upper limit, so there is a solution
        basis[std::size_t(leaving)] = entering;
        inverse = inverse_of(basis);
    }
}

}  // namespace spawnfield
