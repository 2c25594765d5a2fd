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

}  // namespace

bool Minimax::is_at_limit() const
{
    for (std::size_t k = 0; k < 3; ++k)
        if (planes[k] < 0 && weights[k] > 0) return true;
    return false;
}

Minimax lowest_of_highest(std::span<const MinimaxPlane> planes, double limit, const std::optional<Minimax>& near)
{
    std::array<Inequality, 3> basis = first_basis(planes, limit);
    if (near) {
        std::array<Inequality, 3> better;
        for (std::size_t k = 0; k < 3; ++k) better[k] = of_index(planes, limit, near->planes[k]);
        const Mat3 inverse = inverse_of(better);
        if (inverse.allFinite() && inverse.row(0).minCoeff() >= 0) basis = better;
    }
    double scale = 0;  // of the heights that are compared below, so that rounding does not look like a violation
    for (const MinimaxPlane& plane : planes)
        scale = std::max(scale, std::abs(plane.height) + limit * plane.gradient.lpNorm<1>());
    constexpr double rounding = 4 * std::numeric_limits<double>::epsilon();

    Minimax out;
    for (int pivot = 0;; ++pivot) {
        Vec3 offsets;
        for (int k = 0; k < 3; ++k) offsets[k] = basis[std::size_t(k)].offset;
        const Mat3 inverse = inverse_of(basis);
        const Vec3 point = inverse * offsets, weights = inverse.row(0).transpose();
        out.value = point[0];
        out.at = point.tail<2>();
        for (int k = 0; k < 3; ++k) {
            out.planes[std::size_t(k)] = basis[std::size_t(k)].index;
            out.weights[std::size_t(k)] = std::max(0.0, weights[k]);
        }
        if (pivot == max_pivots) return out;

        Inequality entering{Vec3::Zero(), 0, -1};
        double worst = 0;
        const auto consider = [&](const Inequality& inequality, double tolerance) {
            const double violation = inequality.offset - inequality.normal.dot(point);
            if (violation <= std::max(worst, tolerance)) return;
            worst = violation;
            entering = inequality;
        };
        double highest = point[0] + rounding * scale;
        int violated = -1;
        for (std::size_t k = 0; k < planes.size(); ++k) {
            const MinimaxPlane& plane = planes[k];
            const double height = plane.height + plane.gradient.x() * point[1] + plane.gradient.y() * point[2];
            if (height <= highest) continue;
            highest = height;
            violated = int(k);
        }
        if (violated >= 0) {
            entering = of_plane(planes, std::size_t(violated));
            worst = highest - point[0];
        }
        for (int axis = 0; axis < 2; ++axis)
            for (const double sign : {-1.0, 1.0}) consider(of_limit(axis, sign, limit), rounding * limit);
        if (worst == 0) return out;

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
    }
}

}  // namespace spawnfield
