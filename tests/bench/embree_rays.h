#pragma once

#include "top_raster.h"

#include <embree3/rtcore.h>

#include <cstdint>
#include <limits>
#include <memory>

namespace bench {

/// Triangles in memory that Embree reads in place. Four bytes after the last vertex must be readable, too.
struct SharedTriangles {
    const float* vertices;  ///< x, y, z of each
    std::size_t vertex_count;
    const std::uint32_t* indices;  ///< three for each triangle
    std::size_t count;             ///< of triangles
};

using Device = std::unique_ptr<RTCDeviceTy, void (*)(RTCDevice)>;
Device new_device();

/// The triangles of one kind, for vertical rays.
class Rays {
public:
    /// With RTC_BUILD_QUALITY_LOW, commit() is much faster, but rays are slower.
    explicit Rays(RTCDevice device, RTCBuildQuality quality = RTC_BUILD_QUALITY_MEDIUM);
    Rays(const Rays&) = delete;
    ~Rays() { rtcReleaseScene(scene_); }

    /// Adds a triangle to those of which commit() makes a scene.
    void add(const spawnfield::Vec3& a, const spawnfield::Vec3& b, const spawnfield::Vec3& c);
    void commit();
    /// Makes a scene of triangles that must live as long as these rays. For use in place of add() and commit().
    void commit(const SharedTriangles& triangles);

    bool is_empty() const { return is_empty_; }
    RTCScene scene() const { return scene_; }

    struct Hit {
        double z;
        bool upward;  ///< whether the face points up
    };
    /// Returns the nearest face directly above (direction 1) or below (-1) a point, up to a distance.
    std::optional<Hit> first(const spawnfield::Vec3& from, float direction, double distance) const;

    /// Returns the height of the highest face.
    std::optional<double> highest(double x, double y) const
    {
        const std::optional<Hit> hit = first({x, y, top_ + 1}, -1, std::numeric_limits<float>::infinity());
        if (!hit) return std::nullopt;
        return hit->z;
    }

    /// Returns the highest face that points up at or below a point, down to a distance. Skips faces that point down.
    std::optional<double> top_below(spawnfield::Vec3 from, double distance) const;

private:
    RTCScene scene_;
    RTCDevice device_;
    RTCBuildQuality quality_;
    std::vector<float> vertices_;
    std::vector<std::uint32_t> indices_;
    double top_ = 0;  ///< m, highest z
    bool is_empty_ = true;
};

/// The rays of a world, by label.
struct WorldRays {
    explicit WorldRays(RTCDevice device, RTCBuildQuality quality = RTC_BUILD_QUALITY_MEDIUM)
        : terrain(device, quality), obstacles(device, quality), water(device, quality)
    {
    }

    Rays& of(spawnfield::Label label)
    {
        return label == spawnfield::Label::Terrain ? terrain : label == spawnfield::Label::Water ? water : obstacles;
    }

    bool is_wet(double x, double y, double ground) const
    {
        const std::optional<double> surface = water.highest(x, y);
        return surface && *surface >= ground;
    }

    /// Returns the pose `offset` above the top of the terrain, if there is any. Asks collides(position) only if no ray
    /// decides.
    template <class Collides>
    std::optional<TopPose> judge_top(double x, double y, double offset, const Collides& collides) const
    {
        using spawnfield::Verdict;
        const std::optional<double> ground = terrain.highest(x, y);
        if (!ground) return std::nullopt;
        TopPose out{*ground + offset, Verdict::Valid};
        const spawnfield::Vec3 origin(x, y, out.z);
        if (obstacles.top_below(origin, offset))
            out.verdict = Verdict::OffTerrain;
        else if (is_wet(x, y, *ground))
            out.verdict = Verdict::Submerged;
        else if (collides(origin))
            out.verdict = Verdict::Collision;
        return out;
    }

    Rays terrain, obstacles, water;
};

}  // namespace bench
