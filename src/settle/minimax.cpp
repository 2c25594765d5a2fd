#include "settle/minimax.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>

namespace spawnfield {
namespace {

constexpr int max_pivots = 1000;  // degenerate rows could make the method go in circles

/// The inequality normal . (u, d) >= offset. The index of a plane is >= 0; limits of the variables have -1.
struct Inequality {
    Vec3 normal;
    double offset;
    int index;
};

Inequality of_plane(std::span<const MinimaxRow> rows, std::size_t index)
{
    const MinimaxRow& row = rows[index];
    return {{1, -row.gradient.x(), -row.gradient.y()}, row.height, int(index)};
}

/// Returns sign * d[axis] >= -limit.
Inequality of_limit(int axis, double sign, double limit)
{
    Vec3 normal = Vec3::Zero();
    normal[axis + 1] = sign;
    return {normal, -limit, -1};
}

}  // namespace

bool Minimax::is_at_limit() const
{
    for (std::size_t k = 0; k < 3; ++k)
        if (rows[k] < 0 && weights[k] > 0) return true;
    return false;
}

Minimax lowest_of_highest(std::span<const MinimaxRow> rows, double limit)
{
    const auto highest = std::max_element(rows.begin(), rows.end(),
                                          [](const MinimaxRow& a, const MinimaxRow& b) { return a.height < b.height; });
    const auto first = std::size_t(highest - rows.begin());
    const Vec2& slope = rows[first].gradient;
    std::array<Inequality, 3> basis{of_plane(rows, first), of_limit(0, slope.x() < 0 ? -1 : 1, limit),
                                    of_limit(1, slope.y() < 0 ? -1 : 1, limit)};
    double scale = 0;
    for (const MinimaxRow& row : rows) scale = std::max(scale, std::abs(row.height));
    constexpr double rounding = 4 * std::numeric_limits<double>::epsilon();

    Minimax out;
    for (int pivot = 0;; ++pivot) {
        Mat3 normals;
        Vec3 offsets;
        for (int k = 0; k < 3; ++k) {
            normals.row(k) = basis[std::size_t(k)].normal.transpose();
            offsets[k] = basis[std::size_t(k)].offset;
        }
        const Mat3 inverse = normals.inverse();
        const Vec3 point = inverse * offsets, weights = inverse.row(0).transpose();
        out.value = point[0];
        out.at = point.tail<2>();
        for (int k = 0; k < 3; ++k) {
            out.rows[std::size_t(k)] = basis[std::size_t(k)].index;
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
        double highest_row = point[0] + rounding * scale;
        int violated = -1;
        for (std::size_t k = 0; k < rows.size(); ++k) {
            const double height = rows[k].height + rows[k].gradient.x() * point[1] + rows[k].gradient.y() * point[2];
            if (height <= highest_row) continue;
            highest_row = height;
            violated = int(k);
        }
        if (violated >= 0) {
            entering = of_plane(rows, std::size_t(violated));
            worst = highest_row - point[0];
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
        if (leaving < 0) return out;  // by rounding only: u has no upper limit
        basis[std::size_t(leaving)] = entering;
    }
}

}  // namespace spawnfield
