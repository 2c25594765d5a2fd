#include "settle/friction.h"

#include "base/polygon2.h"

#include <Eigen/Geometry>
#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace spawnfield {
namespace {

constexpr int pyramid_edges = 16;
/// The forces balance if what is left of the weight (1) and of the moments (m) is at most this. It is more than what a
/// robot at rest may be out of balance by rounding.
constexpr double balance_tolerance = 1e-5;

using Wrench = Eigen::Matrix<double, 6, 1>;  // force, then moment about the centre of mass
using Wrenches = Eigen::Matrix<double, 6, Eigen::Dynamic>;

/// Returns the wrenches of forces along the edges of the contacts' friction pyramids.
Wrenches wrenches_of(std::span<const RestContact> contacts, const Vec3& mass, double friction)
{
    Wrenches out(6, Eigen::Index(contacts.size()) * pyramid_edges);
    Eigen::Index column = 0;
    for (const RestContact& contact : contacts) {
        const Vec3 across = contact.normal.unitOrthogonal(), other = contact.normal.cross(across);
        for (int k = 0; k < pyramid_edges; ++k) {
            const double angle = 2 * std::numbers::pi * k / pyramid_edges;
            const Vec3 tangent = std::cos(angle) * across + std::sin(angle) * other;
            const Vec3 force = (contact.normal + friction * tangent).normalized();
            out.col(column++) << force, (contact.point - mass).cross(force);
        }
    }
    return out;
}

/// Returns the smallest distance of `wanted` from the sums of the columns with weights >= 0. Source: Lawson, Hanson,
/// Solving Least Squares Problems, 1974, algorithm NNLS.
double distance_from_cone(const Wrenches& columns, const Wrench& wanted)
{
    constexpr double rounding = 1e-12;
    const int most_steps = int(3 * columns.cols());
    Eigen::VectorXd weights = Eigen::VectorXd::Zero(columns.cols());
    std::vector<Eigen::Index> used;
    Wrench rest = wanted;
    for (int step = 0; step < most_steps; ++step) {
        Eigen::Index best = 0;
        if ((columns.transpose() * rest).maxCoeff(&best) <= rounding) break;
        if (std::find(used.begin(), used.end(), best) != used.end()) break;  // only rounding is left
        used.push_back(best);
        while (!used.empty()) {
            Wrenches chosen(6, Eigen::Index(used.size()));
            for (std::size_t k = 0; k < used.size(); ++k) chosen.col(Eigen::Index(k)) = columns.col(used[k]);
            const Eigen::VectorXd aim = chosen.colPivHouseholderQr().solve(wanted);
            double share = 1;
            for (std::size_t k = 0; k < used.size(); ++k) {
                const double weight = weights[used[k]], next = aim[Eigen::Index(k)];
                if (next <= 0) share = std::min(share, weight > 0 ? weight / (weight - next) : 0.0);
            }
            for (std::size_t k = 0; k < used.size(); ++k)
                weights[used[k]] += share * (aim[Eigen::Index(k)] - weights[used[k]]);
            if (share == 1) break;
            std::erase_if(used, [&](Eigen::Index column) {
                const bool is_empty = weights[column] <= rounding;
                if (is_empty) weights[column] = 0;
                return is_empty;
            });
        }
        rest = wanted - columns * weights;
    }
    return rest.norm();
}

}  // namespace

bool is_held(std::span<const RestContact> contacts, const Vec3& mass, double friction)
{
    // Mostly, vertical forces hold it: at contacts whose normal is near enough to the vertical.
    const double least_z = 1 / std::sqrt(1 + friction * friction);
    Polygon2 support;
    support.reserve(contacts.size());
    for (const RestContact& contact : contacts)
        if (contact.normal.z() >= least_z) support.push_back(contact.point.head<2>());
    support = convex_hull(std::move(support));
    if (support.size() >= 3 && contains(support, mass.head<2>())) return true;
    if (contacts.empty()) return false;
    Wrench weight = Wrench::Zero();
    weight.z() = 1;
    return distance_from_cone(wrenches_of(contacts, mass, friction), weight) <= balance_tolerance;
}

double friction_needed(std::span<const RestContact> contacts, const Vec3& mass, double least)
{
    constexpr double most = 10, precision = 0.01, finest = 1e-4;
    if (!is_held(contacts, mass, most)) return std::numeric_limits<double>::infinity();
    double held = most;
    while (held - least > std::max(precision * held, finest)) {
        const double middle = (least + held) / 2;
        (is_held(contacts, mass, middle) ? held : least) = middle;
    }
    return held;
}

Vec3 mass_center_at(const SettledPose& pose, const Vec3& mass_center)
{
    const Pose at = pose.lifted(0);
    return at.position + at.rotation * mass_center;
}

}  // namespace spawnfield
