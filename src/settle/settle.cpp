#include "settle/settle.h"

#include "settle/part_joints.h"
#include "settle/workspace.h"

#include <algorithm>

namespace spawnfield {

Settler::Settler(const Geometry& geometry, const Robot& robot, const Options& options)
    : geometry_(geometry), options_(options), mass_center_(mass_center_of(robot)), reach_(0)
{
    for (const RobotPart& part : robot.parts) {
        parts_.push_back(convex_of(part));
        const Convex& body = parts_.back();
        for (const Vec3& point : body.points) reach_ = std::max(reach_, point.norm() + body.ball + body.disc);
    }
    joints_ = joints_of(parts_);
}

Settler::Workspace::Workspace() : kept_(std::make_unique<Kept>()) {}

Settler::Workspace::~Workspace() = default;

Rest Settler::settle(double x, double y, double yaw, double layer, Workspace& workspace) const
{
    Workspace::Kept& kept = *workspace.kept_;
    if (!kept.descent) kept.descent.emplace(*this);
    if (!kept.near) kept.near.emplace(geometry_, reach_);
    const Vec3 origin(x, y, layer);
    const std::vector<NearSolid>& solids = kept.near->at(origin);
    std::optional<Rest> rest = rest_on_flat_ground(yaw, solids, workspace);
    if (!rest) rest = kept.descent->run(solids, yaw);
    rest->z += layer;
    rest->drop_z += layer;
    for (RestContact& contact : rest->contacts) contact.point += origin;
    return *std::move(rest);
}

void Settler::expect(const Rect& places, Workspace& workspace) const
{
    Workspace::Kept& kept = *workspace.kept_;
    if (!kept.near) kept.near.emplace(geometry_, reach_);
    kept.near->expect(places);
}

Rest Settler::settle(double x, double y, double yaw, double layer) const
{
    Workspace workspace;
    return settle(x, y, yaw, layer, workspace);
}

}  // namespace spawnfield
