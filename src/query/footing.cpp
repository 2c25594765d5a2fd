#include "query/footing.h"

#include "base/intervals.h"
#include "free_space/footprint.h"
#include "robot/contacts.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace spawnfield {
namespace {

constexpr double step = 0.02;  // m by which the surface under a contact may always be higher or lower than the ground
constexpr double evenness = 0.1;   // a slope may be uneven by this share of the range of its heights
constexpr double rounding = 1e-9;  // tolerance of gradients

/// Writes the solids of the column to `out`, from the bottom up; solids that touch count as one.
void join_solids(const Column& column, std::vector<Interval>& out)
{
    out.clear();
    for (const Span& span : column.spans) out.push_back({span.bottom, span.top});
    join_intervals(out, layer_tolerance);
}

/// Returns the top of the highest solid that begins at or below z.
std::optional<double> surface_below(const std::vector<Interval>& solids, double z)
{
    for (auto solid = solids.rbegin(); solid != solids.rend(); ++solid)
        if (solid->bottom <= z + touch_tolerance) return solid->top;
    return std::nullopt;
}

}  // namespace

Footing::Footing(const Geometry& geometry, const Robot& robot, double max_slope)
    : geometry_(&geometry), robot_(&robot), points_(contacts_of(robot)), lowest_(robot.bounds().min.z()),
      steepest_(std::tan(max_slope))
{
    set_rotation(Mat3::Identity());
}

void Footing::set_rotation(const Mat3& rotation)
{
    const double lowest = rotation(2, 2) == 1 ? lowest_ : lowest_point(*robot_, rotation);
    std::vector<Vec3> turned;
    for (const Vec3& point : points_) turned.push_back(rotation * point);
    contacts_.clear();
    columns_at_.reset();
    if (!span_area(turned)) return;

    const Vec3 sum = std::accumulate(turned.begin(), turned.end(), Vec3(Vec3::Zero()));
    middle_ = sum.head<2>() / double(turned.size());
    Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
    for (const Vec3& point : turned) scatter += (point.head<2>() - middle_) * (point.head<2>() - middle_).transpose();
    const Eigen::Matrix2d inverse = scatter.inverse();
    for (const Vec3& point : turned) {
        const Vec2 shift = point.head<2>();
        contacts_.push_back(
            {shift, std::max(point.z(), lowest), shift.norm() * steepest_ + step, inverse * (shift - middle_), {}});
    }
}

void Footing::set_columns(double x, double y)
{
    if (columns_at_ == Vec2(x, y)) return;
    columns_at_.reset();  // remains empty if column_at() throws because a tile is damaged
    for (Contact& contact : contacts_)
        join_solids(column_at(*geometry_, x + contact.shift.x(), y + contact.shift.y()), contact.solids);
    columns_at_ = Vec2(x, y);
}

Verdict Footing::judge(const Vec3& position, double ground)
{
    if (contacts_.empty()) return Verdict::Unstable;
    set_columns(position.x(), position.y());
    rises_.clear();
    bool all_in_reach = true;
    for (const Contact& contact : contacts_) {
        const std::optional<double> surface = surface_below(contact.solids, position.z() + contact.level);
        if (!surface) return Verdict::Unstable;
        rises_.push_back(*surface - ground);
        all_in_reach = all_in_reach && std::abs(rises_.back()) <= contact.reach + touch_tolerance;
    }
    const Vec2 slope = gradient();
    const bool is_steep = slope.norm() > steepest_ + rounding;
    if (all_in_reach) return is_steep ? Verdict::Steep : Verdict::Valid;
    return is_steep && is_even(slope) ? Verdict::Steep : Verdict::Unstable;
}

/// Returns the gradient of the plane that fits the surfaces best (least squares of heights).
Vec2 Footing::gradient() const
{
    Vec2 out = Vec2::Zero();
    for (std::size_t i = 0; i < contacts_.size(); ++i) out += rises_[i] * contacts_[i].weight;
    return out;
}

/// Returns whether the surfaces and the pose's ground lie near the plane with this gradient. They do on a slope, but
/// not at an edge.
bool Footing::is_even(const Vec2& gradient) const
{
    const double mean = std::accumulate(rises_.begin(), rises_.end(), 0.0) / double(rises_.size());
    // The ground at the origin counts too; its height is 0 here.
    double farthest = std::abs(mean - gradient.dot(middle_)), lowest = 0, highest = 0;
    for (std::size_t i = 0; i < contacts_.size(); ++i) {
        farthest = std::max(farthest, std::abs(mean + gradient.dot(contacts_[i].shift - middle_) - rises_[i]));
        lowest = std::min(lowest, rises_[i]);
        highest = std::max(highest, rises_[i]);
    }
    return farthest <= step + evenness * (highest - lowest);
}

}  // namespace spawnfield
