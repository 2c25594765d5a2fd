#include "settle/workspace.h"

#include <algorithm>
#include <cmath>

namespace spawnfield {

Settler::FlatRest Settler::flat_rest(double yaw, Descent& descent) const
{
    const double far = 10 * reach_;
    NearSolid plane;
    plane.set({Vec3(-far, -far, 0), Vec3(2 * far, -far, 0), Vec3(-far, 2 * far, 0)});
    FlatRest out{yaw, descent.run({&plane, 1}, yaw), {}};
    const Mat3 rotation = rotation_from_rpy(out.rest.roll, out.rest.pitch, yaw);
    for (const Convex& part : parts_) {
        Bounds& bounds = out.parts.emplace_back(moved(part, {Vec3::Zero(), rotation}).bounds());
        bounds.min.z() += out.rest.z;
        bounds.max.z() += out.rest.z;
    }
    for (const Convex& joint : joints_) out.parts.push_back(moved(joint, {Vec3(0, 0, out.rest.z), rotation}).bounds());
    return out;
}

/// Returns how the robot rests on a plane at this yaw. Keeps it for the next robots.
const Settler::FlatRest& Settler::flat_rest(double yaw, Workspace& workspace) const
{
    std::vector<FlatRest>& flats = workspace.kept_->flats;
    const auto found = std::find_if(flats.begin(), flats.end(), [&](const FlatRest& flat) { return flat.yaw == yaw; });
    if (found != flats.end()) return *found;
    if (flats.size() == Descent::most_yaws) flats.clear();
    return flats.emplace_back(flat_rest(yaw, *workspace.kept_->descent));
}

/// Returns the rest on ground that is horizontal below all contacts, and equally high to the bit, if no other solid is
/// near enough to touch the robot or to be a ceiling. So the way down over a plane and over this ground is the same.
std::optional<Rest> Settler::rest_on_flat_ground(double yaw, const std::vector<NearSolid>& solids,
                                                 Workspace& workspace) const
{
    constexpr double same_layer = 1e-9;  // m
    const NearSolid* ground = nullptr;
    const auto is_level = [](const NearSolid& solid) { return solid.face && solid.face->normal.head<2>().isZero(0); };
    for (const NearSolid& solid : solids)
        if (is_level(solid) && std::abs(solid.face->height) <= same_layer) ground = &solid;
    if (ground == nullptr) return std::nullopt;
    const FlatRest& flat = flat_rest(yaw, workspace);
    if (flat.rest.state != Rest::State::Standing) return std::nullopt;
    const double z = ground->face->height;
    const auto is_ground = [&](const NearSolid& solid) { return is_level(solid) && solid.face->height == z; };
    for (const NearSolid& solid : solids) {
        if (is_ground(solid) && solid.label == ground->label) continue;
        if (!is_ground(solid) && solid.bounds.max.z() <= z) continue;
        for (const Bounds& part : flat.parts)
            if (part.meets(solid.bounds, 2) && solid.bounds.min.z() - part.max.z() - z <= options_.headroom)
                return std::nullopt;
    }
    Rest out = flat.rest;
    out.z += z;
    out.drop_z += z;
    for (RestContact& contact : out.contacts) {
        const auto carries = [&](const NearSolid& solid) {
            return is_ground(solid) && solid.face->is_over(contact.point);
        };
        const auto below = std::find_if(solids.begin(), solids.end(), carries);
        if (below == solids.end()) return std::nullopt;
        contact.point.z() += z;
        contact.ground = below->part;
        contact.label = below->label;
    }
    return out;
}

}  // namespace spawnfield
