#include "settle/descent.h"

#include "settle/support.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace spawnfield {
namespace {

// A robot whose mass is near an edge of the support polygon may rock onto another contact. It still stands there if it
// moves by no more than this.
constexpr double rocking_rise = 0.05;                         // m
constexpr double rocking_turn = 3 * std::numbers::pi / 180;   // rad
constexpr double rolling_turn = 10 * std::numbers::pi / 180;  // rad: the same if it rolls on a line of contacts
constexpr int max_rockings = 6;

}  // namespace

/// If the mass were beyond the nearest edge of the support polygon, the robot would turn about that edge. If it
/// then comes to rest after little motion, it stands on the contacts of both poses. Adds them to a rest with a
/// margin that is too small. If it only rolls on the contacts that it has, they carry the mass at any place up to
/// there, so the edge is moved outwards to there.
void Settler::Descent::rock(Rest& rest)
{
    const Lowered rested = at_;
    const double enough = settler_.options_.min_stability;
    Polygon2 polygon = support_polygon(rested, contact_gap);
    const bool is_line = width(polygon) < enough;
    const Vec3 mass = settler_.mass_center_;
    const Mat3 rotated = rested.rotation;
    for (int k = 0; k < max_rockings && polygon.size() >= 2; ++k) {
        const NearestEdge edge = nearest_edge(polygon, (rotated * mass).head<2>());
        if (edge.distance >= enough - contact_tolerance) break;
        const Vec3 beyond(edge.outward.x(), edge.outward.y(), 0);
        mass_ = mass + rotated.transpose() * (enough * beyond);
        at_ = rested;
        drift_ = Vec2::Zero();
        const Rest::State state = descend(straight_turn);
        if (state == Rest::State::Falling || !is_balanced()) break;  // next to a wall, it may be balanced, too
        std::vector<RestContact> more = rest_contacts(at_);
        std::erase_if(more, [&](const RestContact& contact) {
            return std::any_of(rest.contacts.begin(), rest.contacts.end(), [&](const RestContact& other) {
                return (other.point - contact.point).head<2>().norm() < rocking_rise;
            });
        });
        const bool is_rolling = is_line || (more.empty() && width(support_polygon(at_, contact_gap)) < enough);
        if (is_far(at_, rested, is_rolling ? rolling_turn : rocking_turn)) break;
        for (const RestContact& contact : more) {
            rest.contacts.push_back(contact);
            polygon.push_back(contact.point.head<2>());
        }
        if (more.empty()) {
            const Vec2 outwards = (enough - edge.distance) * edge.outward;
            polygon.insert(polygon.end(), {edge.from + outwards, edge.to + outwards});
        }
        polygon = convex_hull(std::move(polygon));
    }
    if (polygon.size() >= 2) rest.margin = nearest_edge(polygon, (rotated * mass).head<2>()).distance;
}

bool Settler::Descent::is_far(const Lowered& a, const Lowered& b, double turn) const
{
    const double trace = (a.rotation.transpose() * b.rotation).trace();
    return std::abs(a.z - b.z) > rocking_rise || (trace - 1) / 2 < std::cos(turn);
}

}  // namespace spawnfield
