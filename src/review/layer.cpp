#include "review/layer.h"

#include "base/number.h"
#include "base/parallel.h"
#include "column/columns.h"
#include "review/judged_poses.h"
#include "review/reason_table.h"
#include "settle/underside.h"

#include <spawnfield/error.h>
#include <spawnfield/frames.h>
#include <spawnfield/raster_islands.h>
#include <spawnfield/raster_quantities.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

namespace spawnfield {
namespace {

constexpr std::int32_t no_ground = std::numeric_limits<std::int32_t>::min();
constexpr double angle_unit = std::numbers::pi / 32767;  // rad

/// How heights become integers: z = z0 + unit * value.
struct HeightScale {
    double z0 = 0, unit = 1e-6;

    double of(std::int32_t value) const { return z0 + unit * value; }
    std::int32_t nearest(double z) const { return std::int32_t(std::lround((z - z0) / unit)); }
    /// Returns the value of the lowest height that is not below z, so that no place gets below its ground.
    std::int32_t above(double z) const
    {
        auto value = std::int32_t(std::ceil((z - z0) / unit));
        while (of(value - 1) >= z) --value;  // corrects rounding
        while (of(value) < z) ++value;
        return value;
    }
};

/// Returns the finest scale for all heights of a map and of poses in it.
HeightScale scale_of(const Map& map, const RasterResult& raster)
{
    constexpr double most = 2e9;  // units
    double low = std::min(map.bounds.min.z(), map.geometry.bounds().min.z()),
           high = std::max(map.bounds.max.z(), map.geometry.bounds().max.z());
    for (const RasterPose& pose : raster.poses) {
        low = std::min(low, pose.z);
        high = std::max(high, pose.z);
    }
    HeightScale out{std::floor(low)};
    while ((high - out.z0) / out.unit > most) out.unit *= 10;
    return out;
}

/// A quantity of all poses as 16-bit integers; 65535: none.
Json add_quantity(PackWriter& pack, const std::string& name, const std::string& unit, const std::vector<double>& values)
{
    constexpr double most = 65534;
    constexpr std::uint16_t none = 65535;
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const double value : values) {
        if (!std::isfinite(value)) continue;
        low = std::min(low, value);
        high = std::max(high, value);
    }
    if (!(low <= high)) low = high = 0;
    const double scale = high > low ? (high - low) / most : 1;
    std::vector<std::uint16_t> rounded;
    for (const double value : values)
        rounded.push_back(std::isfinite(value) ? std::uint16_t(std::lround((value - low) / scale)) : none);
    return {{"name", name},
            {"unit", unit},
            {"scale", scale},
            {"offset", low},
            {"values", pack.delta(std::span<const std::uint16_t>(rounded))}};
}

const char* unit_of(PlaceQuantity quantity)
{
    switch (quantity) {
    case PlaceQuantity::Tilt: return "rad";
    case PlaceQuantity::View: return "";
    case PlaceQuantity::Room: return "m2";
    default: return "m";
    }
}

std::int16_t rounded_angle(double angle)
{
    return std::int16_t(std::lround(std::remainder(angle, 2 * std::numbers::pi) / angle_unit));
}

/// The columns of a layer.
struct LayerColumns {
    std::vector<std::size_t> poses;  ///< of the raster
    std::vector<std::uint32_t> cell, hit;
    std::vector<std::int32_t> z, ground;
    std::vector<std::uint8_t> verdict;
    std::vector<std::int16_t> roll, pitch;
    std::vector<double> tilt, margin;
    ReasonTable reasons;
    VerdictCounts counts;
};

/// Returns whether a pose of a raster, for a layer of a column, comes to rest on a higher layer (at `ground`) that has
/// a pose of its own in the raster. Then this place is that of the other pose.
bool is_other_place(const RasterResult& raster, std::size_t pose, double ground)
{
    constexpr double least = 1e-6;  // m
    if (raster.rests.empty() || !(ground > raster.rests[pose].layer_height + least)) return false;
    const RasterPose& at = raster.poses[pose];
    for (std::size_t other = pose; other-- > 0;) {  // a column's poses are listed from the top down
        if (raster.poses[other].x != at.x || raster.poses[other].y != at.y) return false;
        if (std::abs(raster.rests[other].layer_height - ground) <= least) return true;
    }
    return false;
}

double layer_height_of(const RasterResult& raster, std::size_t pose)
{
    return raster.rests.empty() ? raster.poses[pose].z - raster.offset : raster.rests[pose].layer_height;
}

std::uint32_t cell_of(const RasterGrid& grid, const RasterPose& pose)
{
    const auto col = std::int64_t(std::lround((pose.x - grid.x0) / grid.step)),
               row = std::int64_t(std::lround((pose.y - grid.y0) / grid.step));
    return std::uint32_t(row * grid.cols + col);
}

/// Adds a pose with what its raster says.
void add_from_raster(LayerColumns& out, const RasterResult& raster, const HeightScale& heights, std::size_t pose)
{
    const RasterPose& at = raster.poses[pose];
    out.poses.push_back(pose);
    out.cell.push_back(cell_of(raster.grid, at));
    out.z.push_back(heights.above(at.z));
    out.verdict.push_back(std::uint8_t(at.verdict));
    ++out.counts[at.verdict];
    out.hit.push_back(0);
    out.ground.push_back(heights.nearest(layer_height_of(raster, pose)));
    if (raster.rests.empty()) return;
    const RasterRest& rest = raster.rests[pose];
    out.roll.push_back(rounded_angle(rest.roll));
    out.pitch.push_back(rounded_angle(rest.pitch));
    out.tilt.push_back(rest.tilt);
    out.margin.push_back(rest.margin);
}

/// Adds a pose that was judged again.
void add_judged(LayerColumns& out, const Judge& judge, const RasterResult& raster, const HeightScale& heights,
                std::size_t pose, const JudgedPlace& place)
{
    constexpr double no_value = std::numeric_limits<double>::quiet_NaN();
    const Judgement& judgement = place.judgement;
    out.poses.push_back(pose);
    out.cell.push_back(cell_of(raster.grid, raster.poses[pose]));
    out.z.push_back(heights.above(raster.poses[pose].z));
    out.verdict.push_back(std::uint8_t(judgement.verdict));
    ++out.counts[judgement.verdict];
    out.hit.push_back(hit_number(judgement.hit, judge.map()));
    out.ground.push_back(judgement.ground ? heights.nearest(judgement.ground->height) : no_ground);
    out.reasons.add(place.reason);
    if (raster.stance != Stance::Settled) return;
    const SettledPose& rest = place.settled;
    out.roll.push_back(rest.has_pose ? rounded_angle(rest.roll) : std::int16_t(0));
    out.pitch.push_back(rest.has_pose ? rounded_angle(rest.pitch) : std::int16_t(0));
    out.tilt.push_back(rest.has_pose ? rest.tilt : no_value);
    out.margin.push_back(rest.has_pose ? rest.margin : no_value);
}

/// Returns the poses of a raster whose verdict may not be that of `check`: those that are more than
/// JudgeOptions::max_height above their layer, that may stand over ground that is higher than their origin, or
/// (settled) whose place is on other ground than their layer.
std::vector<std::size_t> poses_to_judge(const Judge& judge, const RasterResult& raster, const HeightScale& heights,
                                        int threads)
{
    constexpr std::size_t batch = 1024;
    const bool can_be_over_ground = Underside(judge.robot()).above_origin(rotation_from_rpy(0, 0, raster.yaw)) > 0;
    const double max_height = judge.options().max_height + touch_tolerance;
    std::vector<std::uint8_t> is_chosen(raster.poses.size());
    parallel_for((is_chosen.size() + batch - 1) / batch, threads, {}, [&](std::size_t b) {
        Column column;
        for (std::size_t i = b * batch; i < std::min(is_chosen.size(), (b + 1) * batch); ++i) {
            const RasterPose& pose = raster.poses[i];
            const double z = heights.of(heights.above(pose.z)), layer = layer_height_of(raster, i);
            is_chosen[i] = z - layer > max_height || (can_be_over_ground && pose.verdict != Verdict::Valid);
            if (is_chosen[i] || raster.rests.empty()) continue;
            read_column(judge.map().geometry, pose.x, pose.y, column);
            const std::optional<Ground> ground = ground_below(column, z);
            is_chosen[i] = !ground || ground->height != layer;
        }
    });
    std::vector<std::size_t> out;
    for (std::size_t i = 0; i < is_chosen.size(); ++i)
        if (is_chosen[i]) out.push_back(i);
    return out;
}

/// Returns the columns of a layer. Poses that are not judged again have the verdict of the raster.
LayerColumns layer_columns(const Judge& judge, const RasterResult& raster, const HeightScale& heights,
                           const std::vector<std::size_t>& judged, const RunOptions& options)
{
    const Mat3 rotation = rotation_from_rpy(0, 0, raster.yaw);
    const auto pose_of = [&](std::size_t i) {
        const RasterPose& pose = raster.poses[judged[i]];
        return Pose{Vec3(pose.x, pose.y, heights.of(heights.above(pose.z))), rotation};
    };
    LayerColumns out;
    std::size_t next = 0;
    const auto add_up_to = [&](std::size_t end) {
        for (; next < end; ++next) add_from_raster(out, raster, heights, next);
    };
    judge_places(judge, raster.stance, judged.size(), pose_of, options, [&](std::size_t i, const JudgedPlace& place) {
        add_up_to(judged[i]);
        ++next;
        const std::optional<Ground>& ground = place.judgement.ground;
        if (place.settled.has_pose && ground && is_other_place(raster, judged[i], ground->height)) return;
        add_judged(out, judge, raster, heights, judged[i], place);
    });
    add_up_to(raster.poses.size());
    return out;
}

/// Returns the values of some poses.
template <class T>
std::vector<T> chosen(const std::vector<T>& values, const std::vector<std::size_t>& poses)
{
    std::vector<T> out;
    for (const std::size_t pose : poses) out.push_back(values[pose]);
    return out;
}

template <class T>
Json delta(PackWriter& pack, const std::vector<T>& values)
{
    return pack.delta(std::span<const T>(values));
}

}  // namespace

Json add_layer(PackWriter& pack, const Judge& judge, const RasterResult& raster, const ReviewContents& contents,
               const RunOptions& options)
{
    if (raster.dims != 2 || raster.heading)
        throw ArgumentError("write_review", "a raster has three dimensions or several headings, needs two and one");
    const bool is_settled = raster.stance == Stance::Settled;
    const HeightScale heights = scale_of(judge.map(), raster);
    // The page shows the verdicts of `check`. Those of a raster differ where it has no limit of height, or where the
    // robot's origin is below its layer. Updates have no reasons, so only these poses are judged again for them.
    std::vector<std::size_t> judged;
    if (contents.is_update) {
        judged = poses_to_judge(judge, raster, heights, options.threads);
    } else {
        judged.resize(raster.poses.size());
        std::iota(judged.begin(), judged.end(), std::size_t(0));
    }
    const LayerColumns columns = layer_columns(judge, raster, heights, judged, options);
    const RasterGrid& grid = raster.grid;
    Json counts = Json::array();
    for (std::size_t v = 0; v < verdict_count; ++v) counts.push_back(columns.counts[Verdict(v)]);
    Json out{
        {"name", "yaw " + rounded(raster.yaw * 180 / std::numbers::pi) + " degrees"},
        {"stance", is_settled ? "settled" : "level"},
        {"yaw", raster.yaw},
        {"grid", {{"x0", grid.x0}, {"y0", grid.y0}, {"step", grid.step}, {"cols", grid.cols}, {"rows", grid.rows}}},
        {"z0", heights.z0},
        {"z_unit", heights.unit},
        {"count", columns.poses.size()},
        {"counts", counts},
        {"cell", delta(pack, columns.cell)},
        {"z", delta(pack, columns.z)},
        {"ground", delta(pack, columns.ground)},
        {"verdict", delta(pack, columns.verdict)}};
    if (!contents.is_update) {
        out["hit"] = delta(pack, columns.hit);
        out["reason"] = delta(pack, columns.reasons.indices());
        out["reasons"] = columns.reasons.texts();
        out["reason_numbers"] = pack.text(columns.reasons.numbers());
    }
    Json quantities = Json::array();
    if (is_settled) {
        out["roll"] = delta(pack, columns.roll);
        out["pitch"] = delta(pack, columns.pitch);
        quantities.push_back(add_quantity(pack, "tilt", "rad", columns.tilt));
        quantities.push_back(add_quantity(pack, "margin", "m", columns.margin));
    }
    for (const PlaceQuantity quantity : contents.quantities) {
        const std::vector<double> values = raster_quantity(judge, raster, quantity, contents.measures, options);
        quantities.push_back(add_quantity(pack, to_string(quantity), unit_of(quantity), chosen(values, columns.poses)));
    }
    if (contents.graph && is_settled) {
        std::vector<std::uint16_t> islands;
        for (const std::int32_t island : chosen(islands_of(*contents.graph, judge, raster, options), columns.poses))
            islands.push_back(std::uint16_t(std::clamp(island + 1, 0, 65535)));
        out["island"] = delta(pack, islands);
    }
    out["quantities"] = std::move(quantities);
    return out;
}

}  // namespace spawnfield
