#include "plain_fcl.h"

#include "base/parallel.h"

#include <embree3/rtcore.h>
#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/convex.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/collision.h>

#include <algorithm>
#include <cstring>
#include <stdexcept>

using namespace spawnfield;

namespace bench {
namespace {

using Object = fcl::CollisionObject<double>;
using Geometry = std::shared_ptr<fcl::CollisionGeometry<double>>;

constexpr float infinite = std::numeric_limits<float>::infinity();

// ---- Rays ----

/// The triangles of one kind, for vertical rays.
class Rays {
public:
    explicit Rays(RTCDevice device) : scene_(rtcNewScene(device)), device_(device)
    {
        rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);  // so that rays find no gaps along edges
    }
    Rays(const Rays&) = delete;
    ~Rays() { rtcReleaseScene(scene_); }

    void add(const Vec3& a, const Vec3& b, const Vec3& c)
    {
        for (const Vec3& v : {a, b, c}) {
            const Eigen::Vector3f rounded = v.cast<float>();
            vertices_.insert(vertices_.end(), rounded.data(), rounded.data() + 3);
            top_ = std::max(top_, v.z());
        }
    }
    void commit()
    {
        if (vertices_.empty()) return;
        const std::size_t count = vertices_.size() / 9;
        RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
        void* corners = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, 3 * count);
        auto* indices = static_cast<unsigned*>(
            rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, count));
        std::memcpy(corners, vertices_.data(), vertices_.size() * sizeof(float));
        for (unsigned i = 0; i < 3 * count; ++i) indices[i] = i;
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene_, geometry);
        rtcReleaseGeometry(geometry);
        rtcCommitScene(scene_);
        is_empty_ = false;
        vertices_ = {};
    }

    struct Hit {
        double z;
        bool upward;  ///< whether the face points up
    };
    /// Returns the nearest face directly above (direction 1) or below (-1) a point, up to a distance.
    std::optional<Hit> first(const Vec3& from, float direction, double distance) const
    {
        if (is_empty_) return std::nullopt;
        RTCRayHit ray{};
        ray.ray.org_x = float(from.x());
        ray.ray.org_y = float(from.y());
        ray.ray.org_z = float(from.z());
        ray.ray.dir_z = direction;
        ray.ray.tfar = float(distance);
        ray.ray.mask = ~0u;
        ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        rtcIntersect1(scene_, &context, &ray);
        if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
        return Hit{from.z() + direction * double(ray.ray.tfar), ray.hit.Ng_z > 0};
    }
    std::optional<double> highest(double x, double y) const
    {
        const std::optional<Hit> hit = first({x, y, top_ + 1}, -1, infinite);
        if (!hit) return std::nullopt;
        return hit->z;
    }

private:
    RTCScene scene_;
    RTCDevice device_;
    std::vector<float> vertices_;
    double top_ = -1e9;
    bool is_empty_ = true;
};

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

/// Adds the twelve triangles of a box, with normals that point out.
void add_box(const Shape& box, Rays& rays)
{
    const auto corner = [&](int i) -> Vec3 {
        const Vec3 sign(i & 1 ? 0.5 : -0.5, i & 2 ? 0.5 : -0.5, i & 4 ? 0.5 : -0.5);
        return box.pose.rotation * box.size.cwiseProduct(sign) + box.pose.position;
    };
    constexpr int faces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    for (const auto& [a, b, c, d] : faces) {
        rays.add(corner(a), corner(b), corner(c));
        rays.add(corner(a), corner(c), corner(d));
    }
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
    std::unique_ptr<RTCDeviceTy, void (*)(RTCDevice)> device{rtcNewDevice(nullptr), rtcReleaseDevice};
    Rays terrain{device.get()}, obstacles{device.get()}, water{device.get()}, closed{device.get()};
    std::vector<std::unique_ptr<Object>> objects;
    fcl::DynamicAABBTreeCollisionManager<double> manager;
    Robot robot;
    /// For each part; the identity for hulls, whose corners are in the frame of the robot.
    std::vector<Pose> robot_from_shape;

    Rays& rays_of(Label label) { return label == Label::Terrain ? terrain : label == Label::Water ? water : obstacles; }

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
            rays_of(scene.triangle_labels[t]).add(pa, pb, pc);
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
                add_box(primitive.shape, rays_of(primitive.label));
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

    bool is_wet(double x, double y, double ground) const
    {
        const std::optional<double> surface = water.highest(x, y);
        return surface && *surface >= ground;
    }

    /// Returns the highest face that points up at or below a point, down to a distance. Skips faces that point down.
    static std::optional<double> top_below(const Rays& rays, Vec3 from, double distance)
    {
        const double bottom = from.z() - distance;
        while (from.z() >= bottom) {
            const auto hit = rays.first(from, -1, from.z() - bottom);
            if (!hit) break;
            if (hit->upward) return hit->z;
            from.z() = hit->z - 1e-4;
        }
        return std::nullopt;
    }

    std::optional<TopPose> judge_top(std::vector<Object>& own, double x, double y, double offset) const
    {
        const std::optional<double> ground = terrain.highest(x, y);
        if (!ground) return std::nullopt;
        TopPose out{*ground + offset, Verdict::Valid};
        const Vec3 origin(x, y, out.z);
        if (top_below(obstacles, origin, offset))
            out.verdict = Verdict::OffTerrain;
        else if (is_wet(x, y, *ground))
            out.verdict = Verdict::Submerged;
        else if (collides(own, {origin, Mat3::Identity()}))
            out.verdict = Verdict::Collision;
        return out;
    }

    Verdict judge(std::vector<Object>& own, const Pose& pose, double max_height) const
    {
        const Vec3& origin = pose.position;
        const std::optional<double> ground = top_below(terrain, origin, max_height);
        const double height = ground.value_or(origin.z() - max_height);
        if (top_below(obstacles, origin, origin.z() - height)) return Verdict::OffTerrain;
        if (!ground) return Verdict::Aerial;
        if (is_wet(origin.x(), origin.y(), height)) return Verdict::Submerged;
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
    for (Rays* rays : {&impl->terrain, &impl->obstacles, &impl->water, &impl->closed}) rays->commit();
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

std::vector<std::optional<PlainFcl::TopPose>> PlainFcl::raster_top(const RasterGrid& grid, double offset,
                                                                   int threads) const
{
    std::vector<std::optional<TopPose>> out(std::size_t(grid.rows) * std::size_t(grid.cols));
    parallel_for(std::size_t(grid.rows), threads, {}, [&](std::size_t row) {
        std::vector<Object> own = impl_->robot_copy();
        for (int i = 0; i < grid.cols; ++i)
            out[row * std::size_t(grid.cols) + std::size_t(i)] = impl_->judge_top(own, grid.x_of(i),
                                                                                  grid.y_of(int(row)), offset);
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
    int winding = 0;
    Vec3 from = point;
    for (auto hit = impl_->closed.first(from, 1, infinite); hit; hit = impl_->closed.first(from, 1, infinite)) {
        winding += hit->upward ? 1 : -1;
        from.z() = hit->z + 1e-4;
    }
    return winding > 0;
}

}  // namespace bench
