#include "embree_rays.h"

using namespace spawnfield;

namespace bench {

Device new_device() { return {rtcNewDevice(nullptr), rtcReleaseDevice}; }

Rays::Rays(RTCDevice device, RTCBuildQuality quality) : scene_(rtcNewScene(device)), device_(device), quality_(quality)
{
    int flags = RTC_SCENE_FLAG_ROBUST;  // so that rays find no gaps along edges
    // Embree 3.13 has its fast builder only for dynamic scenes, and takes its quality from the geometry.
    if (quality == RTC_BUILD_QUALITY_LOW) flags |= RTC_SCENE_FLAG_DYNAMIC;
    rtcSetSceneFlags(scene_, RTCSceneFlags(flags));
    rtcSetSceneBuildQuality(scene_, quality);
}

void Rays::add(const Vec3& a, const Vec3& b, const Vec3& c)
{
    for (const Vec3& v : {a, b, c}) {
        const Eigen::Vector3f rounded = v.cast<float>();
        indices_.push_back(std::uint32_t(indices_.size()));
        vertices_.insert(vertices_.end(), rounded.data(), rounded.data() + 3);
    }
}

void Rays::commit()
{
    vertices_.push_back(0);  // because Embree reads four floats of each vertex
    commit({vertices_.data(), vertices_.size() / 3, indices_.data(), indices_.size() / 3});
}

void Rays::commit(const SharedTriangles& triangles)
{
    if (triangles.count == 0) return;
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, triangles.vertices, 0, 12,
                               triangles.vertex_count);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, triangles.indices, 0, 12,
                               triangles.count);
    rtcSetGeometryBuildQuality(geometry, quality_);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_);
    RTCBounds bounds{};
    rtcGetSceneBounds(scene_, &bounds);
    top_ = double(bounds.upper_z);
    is_empty_ = false;
}

std::optional<Rays::Hit> Rays::first(const Vec3& from, float direction, double distance) const
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

std::optional<double> Rays::top_below(Vec3 from, double distance) const
{
    const double bottom = from.z() - distance;
    while (from.z() >= bottom) {
        const auto hit = first(from, -1, from.z() - bottom);
        if (!hit) break;
        if (hit->upward) return hit->z;
        from.z() = hit->z - 1e-4;
    }
    return std::nullopt;
}

}  // namespace bench
