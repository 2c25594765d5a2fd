#include "embree_only.h"

#include "base/parallel.h"
#include "embree_rays.h"
#include "triangle_box.h"
#include "triangle_tree.h"

#include <stdexcept>

using namespace spawnfield;

namespace bench {
namespace {

RTCBuildQuality quality_for(EmbreeOnly::Use use)
{
    return use == EmbreeOnly::Use::Once ? RTC_BUILD_QUALITY_LOW : RTC_BUILD_QUALITY_MEDIUM;
}

/// A search for a triangle that a box touches.
struct Near {
    SharedTriangles triangles;
    const TurnedBox& box;
    bool found = false;
};

/// Tests one of the triangles near the robot. Returns whether the radius of the search changed.
bool test_triangle(RTCPointQueryFunctionArguments* args)
{
    auto& near = *static_cast<Near*>(args->userPtr);
    const std::uint32_t* index = near.triangles.indices + 3 * std::size_t(args->primID);
    const auto corner = [&](int i) -> Vec3f {
        return Eigen::Map<const Vec3f>(near.triangles.vertices + 3 * std::size_t(index[i]));
    };
    if (near.found || !overlap(near.box, corner(0), corner(1), corner(2))) return false;
    near.found = true;
    args->query->radius = 0;  // ends the search
    return true;
}

}  // namespace

struct EmbreeOnly::Impl {
    Impl(TriangleScene from, const Robot& robot, Use use) : scene(std::move(from)), rays(device.get(), quality_for(use))
    {
        for (const RobotPart& part : robot.parts)
            parts.push_back({part.shape.pose.position.cast<float>(), (part.shape.size / 2).cast<float>(),
                             part.shape.pose.rotation.transpose().cast<float>()});
        std::size_t first = 0;
        for (const Label label : {Label::Terrain, Label::Obstacle, Label::Water}) {
            triangles[std::size_t(label)] = slice(first, scene.counts[std::size_t(label)]);
            rays.of(label).commit(triangles[std::size_t(label)]);
            first += scene.counts[std::size_t(label)];
        }
        if (use == Use::Often)
            tree = std::make_unique<TriangleTree>(device.get(), slice(0, scene.counts[0] + scene.counts[1]));
    }

    SharedTriangles slice(std::size_t first, std::size_t count) const
    {
        return {scene.vertices.data(), scene.vertices.size() / 3, scene.indices.data() + 3 * first, count};
    }

    /// Returns whether a box touches one of these triangles, of which the rays were made.
    bool meets(const Rays& of, const SharedTriangles& from, const TurnedBox& box) const
    {
        if (of.is_empty()) return false;
        RTCPointQuery query{box.centre.x(), box.centre.y(), box.centre.z(), 0, box.half.norm()};
        RTCPointQueryContext context;
        rtcInitPointQueryContext(&context);
        Near near{from, box};
        rtcPointQuery(of.scene(), &query, &context, test_triangle, &near);
        return near.found;
    }

    bool collides(const Vec3& position, Search search) const
    {
        for (TurnedBox box : parts) {
            box.centre += position.cast<float>();
            if (search == Search::OurOwn
                    ? tree->meets(box)
                    : meets(rays.terrain, triangles[0], box) || meets(rays.obstacles, triangles[1], box))
                return true;
        }
        return false;
    }

    TriangleScene scene;
    std::vector<TurnedBox> parts;  ///< with the origin of the robot at the origin of the world
    Device device = new_device();
    WorldRays rays;
    std::array<SharedTriangles, 3> triangles{};  ///< by label, those of the rays
    std::unique_ptr<const TriangleTree> tree;    ///< of terrain and obstacles; only for Use::Often
};

bool EmbreeOnly::is_available() { return true; }

EmbreeOnly::EmbreeOnly(TriangleScene scene, const Robot& robot, Use use)
{
    for (const RobotPart& part : robot.parts)
        if (part.shape.kind != ShapeKind::Box)
            throw std::invalid_argument(
                "Embree alone: the robot has a part that is not a box; only boxes are supported");
    impl_ = std::make_unique<const Impl>(std::move(scene), robot, use);
}

EmbreeOnly::~EmbreeOnly() = default;

TopRaster EmbreeOnly::raster_top(const RasterGrid& grid, double offset, int threads, Search search) const
{
    if (search == Search::OurOwn && !impl_->tree)
        throw std::invalid_argument("Embree alone: our own search needs Use::Often");
    TopRaster out(std::size_t(grid.rows) * std::size_t(grid.cols));
    parallel_for(std::size_t(grid.rows), threads, {}, [&](std::size_t row) {
        const auto collides = [&](const Vec3& position) { return impl_->collides(position, search); };
        const double y = grid.y_of(int(row));
        for (int i = 0; i < grid.cols; ++i)
            out[row * std::size_t(grid.cols) + std::size_t(i)] = impl_->rays.judge_top(grid.x_of(i), y, offset,
                                                                                       collides);
    });
    return out;
}

}  // namespace bench
