#include "base/module.h"
#include "collision/box_triangle.h"
#include "collision/narrow_phase_module.h"
#include "geometry/geometry_impl.h"
#include "map/occupancy_impl.h"
#include "robot/hull.h"

#include <spawnfield/collision.h>

#include <algorithm>

namespace spawnfield {
namespace {

using narrow_phase_module::Body;
using narrow_phase_module::Transform;
using NarrowPhase = narrow_phase_module::Functions;

Transform transform_of(const Pose& pose)
{
    Transform transform = Transform::Identity();
    transform.linear() = pose.rotation;
    transform.translation() = pose.position;
    return transform;
}

/// A part of the robot in the forms that the check needs. The constructor takes a part that is already grown by
/// touch_margin. The corners of a hull are in the robot's frame, so robot_from_shape is the identity for hulls.
struct CheckedPart {
    std::unique_ptr<const Body> body;
    Pose robot_from_shape;
    Vec3 centre;
    Shape bounds_shape;  ///< for bounds_at(); not used for hulls
    std::vector<Vec3> hull_vertices;
    Vec3 box_centre, box_half;  ///< of the bounding box along the shape's axes, in its frame

    CheckedPart(const NarrowPhase& narrow_phase, const RobotPart& part)
        : body(narrow_phase.part(part)),
          robot_from_shape(part.shape.kind == ShapeKind::Hull ? Pose{} : part.shape.pose), centre(part.centre()),
          bounds_shape(part.shape), hull_vertices(part.hull_vertices)
    {
        Bounds box;
        for (const Vec3& vertex : hull_vertices) box.extend(vertex);
        if (bounds_shape.kind != ShapeKind::Hull) box = bounds_of({bounds_shape.kind, bounds_shape.size, {}});
        box_centre = (box.min + box.max) / 2;
        box_half = (box.max - box.min) / 2;
    }

    Bounds bounds_at(const Pose& pose) const
    {
        if (bounds_shape.kind != ShapeKind::Hull) {
            Shape placed = bounds_shape;
            placed.pose = pose * bounds_shape.pose;
            return bounds_of(placed);
        }
        Bounds box;
        for (const Vec3& vertex : hull_vertices) box.extend(pose.rotation * vertex + pose.position);
        return box;
    }
};

/// A part of the robot at one pose. The narrow phase gets all coordinates relative to the robot's position, so that
/// they are small and precise even far from the scene's origin.
struct PlacedPart {
    const CheckedPart* part;
    Transform robot_from_shape;  ///< "robot" here: a frame with the scene's axes and the robot's position as origin
    Bounds bounds;               ///< in the scene's frame
};

/// Compares a part with a triangle by a fast test, which decides most of the triangles near a robot without FCL. FCL
/// must decide if the part and the triangle nearly touch, because its answer depends on its own tolerance. The test
/// sees the bounding box of a part that is not a box, so such a part is never proven to overlap.
AxisTest axis_test_of(const PlacedPart& placed, const std::array<Vec3, 3>& corners)
{
    std::array<Vec3, 3> seen;  // corners relative to the middle of the box, along its axes
    for (std::size_t k = 0; k < 3; ++k)
        seen[k] = placed.robot_from_shape.linear().transpose() * (corners[k] - placed.robot_from_shape.translation()) -
                  placed.part->box_centre;
    const AxisTest result = axis_test(placed.part->box_half, seen);
    return result == AxisTest::Overlap && placed.part->bounds_shape.kind != ShapeKind::Box ? AxisTest::Unclear : result;
}

}  // namespace

struct CollisionChecker::Impl {
    const NarrowPhase& narrow_phase = module_functions<NarrowPhase>();
    Robot robot;
    Geometry geometry;
    std::shared_ptr<const OccupancyTree> tree;
    std::unique_ptr<const Body> octree;  ///< of `tree`; empty: the geometry is checked
    std::vector<CheckedPart> parts;
    bool fcl_only = false;

    explicit Impl(const Robot& r) : robot(r)
    {
        for (const RobotPart& part : robot.parts) parts.emplace_back(narrow_phase, grown(part, touch_margin));
    }

    std::vector<PlacedPart> place(const Pose& pose) const
    {
        std::vector<PlacedPart> placed;
        placed.reserve(parts.size());
        for (const CheckedPart& part : parts)
            placed.push_back(
                {&part, transform_of(Pose{Vec3::Zero(), pose.rotation} * part.robot_from_shape), part.bounds_at(pose)});
        return placed;
    }

    bool element_meets(const Tile& tile, std::uint32_t element, const std::vector<PlacedPart>& placed,
                       const Vec3& origin) const
    {
        return tile.is_triangle(element) ? triangle_meets(tile, element, placed, origin)
                                         : primitive_meets(tile, element, placed, origin);
    }

    bool triangle_meets(const Tile& tile, std::uint32_t triangle, const std::vector<PlacedPart>& placed,
                        const Vec3& origin) const
    {
        std::array<Vec3, 3> corners = tile.corners(triangle);
        for (Vec3& corner : corners) corner -= origin;
        for (const PlacedPart& part : placed) {
            const AxisTest result = fcl_only ? AxisTest::Unclear : axis_test_of(part, corners);
            if (result == AxisTest::Overlap) return true;
            if (result == AxisTest::Unclear && overlap(tile.box(triangle), part.bounds) &&
                narrow_phase.triangle(*part.part->body, part.robot_from_shape, corners))
                return true;
        }
        return false;
    }

    bool primitive_meets(const Tile& tile, std::uint32_t element, const std::vector<PlacedPart>& placed,
                         const Vec3& origin) const
    {
        const ElementBox box = tile.box(element);
        const Shape shape = tile.primitive(element).shape();
        const Transform robot_from_other = transform_of({shape.pose.position - origin, shape.pose.rotation});
        return std::any_of(placed.begin(), placed.end(), [&](const PlacedPart& part) {
            return overlap(box, part.bounds) &&
                   narrow_phase.shape(*part.part->body, part.robot_from_shape, shape, robot_from_other);
        });
    }

    /// Returns the smallest number of a part of the scene, below `best`, whose filled meshes contain a part of the
    /// robot; `best` if there is none. The robot must not touch the surfaces of the scene's parts below `best`. Then
    /// one point of each convex part of the robot decides for the whole robot.
    std::uint32_t first_around(const Pose& pose, std::uint32_t best) const
    {
        if (!geometry.impl().has_filled_meshes) return best;
        for (const CheckedPart& part : parts) {
            const Vec3 centre = pose.rotation * part.centre + pose.position;
            for (const Span& span : column_at(geometry, centre.x(), centre.y()).spans)
                if (span.bottom <= centre.z() && centre.z() <= span.top) best = std::min(best, span.part);
        }
        return best;
    }

    /// Returns the hit with the smallest part number; with `any_will_do` any hit, which is faster. Returns nothing if
    /// the robot does not collide.
    std::optional<CollisionHit> find(const Pose& pose, bool any_will_do) const
    {
        const std::vector<PlacedPart> placed = place(pose);
        if (octree) return find_in_octree(placed, pose.position);
        Bounds all;
        for (const PlacedPart& part : placed) {
            all.extend(part.bounds.min);
            all.extend(part.bounds.max);
        }
        std::uint32_t best = CollisionHit::occupancy;  // larger than every part number: no hit yet
        geometry.impl().visit_near(all, [&](const Tile& tile, std::uint32_t element) {
            if ((any_will_do && best != CollisionHit::occupancy) || tile.label(element) == Label::Water) return;
            const std::uint32_t part = tile.part(element);
            if (part < best && element_meets(tile, element, placed, pose.position)) best = part;
        });
        if (!any_will_do || best == CollisionHit::occupancy) best = first_around(pose, best);
        if (best == CollisionHit::occupancy) return std::nullopt;
        return CollisionHit{best};
    }

    std::optional<CollisionHit> find_in_octree(const std::vector<PlacedPart>& placed, const Vec3& origin) const
    {
        Transform robot_from_tree = Transform::Identity();
        robot_from_tree.translation() = -origin;
        for (const PlacedPart& part : placed)
            if (narrow_phase.in_octree(*part.part->body, part.robot_from_shape, *octree, robot_from_tree))
                return CollisionHit{};
        return std::nullopt;
    }
};

CollisionChecker::CollisionChecker(const Geometry& geometry, const Robot& robot, bool fcl_only)
{
    auto impl = std::make_unique<Impl>(robot);
    impl->geometry = geometry;
    impl->fcl_only = fcl_only;
    impl_ = std::move(impl);
}

CollisionChecker::CollisionChecker(std::shared_ptr<const OccupancyTree> tree, const Robot& robot)
{
    auto impl = std::make_unique<Impl>(robot);
    impl->tree = std::move(tree);
    impl->octree = impl->narrow_phase.octree(impl->tree->impl().tree);
    impl_ = std::move(impl);
}

CollisionChecker::CollisionChecker(CollisionChecker&&) noexcept = default;
CollisionChecker::~CollisionChecker() = default;

const Robot& CollisionChecker::robot() const { return impl_->robot; }
bool CollisionChecker::uses_occupancy() const { return impl_->octree != nullptr; }

bool CollisionChecker::is_free(const Pose& scene_from_robot) const { return !impl_->find(scene_from_robot, true); }

std::optional<CollisionHit> CollisionChecker::find_hit(const Pose& scene_from_robot) const
{
    return impl_->find(scene_from_robot, false);
}

}  // namespace spawnfield
