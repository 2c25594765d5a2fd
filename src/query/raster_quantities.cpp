#include "base/parallel.h"
#include "query/place_meter.h"

#include <spawnfield/error.h>
#include <spawnfield/raster_quantities.h>

#include <algorithm>
#include <limits>

namespace spawnfield {
namespace {

Pose pose_of(const RasterResult& raster, std::size_t p)
{
    const RasterPose& pose = raster.poses[p];
    const Vec3 position(pose.x, pose.y, pose.z);
    if (raster.rests.empty()) return {position, rotation_from_rpy(0, 0, raster.yaw)};
    const RasterRest& rest = raster.rests[p];
    return {position, rotation_from_rpy(rest.roll, rest.pitch, rest.yaw)};
}

}  // namespace

std::vector<double> raster_quantity(const Judge& judge, const RasterResult& raster, PlaceQuantity quantity,
                                    const PlaceMeasures& measures, const RunOptions& options)
{
    constexpr std::size_t chunk = 256;  // neighbours share work
    const bool is_settled = raster.stance == Stance::Settled;
    if (is_settled && raster.rests.size() != raster.poses.size())
        throw ArgumentError("raster_quantity", "size of raster.rests", double(raster.rests.size()),
                            "as many as its poses: a raster of settled poses at one yaw");
    PlaceMeasures wanted = measures;
    wanted.columns = {quantity};
    wanted.prefer.clear();
    const PlaceMeter meter("raster_quantity", judge.map().geometry, judge.robot(), wanted, is_settled);
    std::vector<double> out(raster.poses.size(), std::numeric_limits<double>::quiet_NaN());
    parallel_for((out.size() + chunk - 1) / chunk, options.threads, options.progress, [&](std::size_t c) {
        PlaceMeter::Neighbour neighbour;
        for (std::size_t p = c * chunk; p < std::min(out.size(), (c + 1) * chunk); ++p) {
            if (raster.poses[p].verdict != Verdict::Valid) continue;
            const RasterRest rest = raster.rests.empty() ? RasterRest{} : raster.rests[p];
            out[p] = meter.measure(quantity, pose_of(raster, p), rest.tilt, rest.margin, &neighbour);
        }
    });
    return out;
}

}  // namespace spawnfield
