#include "fleet/kind_poses.h"

#include "base/chosen_bounds.h"
#include "column/columns.h"
#include "query/draw.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace spawnfield {
namespace {

constexpr double most_columns = 200000;  // of the rasters of all headings, unless a step is given

/// Returns the bounds in which robots of a kind may stand, in x and y; empty if there are none.
Bounds box_of(const FleetKind& kind)
{
    const Bounds &map = kind.judge.map().bounds, area = kind.spawns.area.bounds();
    Bounds box = chosen_bounds("place_fleet", kind.spawns.bounds, map, 2);
    for (int axis = 0; axis < 2; ++axis) {
        box.min[axis] = std::max({box.min[axis], area.min[axis], map.min[axis]});
        box.max[axis] = std::min({box.max[axis], area.max[axis], map.max[axis]});
    }
    return box;
}

/// Returns whether a level pose would be valid for sample(): ground above the origin does not count.
bool is_valid_draw(const Judge& judge, const Pose& pose)
{
    const Judgement judged = judge.check(pose);
    return judged.verdict == Verdict::Valid && judged.ground->height <= pose.position.z() + touch_tolerance;
}

Standing none(const std::string& why) { return {.why = why}; }

}  // namespace

KindPoses::KindPoses(const FleetKind& kind, const FleetOptions& options)
    : kind_(kind), options_(options), area_(kind.spawns.area), avoided_(kind.spawns.avoid, kind.judge.map().bounds),
      step_(kind.fill_step.value_or(auto_fill_step(kind))), headings_(headings_of(kind.spawns))
{
}

std::vector<KindPoses::Heading> KindPoses::headings_of(const SampleOptions& spawns)
{
    const bool is_any = spawns.heading && spawns.heading->kind == HeadingRule::Kind::Any;
    if (!is_any && !spawns.random_yaw) return {{spawns.yaw, spawns.heading}};
    std::vector<Heading> out(is_any ? std::size_t(spawns.heading->count) : random_headings);
    for (std::size_t k = 0; k < out.size(); ++k) out[k].yaw = heading_of(int(k), int(out.size()));
    return out;
}

std::vector<Stand> KindPoses::draw(std::size_t count, std::uint64_t stream, FleetKindResult& result) const
{
    SampleOptions options = kind_.spawns;
    options.count = count;
    options.seed = std::uint64_t(Draw(options_.seed, stream).unit() * 0x1p53);
    return drawn(options, result);
}

std::vector<Stand> KindPoses::draw(std::size_t count, std::uint64_t stream, FleetKindResult& result,
                                   const std::optional<double>& yaw) const
{
    SampleOptions options = kind_.spawns;
    options.count = count;
    options.seed = std::uint64_t(Draw(options_.seed, stream).unit() * 0x1p53);
    options.heading.reset();
    options.random_yaw = !yaw;
    options.yaw = yaw.value_or(0);
    return drawn(options, result);
}

std::vector<Stand> KindPoses::drawn(const SampleOptions& wanted, FleetKindResult& result) const
{
    SampleOptions options = wanted;
    options.min_distance = 0;
    options.threads = options_.threads;
    options.progress = options_.progress;
    options.stop = options_.stop;
    const SpawnList list = sample(kind_.judge, options);
    result.exact_checks += list.exact_checks;
    const bool is_settled = list.stance == Stance::Settled;
    const double above_ground = is_settled ? kind_.judge.options().stand.lift - kind_.judge.robot().bounds().min.z()
                                           : options.offset.value_or(auto_offset(kind_.judge.robot()));
    std::vector<Stand> out(list.spawns.size());
    for (std::size_t i = 0; i < out.size(); ++i)
        out[i] = {list.spawns[i], is_settled ? list.rests[i] : SpawnRest{}, list.spawns[i].position.z() - above_ground};
    return out;
}

std::vector<Stand> KindPoses::raster(std::size_t heading, FleetProof& proof, FleetKindResult& result) const
{
    return raster_of(headings_[heading], proof, result);
}

std::vector<Stand> KindPoses::raster_at(double yaw, FleetProof& proof, FleetKindResult& result) const
{
    return raster_of({yaw, {}}, proof, result);
}

Progress KindPoses::raster_progress() const
{
    if (!options_.stop) return options_.progress;
    return [this](double share) {
        if (options_.is_stopped()) throw FleetStopped{};
        if (options_.progress) options_.progress(share);
    };
}

std::vector<Stand> KindPoses::raster_of(const Heading& heading, FleetProof& proof, FleetKindResult& result) const
{
    const SampleOptions& spawns = kind_.spawns;
    const Bounds box = box_of(kind_);
    if (!(box.min.head<2>().array() <= box.max.head<2>().array()).all()) return {};
    const RasterOptions options{.step = step_,
                                .bounds = box,
                                .z = spawns.z,
                                .area = spawns.area,
                                .stance = spawns.stance,
                                .offset = spawns.offset,
                                .yaw = heading.yaw,
                                .heading = heading.rule,
                                .is_reachable = spawns.is_reachable,
                                .layers = spawns.layers,
                                .threads = options_.threads,
                                .progress = raster_progress()};
    const RasterResult raster = spawnfield::raster(kind_.judge, options);
    result.exact_checks += raster.exact_checks;
    proof.poses += raster.poses.size();
    // A raster of level poses does not use max_height. So a pose on its layer may be aerial only at such an offset.
    const bool may_be_aerial = spawns.stance == Stance::Level &&
                               !(raster.offset >= 0 && raster.offset <= kind_.judge.options().max_height);
    std::vector<Stand> out;
    for (std::size_t i = 0; i < raster.poses.size(); ++i) {
        const RasterPose& pose = raster.poses[i];
        if (pose.verdict != Verdict::Valid) continue;
        const Pose level{{pose.x, pose.y, pose.z}, rotation_from_rpy(0, 0, heading.yaw)};
        if (may_be_aerial && !is_valid_draw(kind_.judge, level)) continue;
        ++proof.valid;
        Stand stand{.spawn = {.position = {pose.x, pose.y, pose.z}, .yaw = heading.yaw},
                    .ground = pose.z - raster.offset};
        if (!raster.rests.empty()) {
            const RasterRest& rest = raster.rests[i];
            stand.spawn.yaw = rest.yaw;
            stand.spawn.roll = rest.roll;
            stand.spawn.pitch = rest.pitch;
            stand.rest = {rest.tilt, rest.margin, rest.free_length};
            stand.ground = rest.layer_height;
        }
        if (avoided_.is_clear(stand.spawn.position)) out.push_back(stand);
    }
    return out;
}

std::optional<double> KindPoses::layer_at(const FormationSlot& slot) const
{
    const SampleOptions& spawns = kind_.spawns;
    const Map& map = kind_.judge.map();
    const Column column = column_at(map.geometry, slot.x, slot.y);
    const std::span<const double> heights = heights_within(column.layers, overlap(map.z_limits, spawns.z));
    std::optional<double> out;
    for (std::size_t k = 0; k < heights.size(); ++k) {
        if (!spawns.layers.includes(int(k), int(heights.size()))) continue;
        if (!area_.contains({slot.x, slot.y}, heights[k])) continue;
        if (!out || (slot.z && std::abs(heights[k] - *slot.z) < std::abs(*out - *slot.z))) out = heights[k];
    }
    return out;
}

Standing KindPoses::stand_at(const FormationSlot& slot) const
{
    const SampleOptions& spawns = kind_.spawns;
    const Judge& judge = kind_.judge;
    if (!box_of(kind_).contains_xy(slot.x, slot.y, 0) || !area_.contains({slot.x, slot.y}))
        return none("it is off the map or the region");
    const std::optional<double> layer = layer_at(slot);
    if (!layer) return none("there is no ground that the options allow");
    Standing out;
    Stand stand;
    stand.ground = *layer;
    if (spawns.stance == Stance::Settled) {
        const SettledPose pose = judge.settle({slot.x, slot.y, *layer}, slot.yaw);
        out.exact_checks = pose.exact_check;
        if (pose.verdict != Verdict::Valid) return out.why = judge.describe(pose), out;
        if (spawns.is_reachable && !spawns.is_reachable(pose)) return out.why = "it is not on the island", out;
        stand.spawn = {pose.lifted(judge.options().stand.lift).position, pose.yaw, pose.roll, pose.pitch};
        stand.rest = {pose.tilt, pose.margin};
    } else {
        const double offset = spawns.offset.value_or(auto_offset(judge.robot()));
        const Pose pose{{slot.x, slot.y, *layer + offset}, rotation_from_rpy(0, 0, slot.yaw)};
        const Judgement judgement = judge.check(pose);
        out.exact_checks = judgement.exact_check;
        if (judgement.verdict != Verdict::Valid) return out.why = judge.describe(pose, judgement), out;
        stand.spawn = {pose.position, slot.yaw};
    }
    if (!avoided_.is_clear(stand.spawn.position)) return out.why = "it is too near to an avoided pose", out;
    out.stand = stand;
    return out;
}

double auto_fill_step(const FleetKind& kind)
{
    const Bounds box = box_of(kind);
    const double area = std::max(0.0, box.max.x() - box.min.x()) * std::max(0.0, box.max.y() - box.min.y());
    const double headings = double(kind.formation ? KindPoses::random_headings
                                                  : KindPoses::headings_of(kind.spawns).size());
    return std::max(auto_reach_step(kind.judge.robot()), std::sqrt(area * headings / most_columns));
}

}  // namespace spawnfield
