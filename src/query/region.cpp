#include <spawnfield/region.h>

#include <algorithm>

namespace spawnfield {

Bounds Region::bounds() const
{
    Bounds out;
    for (const Polygon& polygon : polygons)
        for (const Ring& ring : polygon)
            for (const Eigen::Vector2d& corner : ring) out.extend({corner.x(), corner.y(), 0});
    out.min.z() = z.low;
    out.max.z() = z.high;
    return out;
}

Bounds Area::bounds() const
{
    constexpr double far = std::numeric_limits<double>::infinity();
    if (within.empty()) return {Vec3::Constant(-far), Vec3::Constant(far)};
    Bounds out;
    for (const Region& region : within) {
        const Bounds one = region.bounds();
        out.min = out.min.cwiseMin(one.min);
        out.max = out.max.cwiseMax(one.max);
    }
    return out;
}

Region box_region(double x0, double y0, double x1, double y1, const ZRange& z)
{
    Region out;
    out.z = z;
    out.polygons = {{{{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}}};
    return out;
}

}  // namespace spawnfield
