#include <spawnfield/audit.h>

#include "query/obstacle_below.h"
#include "reach/reach_graph.h"

#include <spawnfield/error.h>
#include <spawnfield/kept_graph.h>

#include <algorithm>
#include <cmath>

namespace spawnfield {
namespace {

void check(const AuditOptions& options)
{
    const auto refuse = [](const char* name, double value, const char* limit) {
        throw ArgumentError("audit_robot", name, value, limit);
    };
    if (options.step && !(*options.step > 0 && std::isfinite(*options.step))) refuse("step", *options.step, "> 0 m");
    if (!(options.min_room >= 0)) refuse("min_room", options.min_room, ">= 0 m2");
    if (!(options.repair > 0 && std::isfinite(options.repair))) refuse("repair", options.repair, "> 0 m");
}

/// Returns a progress that shows `progress` from one share of the work to another one.
Progress part_of(const Progress& progress, double from, double to)
{
    if (!progress) return {};
    return [=](double done) { progress(from + (to - from) * done); };
}

/// Returns the name of the part of the world that keeps the robot from standing at a pose; empty if it is not known.
std::string culprit_of(const SettledPose& pose, const Map& map)
{
    if (pose.hit) return name_of(*pose.hit, map);
    if (pose.verdict != Verdict::OffTerrain) return "";
    if (const auto obstacle = obstacle_below(pose.contacts)) return name_of(*obstacle, map);
    return pose.ground ? map.geometry.parts()[pose.ground->part].name : "";
}

std::vector<BadPose> find_bad_poses(const Judge& judge, const AuditOptions& options, const Progress& progress)
{
    std::vector<Pose> poses;
    for (const NamedPose& named : options.poses) poses.push_back(named.pose);
    const std::vector<SettledPose> settled = judge.settle(poses, {.threads = options.threads});
    std::vector<Judgement> judgements;
    for (const SettledPose& pose : settled) judgements.push_back(judgement_of(pose));
    const RepairList repairs = repair_poses(
        judge, poses, judgements,
        {.radius = options.repair, .stance = Stance::Settled, .threads = options.threads, .progress = progress});
    std::vector<BadPose> out;
    for (std::size_t i = 0; i < poses.size(); ++i) {
        if (!repairs.repairs[i]) continue;
        out.push_back({.pose = i,
                       .verdict = judgements[i].verdict,
                       .reason = judge.describe(settled[i]),
                       .culprit = culprit_of(settled[i], judge.map()),
                       .repair = *repairs.repairs[i]});
    }
    return out;
}

/// Returns for each island whether the robot can stand there at all headings at one place.
std::vector<bool> has_room_to_turn(const ReachGraph::Impl& graph)
{
    constexpr auto all = HeadingSet(~0u);
    std::vector<bool> out(graph.islands.size());
    graph.for_each_place([&](std::size_t place, int, int) {
        if (graph.valid[place] != all) return;
        std::size_t islands = 0, last = 0;
        graph.for_each_island(place, [&](std::uint32_t island) {
            ++islands;
            last = island;
        });
        if (islands == 1) out[last] = true;
    });
    return out;
}

}  // namespace

double auto_audit_step(const Map& map)
{
    constexpr double columns = 150;
    const Vec3 size = map.bounds.max - map.bounds.min;
    return std::max(map.resolution, std::max(size.x(), size.y()) / columns);
}

std::vector<ClosedRoom> closed_rooms(const ReachGraph& graph, double min_area)
{
    std::vector<std::size_t> places(graph.islands().size());
    for (const ReachPlace& place : graph.places()) ++places[place.island];
    const std::vector<bool> turns = has_room_to_turn(*graph.impl());
    const double step = *graph.options().step;
    std::vector<ClosedRoom> out;
    for (std::size_t island = 1; island < places.size(); ++island) {
        const double area = double(places[island]) * step * step;
        if (turns[island] && area >= min_area) out.push_back({island, area, graph.islands()[island].place});
    }
    std::stable_sort(out.begin(), out.end(), [](const ClosedRoom& a, const ClosedRoom& b) { return a.area > b.area; });
    return out;
}

RobotAudit audit_robot(const Judge& judge, const AuditOptions& options)
{
    check(options);
    // The islands take most of the time.
    RasterResult ground = raster(judge, {.step = options.step.value_or(auto_audit_step(judge.map())),
                                         .stance = Stance::Settled,
                                         .threads = options.threads,
                                         .progress = part_of(options.progress, 0, 0.3)});
    ReachOptions reach = options.reach;
    reach.threads = options.threads;
    reach.progress = part_of(options.progress, 0.3, 0.9);
    const KeptGraph kept = kept_graph(judge, reach);
    const auto valid = double(ground.counts[Verdict::Valid]);
    RobotAudit out{.judge = judge, .raster = std::move(ground), .graph = kept.graph, .notice = kept.notice};
    out.free_area = valid * out.raster.grid.step * out.raster.grid.step;
    if (const std::uint64_t all = out.raster.counts.total(); all > 0) out.free_share = valid / double(all);
    out.closed_rooms = closed_rooms(out.graph, options.min_room);
    out.bad_poses = find_bad_poses(judge, options, part_of(options.progress, 0.9, 1));
    return out;
}

}  // namespace spawnfield
