#include "settle/descent.h"

#include "settle/support.h"
#include "settle/underside.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace spawnfield {

double Rest::tilt() const { return std::acos(std::clamp(std::cos(roll) * std::cos(pitch), -1.0, 1.0)); }

Polygon2 Settler::Descent::support_polygon(const Lowered& at, double tolerance)
{
    Polygon2 points;
    points.reserve(at.touches.size());
    for (const RestTouch& t : at.touches)
        if (t.touch.height >= at.z - tolerance) points.push_back(t.touch.point.head<2>());
    return convex_hull(std::move(points));
}

std::vector<RestContact> Settler::Descent::rest_contacts(const Lowered& at) const
{
    std::vector<RestContact> out;
    out.reserve(at.touches.size());
    const auto is_same = [](const RestContact& a, const RestContact& b) {  // for example on both sides of a sheet
        return a.part == b.part && a.ground == b.ground && a.point == b.point &&
               (a.normal - b.normal).norm() <= contact_tolerance;
    };
    for (const RestTouch& t : at.touches) {
        if (t.touch.height < at.z - contact_gap) continue;
        const RestContact contact{t.touch.point + at.z * Vec3::UnitZ(), t.touch.normal.normalized(), t.part,
                                  solids_[t.solid].part, solids_[t.solid].label};
        if (std::none_of(out.begin(), out.end(), [&](const RestContact& other) { return is_same(contact, other); }))
            out.push_back(contact);
    }
    return out;
}

/// Returns the angle by which the robot must be turned about an edge of the support polygon until its mass is above
/// the edge: the smallest of all edges.
double Settler::Descent::tip_over(const Polygon2& polygon, const std::vector<RestContact>& contacts,
                                  const Vec3& mass) const
{
    std::vector<Vec3> corners;
    corners.reserve(polygon.size());
    for (const Vec2& corner : clear_corners(polygon))
        for (const RestContact& contact : contacts)
            if (contact.point.head<2>() == corner) {
                corners.push_back(contact.point);
                break;
            }
    if (corners.size() < 3) return 0;  // a line
    double out = std::numbers::pi / 2;
    for (std::size_t k = 0; k < corners.size(); ++k) {
        const Vec3 &p = corners[k], side = corners[k + 1 < corners.size() ? k + 1 : 0] - p;
        const Vec3 along = side.normalized();
        const Vec3 up = Vec3::UnitZ() - along.z() * along, inward = up.cross(along), arm = mass - p;
        out = std::min(out, std::atan2(arm.dot(inward), arm.dot(up)));
    }
    return out;
}

/// Returns the smallest vertical distance of the solids from the parts of the robot that do not touch them.
double Settler::Descent::belly(const std::vector<RestContact>& contacts)
{
    double out = std::numeric_limits<double>::infinity();
    for (std::size_t p = 0; p < parts_.size(); ++p) {
        if (std::any_of(contacts.begin(), contacts.end(), [&](const RestContact& c) { return c.part == p; })) continue;
        for (const NearSolid& solid : solids_) {
            if (!parts_[p].bounds.meets(solid.bounds, 2) || at_.z - highest_possible(parts_[p], solid) >= out) continue;
            const double highest = touch(parts_[p], solid, {.min_height = at_.z - out});
            if (highest <= at_.z) out = std::min(out, at_.z - highest);
        }
    }
    return std::isfinite(out) ? out : 0;
}

Rest Settler::Descent::rest(Rest::State state)
{
    Rest out;
    out.state = state;
    out.wall = at_.wall;
    out.z = at_.z;
    out.roll = at_.angles[0];
    out.pitch = at_.angles[1];
    if (state == Rest::State::Blocked) return out;
    turn_parts(at_.rotation);
    const Polygon2 polygon = support_polygon(at_, contact_gap);
    const Vec3 mass = at_.rotation * settler_.mass_center_;
    out.headroom = ceiling_above(at_) - at_.z;
    out.contacts = rest_contacts(at_);
    out.belly = belly(out.contacts);
    out.underside = underside_of(parts_).value_or(0);
    if (polygon.size() == 1) out.margin = -(mass.head<2>() - polygon[0]).norm();
    if (polygon.size() >= 2) out.margin = nearest_edge(polygon, mass.head<2>()).distance;
    if (polygon.size() < 3) return out;
    out.tip_over = tip_over(polygon, out.contacts, mass + at_.z * Vec3::UnitZ());
    return out;
}

}  // namespace spawnfield
