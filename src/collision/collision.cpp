#include "base/bits.h"
#include "base/module.h"
#include "base/parallel.h"
#include "collision/box_triangle.h"
#include "collision/narrow_phase_module.h"
#include "collision/pose_checker.h"
#include "geometry/geometry_impl.h"
#include "map/occupancy_impl.h"
#include "robot/hull.h"

#include <spawnfield/collision.h>

#include <algorithm>
#include <cmath>

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

}  // namespace

/// A part of the robot in the forms that the check needs. The constructor takes a part that is already grown by
/// touch_margin. The corners of a hull are in the robot's frame, so robot_from_shape is the identity for hulls.
struct CheckedPart {
    std::unique_ptr<const Body> body;
    Pose robot_from_shape;
    Vec3 centre;
    std::optional<double> axis_z;  ///< height of a point of the part on the robot's z axis, m; empty: none is known
    Shape bounds_shape;            ///< for bounds_at(); not used for hulls
    std::vector<Vec3> hull_vertices;
    Vec3 box_centre, box_half;  ///< of the bounding box along the shape's axes, in its frame

    CheckedPart(const NarrowPhase& narrow_phase, const RobotPart& part)
        : body(narrow_phase.make_part(part)),
          robot_from_shape(part.shape.kind == ShapeKind::Hull ? Pose{} : part.shape.pose), centre(part.centre()),
          bounds_shape(part.shape), hull_vertices(part.hull_vertices)
    {
        Bounds box;
        for (const Vec3& vertex : hull_vertices) box.extend(vertex);
        if (bounds_shape.kind != ShapeKind::Hull) box = bounds_of({bounds_shape.kind, bounds_shape.size, {}});
        box_centre = (box.min + box.max) / 2;
        box_half = (box.max - box.min) / 2;
        axis_z = height_on_axis();
    }

    std::optional<double> height_on_axis() const
    {
        constexpr double least = 1e-3;  // m; a shorter piece of the axis may lie in the part by rounding only
        if (bounds_shape.kind == ShapeKind::Hull) return std::nullopt;
        const std::optional<Interval> inside = vertical_interval(bounds_shape, 0, 0);
        return inside && inside->top - inside->bottom >= least ? std::optional((inside->bottom + inside->top) / 2)
                                                               : std::nullopt;
    }

    /// Returns the bounds of the part when the robot is turned by `rotation`, relative to the robot's position, m.
    Bounds bounds_at(const Mat3& rotation) const
    {
        if (bounds_shape.kind != ShapeKind::Hull) {
            Shape placed = bounds_shape;
            placed.pose = Pose{Vec3::Zero(), rotation} * bounds_shape.pose;
            return bounds_of(placed);
        }
        Bounds box;
        for (const Vec3& vertex : hull_vertices) box.extend(rotation * vertex);
        return box;
    }
};

/// A part of the robot, turned as at one pose. All coordinates are relative to the robot's position and along the axes
/// of the scene, so that they are small and precise even far from the scene's origin.
struct PlacedPart {
    const CheckedPart* part;
    Transform robot_from_shape;
    Bounds bounds;
    FourBoxes box;  ///< the bounding box along the shape's axes
};

namespace {

/// A few triangles of a tile, which are compared at once.
struct FewTriangles {
    std::array<std::uint32_t, FourTriangles::width> elements;
    std::array<std::array<const Vec3*, 3>, FourTriangles::width> corners;
    std::size_t count = 0;

    void add(const Tile& tile, std::uint32_t triangle)
    {
        elements[count] = triangle;
        corners[count++] = tile.corner_pointers(triangle);
    }
    /// Returns the corners. Places without a triangle have those of the first one.
    const auto& filled_corners()
    {
        for (std::size_t k = count; k < corners.size(); ++k) corners[k] = corners[0];
        return corners;
    }
};

Bounds moved(const Bounds& box, const Vec3& by) { return {box.min + by, box.max + by}; }

bool is_box(const PlacedPart& placed) { return placed.part->bounds_shape.kind == ShapeKind::Box; }

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
    return result == AxisTest::Overlap && !is_box(placed) ? AxisTest::Unclear : result;
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
    double reach = 0;  ///< of the farthest point of the robot from its origin, or more, m

    explicit Impl(const Robot& r) : robot(r)
    {
        for (const RobotPart& part : robot.parts) {
            const CheckedPart& checked = parts.emplace_back(narrow_phase, grown(part, touch_margin));
            const Bounds box = checked.bounds_at(Mat3::Identity());
            reach = std::max(reach, box.max.cwiseAbs().cwiseMax(box.min.cwiseAbs()).norm());
        }
    }

    bool meets_triangle(const PlacedPart& placed, const Tile& tile, std::uint32_t triangle, const Vec3& origin) const
    {
        std::array<Vec3, 3> corners = tile.corners(triangle);
        for (Vec3& corner : corners) corner -= origin;
        const AxisTest result = fcl_only ? AxisTest::Unclear : axis_test_of(placed, corners);
        if (result != AxisTest::Unclear) return result == AxisTest::Overlap;
        return overlap(tile.box(triangle), moved(placed.bounds, origin)) &&
               narrow_phase.meets_triangle(*placed.part->body, placed.robot_from_shape, corners);
    }

    /// Lowers `best` to the smallest number of a part of the scene that has one of these elements of a tile and meets
    /// the robot, if it is smaller. With `any_will_do` it stops at the first one.
    void find_in(const Tile& tile, std::uint64_t elements, const std::vector<PlacedPart>& placed, const Vec3& origin,
                 bool any_will_do, std::uint32_t& best) const
    {
        const std::uint32_t none = best;
        const auto is_done = [&] { return any_will_do && best != none; };
        const auto is_wanted = [&](Label label, std::uint32_t part) {
            return label != Label::Water && (any_will_do || part < best);
        };
        const std::uint64_t are_triangles = tile.are_triangles();
        for (std::uint64_t triangles = elements & are_triangles; triangles != 0 && !is_done();) {
            FewTriangles few;
            for (; triangles != 0 && few.count < FourTriangles::width; triangles &= triangles - 1) {
                const auto triangle = std::uint32_t(std::countr_zero(triangles));
                if (is_wanted(tile.triangles[triangle].label, tile.piece(triangle).part)) few.add(tile, triangle);
            }
            if (few.count == 0) break;
            for_each_bit(meeting_triangles(tile, few, placed, origin),
                         [&](std::uint32_t k) { best = std::min(best, tile.piece(few.elements[k]).part); });
        }
        for (std::uint64_t rest = elements & ~are_triangles; rest != 0 && !is_done(); rest &= rest - 1) {
            const auto element = std::uint32_t(std::countr_zero(rest));
            const TilePrimitive& primitive = tile.primitive(element);
            if (is_wanted(primitive.label, primitive.part) && primitive_meets(tile, element, placed, origin))
                best = primitive.part;
        }
    }

    /// Returns a bit for each of these triangles that meets the robot.
    std::uint32_t meeting_triangles(const Tile& tile, FewTriangles& few, const std::vector<PlacedPart>& placed,
                                    const Vec3& origin) const
    {
        const FourTriangles seen(few.filled_corners(), origin);
        const std::uint32_t asked = (1U << few.count) - 1;
        std::uint32_t met = 0;
        for (const PlacedPart& part : placed) {
            const FourTriangles::Marks marks = fcl_only ? FourTriangles::Marks{} : seen.compare(part.box);
            if (is_box(part)) met |= marks.overlap & asked;
            for_each_bit(asked & ~met & ~marks.apart, [&](std::uint32_t k) {
                if (meets_triangle(part, tile, few.elements[k], origin)) met |= 1U << k;
            });
        }
        return met;
    }

    bool primitive_meets(const Tile& tile, std::uint32_t element, const std::vector<PlacedPart>& placed,
                         const Vec3& origin) const
    {
        const ElementBox box = tile.box(element);
        const Shape shape = tile.primitive(element).shape();
        const Transform robot_from_other = transform_of({shape.pose.position - origin, shape.pose.rotation});
        return std::any_of(placed.begin(), placed.end(), [&](const PlacedPart& part) {
            return overlap(box, moved(part.bounds, origin)) &&
                   narrow_phase.meets_shape(*part.part->body, part.robot_from_shape, shape, robot_from_other);
        });
    }

    /// Returns the smallest number of a part of the scene, below `best`, whose filled meshes contain a part of the
    /// robot; `best` if there is none. The robot must not touch the surfaces of the scene's parts below `best`. Then
    /// one point of each convex part of the robot decides for the whole robot: if `column`, the column at the pose, is
    /// known, a point in it.
    std::uint32_t first_around(const Pose& pose, const ColumnView* column, std::uint32_t best) const
    {
        if (!geometry.impl().has_filled_meshes) return best;
        const auto look = [&](const ColumnView& there, double z) {
            for (const Span& span : there.spans)
                if (span.bottom <= z && z <= span.top) best = std::min(best, span.part);
        };
        const bool is_upright = pose.rotation(2, 2) == 1;
        for (const CheckedPart& part : parts) {
            if (column != nullptr && is_upright && part.axis_z) {
                look(*column, pose.position.z() + *part.axis_z);
            } else {
                const Vec3 centre = pose.rotation * part.centre + pose.position;
                if (column != nullptr && centre.head<2>() == pose.position.head<2>())
                    look(*column, centre.z());
                else
                    look(column_at(geometry, centre.x(), centre.y()), centre.z());
            }
        }
        return best;
    }

    std::optional<CollisionHit> find_in_octree(const std::vector<PlacedPart>& placed, const Vec3& origin) const
    {
        Transform robot_from_tree = Transform::Identity();
        robot_from_tree.translation() = -origin;
        for (const PlacedPart& part : placed)
            if (narrow_phase.meets_octree(*part.part->body, part.robot_from_shape, *octree, robot_from_tree))
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
    impl->octree = impl->narrow_phase.make_octree(impl->tree->impl().tree);
    impl_ = std::move(impl);
}

struct CollisionPreload::Impl {
    CallAside loading;

    explicit Impl(int threads)
        : loading(threads, [] {
              try {
                  module_functions<NarrowPhase>();
              } catch (const std::exception&) {  // is thrown again by whoever needs it
              }
          })
    {
    }
};

CollisionPreload::CollisionPreload(int threads) : impl_(std::make_unique<Impl>(threads)) {}
CollisionPreload::~CollisionPreload() = default;

CollisionChecker::CollisionChecker(CollisionChecker&&) noexcept = default;
CollisionChecker::~CollisionChecker() = default;

const Robot& CollisionChecker::robot() const { return impl_->robot; }
bool CollisionChecker::uses_occupancy() const { return impl_->octree != nullptr; }

bool CollisionChecker::is_free(const Pose& scene_from_robot) const
{
    return PoseChecker(*this).is_free(scene_from_robot);
}

std::optional<CollisionHit> CollisionChecker::find_hit(const Pose& scene_from_robot) const
{
    return PoseChecker(*this).find_hit(scene_from_robot);
}

bool PoseChecker::is_free(const Pose& scene_from_robot, const ColumnView* column)
{
    return !find(scene_from_robot, true, column);
}

std::optional<CollisionHit> PoseChecker::find_hit(const Pose& scene_from_robot, const ColumnView* column)
{
    return find(scene_from_robot, false, column);
}

PoseChecker::PoseChecker(const CollisionChecker& checker)
    : impl_(checker.impl()), tiles_(std::make_shared<NearTiles>(impl_.geometry.impl())),
      rotation_(Mat3::Constant(std::nan("")))
{
}
PoseChecker::~PoseChecker() = default;

void PoseChecker::expect(const Rect& places)
{
    tiles_->expect({places.low_x - impl_.reach, places.low_y - impl_.reach, places.high_x + impl_.reach,
                    places.high_y + impl_.reach});
}

/// Places the robot's parts. Neighbouring poses often have the same rotation.
void PoseChecker::set_rotation(const Mat3& rotation)
{
    if (rotation == rotation_) return;
    rotation_ = rotation;
    placed_.clear();
    around_ = {};
    for (const CheckedPart& part : impl_.parts) {
        const Pose pose = Pose{Vec3::Zero(), rotation} * part.robot_from_shape;
        placed_.push_back({&part, transform_of(pose), part.bounds_at(rotation),
                           FourBoxes(part.box_half, {pose.rotation * part.box_centre + pose.position, pose.rotation})});
        around_.extend(placed_.back().bounds.min);
        around_.extend(placed_.back().bounds.max);
    }
}

/// Returns the hit with the smallest part number; with `any_will_do` any hit, which is faster. Returns nothing if the
/// robot does not collide.
std::optional<CollisionHit> PoseChecker::find(const Pose& pose, bool any_will_do, const ColumnView* column)
{
    set_rotation(pose.rotation);
    if (impl_.octree) return impl_.find_in_octree(placed_, pose.position - impl_.tree->origin());
    const Bounds space = moved(around_, pose.position);
    std::uint32_t best = CollisionHit::occupancy;  // larger than every part number: no hit yet
    const auto is_wanted = [&] { return !any_will_do || best == CollisionHit::occupancy; };
    tiles_->visit(space, [&](const Tile& tile) {
        const std::uint64_t elements = tile.near(space);
        if (elements != 0) impl_.find_in(tile, elements, placed_, pose.position, any_will_do, best);
        return is_wanted();
    });
    if (!any_will_do || best == CollisionHit::occupancy) best = impl_.first_around(pose, column, best);
    if (best == CollisionHit::occupancy) return std::nullopt;
    return CollisionHit{best};
}

}  // namespace spawnfield
