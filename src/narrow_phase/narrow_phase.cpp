#include "collision/narrow_phase_module.h"

#include <ccd/ccd.h>
#include <fcl/geometry/octree/octree.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/convex.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/detail/gjk_solver_libccd.h>

#include <algorithm>
#include <variant>

namespace spawnfield::narrow_phase_module {
namespace {

using FclGeometry = fcl::CollisionGeometry<double>;
using FclShape = std::variant<fcl::Box<double>, fcl::Sphere<double>, fcl::Cylinder<double>, fcl::Capsule<double>,
                              fcl::Convex<double>>;

struct Part : Body {
    const FclShape shape;
    explicit Part(FclShape s) : shape(std::move(s)) {}
};

struct Octree : Body {
    const fcl::OcTree<double> tree;
    explicit Octree(const std::shared_ptr<const octomap::OcTree>& t) : tree(t) {}
};

const FclShape& shape_of(const Body& part) { return static_cast<const Part&>(part).shape; }

FclShape fcl_shape(const Shape& shape)
{
    switch (shape.kind) {
    case ShapeKind::Sphere: return fcl::Sphere<double>(shape.size[0]);
    case ShapeKind::Cylinder: return fcl::Cylinder<double>(shape.size[0], shape.size[1]);
    case ShapeKind::Capsule: return fcl::Capsule<double>(shape.size[0], shape.size[1]);
    case ShapeKind::Box:
    case ShapeKind::Hull: break;
    }
    return fcl::Box<double>(shape.size);
}

FclShape fcl_convex(const RobotPart& hull)
{
    auto faces = std::make_shared<std::vector<int>>();
    for (const auto& face : hull.hull_faces) faces->insert(faces->end(), {3, face[0], face[1], face[2]});
    return fcl::Convex<double>(std::make_shared<const std::vector<Vec3>>(hull.hull_vertices),
                               int(hull.hull_faces.size()), faces);
}

const FclGeometry* geometry_of(const FclShape& shape)
{
    return std::visit([](const auto& s) -> const FclGeometry* { return &s; }, shape);
}

/// Returns whether a triangle is so thin that rounding decides the direction of its normal.
bool is_sliver(const std::array<Vec3, 3>& corners)
{
    const Vec3 ab = corners[1] - corners[0], ac = corners[2] - corners[0], bc = corners[2] - corners[1];
    const double longest = std::max({ab.squaredNorm(), ac.squaredNorm(), bc.squaredNorm()});
    return ab.cross(ac).squaredNorm() <= 1e-18 * longest * longest;
}

bool collide(const FclGeometry* a, const Transform& frame_from_a, const FclGeometry* b, const Transform& frame_from_b)
{
    fcl::CollisionRequest<double> request;
    request.gjk_solver_type = fcl::GST_LIBCCD;
    fcl::CollisionResult<double> result;
    return fcl::collide(a, frame_from_a, b, frame_from_b, request, result) > 0;
}

/// The callback of libccd for a SupportMap.
void support_of(const void* body, const ccd_vec3_t* direction, ccd_vec3_t* out)
{
    const Vec3 point = static_cast<const SupportMap*>(body)->support(
        {direction->v[0], direction->v[1], direction->v[2]});
    ccdVec3Set(out, point.x(), point.y(), point.z());
}

}  // namespace

std::unique_ptr<const Body> make_part(const RobotPart& part)
{
    return std::make_unique<const Part>(part.shape.kind == ShapeKind::Hull ? fcl_convex(part) : fcl_shape(part.shape));
}

std::unique_ptr<const Body> make_octree(std::shared_ptr<const octomap::OcTree> tree)
{
    return std::make_unique<const Octree>(tree);
}

bool meets_triangle(const Body& part, const Transform& frame_from_part, const std::array<Vec3, 3>& corners)
{
    static const fcl::detail::GJKSolver_libccd<double> solver;
    const auto meets = [&](const auto& shape) {
        return solver.shapeTriangleIntersect(shape, frame_from_part, corners[0], corners[1], corners[2],
                                             static_cast<Vec3*>(nullptr), static_cast<double*>(nullptr),
                                             static_cast<Vec3*>(nullptr));
    };
    // FCL's answer for a sphere depends on the triangle's normal, and is wrong for slivers even if they are far away.
    // Its answer for a capsule does not depend on the normal.
    if (const auto* sphere = std::get_if<fcl::Sphere<double>>(&shape_of(part)); sphere != nullptr && is_sliver(corners))
        return meets(fcl::Capsule<double>(sphere->radius, 0));
    return std::visit(meets, shape_of(part));
}

bool meets_shape(const Body& part, const Transform& frame_from_part, const Shape& shape,
                 const Transform& frame_from_shape)
{
    const FclShape other = fcl_shape(shape);
    return collide(geometry_of(shape_of(part)), frame_from_part, geometry_of(other), frame_from_shape);
}

bool meets_octree(const Body& part, const Transform& frame_from_part, const Body& octree,
                  const Transform& frame_from_octree)
{
    return collide(&static_cast<const Octree&>(octree).tree, frame_from_octree, geometry_of(shape_of(part)),
                   frame_from_part);
}

bool bodies_meet(const SupportMap& a, const SupportMap& b)
{
    ccd_t ccd;
    CCD_INIT(&ccd);
    ccd.support1 = support_of;
    ccd.support2 = support_of;
    ccd.max_iterations = 500;  // as in FCL
    return ccdGJKIntersect(&a, &b, &ccd) != 0;
}

}  // namespace spawnfield::narrow_phase_module
