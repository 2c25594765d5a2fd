#include "fcl_robots.h"

#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/convex.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/collision.h>

#include <memory>

using namespace spawnfield;

namespace {

std::shared_ptr<fcl::CollisionGeometry<double>> fcl_shape(const RobotPart& part)
{
    const Vec3& size = part.shape.size;
    switch (part.shape.kind) {
    case ShapeKind::Sphere: return std::make_shared<fcl::Sphere<double>>(size.x());
    case ShapeKind::Cylinder: return std::make_shared<fcl::Cylinder<double>>(size.x(), size.y());
    case ShapeKind::Capsule: return std::make_shared<fcl::Capsule<double>>(size.x(), size.y());
    case ShapeKind::Hull: {
        auto faces = std::make_shared<std::vector<int>>();
        for (const auto& face : part.hull_faces) faces->insert(faces->end(), {3, face[0], face[1], face[2]});
        return std::make_shared<fcl::Convex<double>>(std::make_shared<const std::vector<Vec3>>(part.hull_vertices),
                                                     int(part.hull_faces.size()), faces);
    }
    case ShapeKind::Box: break;
    }
    return std::make_shared<fcl::Box<double>>(size);
}

fcl::Transform3d placed(const RobotPart& part, const Pose& scene_from_robot)
{
    const Pose pose = part.shape.kind == ShapeKind::Hull ? scene_from_robot : scene_from_robot * part.shape.pose;
    fcl::Transform3d out = fcl::Transform3d::Identity();
    out.linear() = pose.rotation;
    out.translation() = pose.position;
    return out;
}

}  // namespace

bool fcl_robots_meet(const Robot& a, const Pose& scene_from_a, const Robot& b, const Pose& scene_from_b)
{
    fcl::CollisionRequest<double> request;
    request.gjk_solver_type = fcl::GST_LIBCCD;
    for (const RobotPart& first : a.parts)
        for (const RobotPart& second : b.parts) {
            fcl::CollisionResult<double> result;
            const auto one = fcl_shape(first), other = fcl_shape(second);
            if (fcl::collide(one.get(), placed(first, scene_from_a), other.get(), placed(second, scene_from_b), request,
                             result) > 0)
                return true;
        }
    return false;
}
