#include "fleet/placed_robots.h"

#include <spawnfield/changes.h>
#include <spawnfield/error.h>

#include <algorithm>
#include <cmath>

namespace spawnfield {
namespace {

/// Returns a pose in the frame of another one.
Pose seen_from(const Pose& frame, const Pose& pose)
{
    const Mat3 turn = frame.rotation.transpose();
    return {turn * (pose.position - frame.position), turn * pose.rotation};
}

CollisionChecker checker_of(const Robot& robot, const Robot& other, bool fcl_only)
{
    return {Geometry(robot_as_obstacle(other, {}, "robot"), 1), robot, fcl_only};
}

void check_distance(const char* argument, double distance)
{
    if (!(distance >= 0) || !std::isfinite(distance)) throw ArgumentError("place_fleet", argument, distance, ">= 0 m");
}

}  // namespace

double reach_of(const Robot& robot)
{
    const Bounds box = robot.bounds();
    return box.min.cwiseAbs().cwiseMax(box.max.cwiseAbs()).norm() + touch_margin;
}

PlacedRobots::PlacedRobots(std::span<const FleetKind> kinds, const FleetOptions& options)
    : count_(kinds.size()), relations_(count_ * count_)
{
    check_distance("min_distance", options.min_distance);
    for (const FleetKind& kind : kinds) radii_.push_back(reach_of(kind.judge.robot()));
    for (std::size_t a = 0; a < count_; ++a)
        for (std::size_t b = 0; b < count_; ++b) {
            Relation& relation = relations_[a * count_ + b];
            relation.distance = options.min_distance;
            if (a == b) relation.distance = std::max(relation.distance, kinds[a].spawns.min_distance);
            const Judge& judge = kinds[a].judge;
            relation.collision.emplace(checker_of(judge.robot(), kinds[b].judge.robot(), judge.options().exhaustive));
        }
    for (const KindDistance& pair : options.between) {
        check_distance("between", pair.distance);
        if (pair.first >= count_ || pair.second >= count_)
            throw ArgumentError("place_fleet", "between has a kind that does not exist");
        for (const std::size_t at : {pair.first * count_ + pair.second, pair.second * count_ + pair.first})
            relations_[at].distance = std::max(relations_[at].distance, pair.distance);
    }
    double reach = 0;
    for (std::size_t a = 0; a < count_; ++a)
        for (std::size_t b = 0; b < count_; ++b)
            reach = std::max({reach, relation(a, b).distance, radii_[a] + radii_[b]});
    constexpr double slack = 1.001;  // much more than the rounding of cells
    cell_ = reach * slack;
}

PlacedRobots::Cell PlacedRobots::cell_at(const Vec3& point, int columns, int rows) const
{
    // Points that are very far apart may share a cell. This is harmless, because the distances decide.
    const auto index = [&](double value) { return std::int64_t(std::floor(value / cell_)); };
    return Cell{std::uint32_t(index(point.x()) + columns)} << 32 | std::uint32_t(index(point.y()) + rows);
}

PlacedRobots::Room PlacedRobots::room_for(std::size_t kind, const Spawn& spawn) const
{
    const Pose pose = pose_of(spawn);
    Room out = Room::Clear;
    for (int column = -1; column <= 1; ++column)
        for (int row = -1; row <= 1; ++row) {
            const auto cell = cells_.find(cell_at(pose.position, column, row));
            if (cell == cells_.end()) continue;
            for (const std::uint32_t i : cell->second) {
                const Placed& other = placed_[i];
                const Relation& between = relation(kind, other.kind);
                const double distance = (other.pose.position - pose.position).norm();
                if (distance < between.distance) return Room::TooClose;
                if (out == Room::Clear && distance <= radii_[kind] + radii_[other.kind] &&
                    !between.collision->is_free(seen_from(other.pose, pose)))
                    out = Room::Overlaps;
            }
        }
    return out;
}

void PlacedRobots::add(std::size_t kind, const Spawn& spawn)
{
    cells_[cell_at(spawn.position)].push_back(std::uint32_t(placed_.size()));
    placed_.push_back({kind, pose_of(spawn)});
}

void PlacedRobots::shrink(std::size_t size)
{
    for (; placed_.size() > size; placed_.pop_back()) cells_[cell_at(placed_.back().pose.position)].pop_back();
}

bool robots_overlap(const Robot& a, const Pose& scene_from_a, const Robot& b, const Pose& scene_from_b)
{
    return !checker_of(a, b, false).is_free(seen_from(scene_from_b, scene_from_a));
}

}  // namespace spawnfield
