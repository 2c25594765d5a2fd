#include "plain_fcl.h"

#include "base/parallel.h"
#include "embree_rays.h"
#include "triangle_scene.h"

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/convex.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/collision.h>

#include <algorithm>
#include <stdexcept>

using namespace spawnfield;

namespace bench {
namespace {

using Object = fcl::CollisionObject<double>;
using Geometry = std::shared_ptr<fcl::CollisionGeometry<double>>;

// ---- Collision geometry ----

fcl::Transform3<double> transform_of(const Pose& pose)
{
    fcl::Transform3<double> transform = fcl::Transform3<double>::Identity();
    transform.linear() = pose.rotation;
    transform.translation() = pose.position;
    return transform;
}

Geometry geometry_of(const Shape& shape)
{
    const Vec3& size = shape.size;
    switch (shape.kind) {
    case ShapeKind::Sphere: return std::make_shared<fcl::Sphere<double>>(size[0]);
    case ShapeKind::Cylinder: return std::make_shared<fcl::Cylinder<double>>(size[0], size[1]);
    case ShapeKind::Capsule: return std::make_shared<fcl::Capsule<double>>(size[0], size[1]);
    case ShapeKind::Box:
    case ShapeKind::Hull: break;
    }
    return std::make_shared<fcl::Box<double>>(size);
}

Geometry hull_of(const RobotPart& part)
{
    auto faces = std::make_shared<std::vector<int>>();
    for (const auto& face : part.hull_faces) faces->insert(faces->end(), {3, face[0], face[1], face[2]});
    return std::make_shared<fcl::Convex<double>>(std::make_shared<const std::vector<Vec3>>(part.hull_vertices),
                                                 int(part.hull_faces.size()), faces);
}

/// Returns a mesh of some triangles of the scene. Each corner is stored once.
Geometry bvh_of(const Scene& scene, const std::vector<std::uint32_t>& triangles)
{
    std::vector<std::uint32_t> used;
    for (const std::uint32_t t : triangles)
        used.insert(used.end(), scene.triangles[t].begin(), scene.triangles[t].end());
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    std::vector<Vec3> vertices;
    for (const std::uint32_t v : used) vertices.push_back(scene.vertices[v]);
    const auto index_of = [&](std::uint32_t v) {
        return std::size_t(std::lower_bound(used.begin(), used.end(), v) - used.begin());
    };
    std::vector<fcl::Triangle> faces;
    for (const std::uint32_t t : triangles) {
        const Triangle& corners = scene.triangles[t];
        faces.emplace_back(index_of(corners[0]), index_of(corners[1]), index_of(corners[2]));
    }
    auto model = std::make_shared<fcl::BVHModel<fcl::OBB<double>>>();
    model->beginModel(int(faces.size()), int(vertices.size()));
    model->addSubModel(vertices, faces);
    model->endModel();
    return model;
}

struct Search {
    fcl::CollisionRequest<double> request;
    bool found = false;
};

bool stop_at_contact(Object* a, Object* b, void* data)
{
    auto& search = *static_cast<Search*>(data);
    fcl::CollisionResult<double> result;
    search.found = fcl::collide(a, b, search.request, result) > 0;
    return search.found;
}

}  // namespace

struct PlainFcl::Impl {
    Device device = new_device();
    WorldRays rays{device.get()};
    Rays closed{device.get()};
    std::vector<std::unique_ptr<Object>> objects;
    fcl::DynamicAABBTreeCollisionManager<double> manager;
    Robot robot;
    /// For each part; the identity for hulls, whose corners are in the frame of the robot.
    std::vector<Pose> robot_from_shape;

    void add_object(const Geometry& geometry, const Pose& pose)
    {
        objects.push_back(std::make_unique<Object>(geometry, transform_of(pose)));
        objects.back()->computeAABB();
    }

    void add_meshes(const Scene& scene)
    {
        std::vector<std::vector<std::uint32_t>> of_part(scene.parts.size());
        for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
            const Piece& piece = scene.pieces[scene.triangle_pieces[t]];
            const auto [a, b, c] = scene.triangles[t];
            const Vec3 &pa = scene.vertices[a], &pb = scene.vertices[b], &pc = scene.vertices[c];
            rays.of(scene.triangle_labels[t]).add(pa, pb, pc);
            if (piece.solid) closed.add(pa, pb, pc);
            if (scene.triangle_labels[t] != Label::Water) of_part[piece.part].push_back(t);
        }
        for (const auto& triangles : of_part)
            if (!triangles.empty()) add_object(bvh_of(scene, triangles), {});
    }

    void add_primitives(const Scene& scene)
    {
        for (const Primitive& primitive : scene.primitives) {
            if (primitive.shape.kind == ShapeKind::Box)
                for_each_side(primitive.shape, [&](const Vec3& a, const Vec3& b, const Vec3& c) {
                    rays.of(primitive.label).add(a, b, c);
                });
            else if (primitive.label == Label::Terrain)
                throw std::invalid_argument(
                    "plain FCL: the scene has a terrain primitive that is not a box; only boxes and meshes are "
                    "supported");
            if (primitive.label != Label::Water) add_object(geometry_of(primitive.shape), primitive.shape.pose);
        }
    }

    /// Returns a copy of the robot for one thread, which moves it from pose to pose. It has its own shapes, because
    /// objects of FCL write to their shapes (local bounds) when they are created.
    std::vector<Object> robot_copy() const
    {
        std::vector<Object> own;
        for (const RobotPart& part : robot.parts)
            own.emplace_back(part.shape.kind == ShapeKind::Hull ? hull_of(part) : geometry_of(part.shape));
        return own;
    }

    bool collides(std::vector<Object>& own, const Pose& pose) const
    {
        for (std::size_t i = 0; i < own.size(); ++i) {
            own[i].setTransform(transform_of(pose * robot_from_shape[i]));
            own[i].computeAABB();
            Search search;
            manager.collide(&own[i], &search, stop_at_contact);
            if (search.found) return true;
        }
        return false;
    }

    Verdict judge(std::vector<Object>& own, const Pose& pose, double max_height) const
    {
        const Vec3& origin = pose.position;
        const std::optional<double> ground = rays.terrain.top_below(origin, max_height);
        const double height = ground.value_or(origin.z() - max_height);
        if (rays.obstacles.top_below(origin, origin.z() - height)) return Verdict::OffTerrain;
        if (!ground) return Verdict::Aerial;
        if (rays.is_wet(origin.x(), origin.y(), height)) return Verdict::Submerged;
        return collides(own, pose) ? Verdict::Collision : Verdict::Valid;
    }

    VerdictCounts judge_row(const RasterGrid& grid, int row, double max_height, bool height_check) const
    {
        VerdictCounts counts;
        std::vector<Object> own = robot_copy();
        for (int i = 0; i < grid.cols; ++i)
            for (int k = grid.heights - 1; k >= 0; --k) {
                const Pose pose{{grid.x_of(i), grid.y_of(row), grid.z_of(k)}, Mat3::Identity()};
                if (height_check)
                    ++counts[judge(own, pose, max_height)];
                else
                    ++counts[collides(own, pose) ? Verdict::Collision : Verdict::Valid];
            }
        return counts;
    }
};

bool PlainFcl::is_available() { return true; }

PlainFcl::PlainFcl(const Scene& scene, const Robot& robot)
{
    auto impl = std::make_unique<Impl>();
    impl->add_meshes(scene);
    impl->add_primitives(scene);
    for (Rays* rays : {&impl->rays.terrain, &impl->rays.obstacles, &impl->rays.water, &impl->closed}) rays->commit();
    std::vector<Object*> objects;
    for (const auto& object : impl->objects) objects.push_back(object.get());
    impl->manager.registerObjects(objects);
    impl->manager.setup();
    impl->robot = robot;
    for (const RobotPart& part : robot.parts)
        impl->robot_from_shape.push_back(part.shape.kind == ShapeKind::Hull ? Pose{} : part.shape.pose);
    impl_ = std::move(impl);
}

PlainFcl::~PlainFcl() = default;

TopRaster PlainFcl::raster_top(const RasterGrid& grid, double offset, int threads) const
{
    TopRaster out(std::size_t(grid.rows) * std::size_t(grid.cols));
    parallel_for(std::size_t(grid.rows), threads, {}, [&](std::size_t row) {
        std::vector<Object> own = impl_->robot_copy();
        const auto collides = [&](const Vec3& position) { return impl_->collides(own, {position, Mat3::Identity()}); };
        const double y = grid.y_of(int(row));
        for (int i = 0; i < grid.cols; ++i)
            out[row * std::size_t(grid.cols) + std::size_t(i)] = impl_->rays.judge_top(grid.x_of(i), y, offset,
                                                                                       collides);
    });
    return out;
}

VerdictCounts PlainFcl::raster_3d(const RasterGrid& grid, double max_height, bool height_check, int threads) const
{
    std::vector<VerdictCounts> rows(std::size_t(grid.rows));
    parallel_for(rows.size(), threads, {},
                 [&](std::size_t j) { rows[j] = impl_->judge_row(grid, int(j), max_height, height_check); });
    VerdictCounts counts;
    for (const VerdictCounts& row : rows) counts += row;
    return counts;
}

std::vector<Verdict> PlainFcl::check(const std::vector<Pose>& poses, double max_height, int threads) const
{
    constexpr std::size_t block = 256;
    std::vector<Verdict> out(poses.size());
    parallel_for((poses.size() + block - 1) / block, threads, {}, [&](std::size_t b) {
        std::vector<Object> own = impl_->robot_copy();
        for (std::size_t i = b * block; i < std::min(poses.size(), (b + 1) * block); ++i)
            out[i] = impl_->judge(own, poses[i], max_height);
    });
    return out;
}

bool PlainFcl::is_inside(const Vec3& point) const
{
    constexpr double infinite = std::numeric_limits<double>::infinity();
    int winding = 0;
    Vec3 from = point;
    for (auto hit = impl_->closed.first(from, 1, infinite); hit; hit = impl_->closed.first(from, 1, infinite)) {
        winding += hit->upward ? 1 : -1;
        from.z() = hit->z + 1e-4;
    }
    return winding > 0;
}

}  // namespace bench
