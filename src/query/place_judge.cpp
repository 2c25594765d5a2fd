#include "query/place_judge.h"

#include "base/bits.h"
#include "geometry/geometry_impl.h"
#include "query/sight.h"
#include "settle/convex_distance.h"
#include "settle/element_body.h"

#include <spawnfield/error.h>

#include <algorithm>
#include <cmath>

namespace spawnfield {
namespace {

/// Throws ArgumentError unless 0 <= low <= high and low is finite.
void check_range(const std::string& rule, double low, double high)
{
    if (!(low >= 0) || !std::isfinite(low) || !(high >= low))
        throw ArgumentError(rule + " has the range " + std::to_string(low) + " .. " + std::to_string(high) +
                            " m, needs 0 <= low <= high");
}

void check_point(const std::string& rule, const Vec3& point)
{
    if (!point.allFinite()) throw ArgumentError(rule + " has a point that is not finite, needs x, y and z in m");
}

void check_rules(const PlaceRules& rules)
{
    if (!(rules.clearance >= 0 && rules.clearance <= ClearanceMeter::most))
        throw ArgumentError("place rules", "clearance", rules.clearance,
                            "0 .. " + std::to_string(int(ClearanceMeter::most)) + " m");
    for (const PlaceRules::Near& near : rules.near) check_range("near \"" + near.parts + "\"", near.low, near.high);
    for (const PlaceRules::Distance& to : rules.distance_to) {
        check_range("distance_to", to.low, to.high);
        check_point("distance_to", {to.x, to.y, 0});
    }
    for (const Vec3& point : rules.in_view_of) check_point("in_view_of", point);
    for (const Vec3& point : rules.hidden_from) check_point("hidden_from", point);
}

/// Returns the face groups, as in Scene::triangle_groups, of the faces of a part that are nearest to a point on it:
/// one, or several on an edge between them.
std::vector<std::uint32_t> groups_at(const Geometry& geometry, const Vec3& point, std::uint32_t part)
{
    constexpr double reach = 0.01,  // m; contacts are at most 1 mm from their ground
        equal = 1e-6;               // m
    std::vector<std::pair<double, std::uint32_t>> found;
    const Bounds near{point - Vec3::Constant(reach), point + Vec3::Constant(reach)};
    const Convex at = convex_of(Vec3(Vec3::Zero()));
    double least = reach;
    geometry.impl().visit_tiles(near, [&](const Tile& tile, const ElementBox&) {
        for_each_bit(tile.near(near), [&](std::uint32_t element) {
            if (tile.part(element) != part) return;
            found.emplace_back(shortest_way(at, body_of(tile, element, point)).norm(), tile.group(element));
            least = std::min(least, found.back().first);
        });
    });
    std::vector<std::uint32_t> out;
    for (const auto& [distance, group] : found)
        if (distance <= least + equal && std::find(out.begin(), out.end(), group) == out.end()) out.push_back(group);
    return out;
}

/// Marks the parts that are not selected as a whole, but some of whose face groups are.
void mark_divided(const Geometry& geometry, const Selection& selection, std::vector<bool>& marks)
{
    for (std::size_t k = 0; k < selection.groups.size(); ++k)
        if (const std::uint32_t part = geometry.face_groups()[k].part; selection.groups[k] != 0)
            marks[part] = marks[part] || selection.parts[part] == 0;
}

bool is_in_range(double value, double low, double high) { return value >= low && value <= high; }

}  // namespace

PlaceJudge::PlaceJudge(const Geometry& geometry, const Robot& robot, const PlaceRules& rules,
                       const std::optional<double>& sensor_height)
    : geometry_(geometry), rules_(rules)
{
    check_rules(rules);
    const Bounds box = robot.bounds();
    sensor_height_ = sensor_height.value_or(box.max.z());
    half_height_ = (box.max.z() - box.min.z()) / 2;
    reach_ = box.min.cwiseAbs().cwiseMax(box.max.cwiseAbs()).norm();
    for (const RobotPart& part : robot.parts) bodies_.push_back(convex_of(part));
    if (!rules.on.empty()) {
        on_ = selection_of(geometry, rules.on, "on");
        on_parts_.emplace(geometry, *on_);
    }
    if (!rules.not_on.empty()) not_on_ = selection_of(geometry, rules.not_on, "not_on");
    for (const PlaceRules::Near& near : rules.near)
        near_.push_back({PartsNear(geometry, selection_of(geometry, {near.parts}, "near")), near.low, near.high});
    is_divided_.resize(geometry.parts().size());
    for (const auto* selection : {&on_, &not_on_})
        if (*selection) mark_divided(geometry, **selection, is_divided_);
    if (!rules.facing.empty()) facing_.emplace(geometry, selection_of(geometry, {rules.facing}, "facing"));
    if (rules.clearance > 0) clearances_.emplace(geometry, robot);
}

bool PlaceJudge::is_at_distances(const Eigen::Vector2d& at) const
{
    return std::all_of(rules_.distance_to.begin(), rules_.distance_to.end(), [&](const PlaceRules::Distance& to) {
        return is_in_range((at - Eigen::Vector2d(to.x, to.y)).norm(), to.low, to.high);
    });
}

bool PlaceJudge::may_be_at_distances(const Rect& rect) const
{
    constexpr double slack = 1e-6;  // m; larger than the rounding of distances
    const Eigen::Vector2d low(rect.low_x, rect.low_y), high(rect.high_x, rect.high_y);
    return std::all_of(rules_.distance_to.begin(), rules_.distance_to.end(), [&](const PlaceRules::Distance& to) {
        const Eigen::Vector2d point(to.x, to.y);
        const double nearest = (low - point).cwiseMax(point - high).cwiseMax(0).norm(),
                     farthest = (low - point).cwiseAbs().cwiseMax((high - point).cwiseAbs()).norm();
        return nearest <= to.high + slack && farthest >= to.low - slack;
    });
}

bool PlaceJudge::complies(const Pose& pose, std::span<const GroundPoint> grounds) const
{
    return is_at_distances(pose.position.head<2>()) && is_on(grounds) && is_near(pose) && is_in_view(pose) &&
           (!clearances_ || clearances_->clearance_at(pose) >= rules_.clearance);
}

bool PlaceJudge::is_on(std::span<const GroundPoint> grounds) const
{
    if (!on_ && !not_on_) return true;
    return std::all_of(grounds.begin(), grounds.end(), [&](const GroundPoint& ground) {
        const std::vector<std::uint32_t> groups = is_divided_[ground.part]
                                                      ? groups_at(geometry_, ground.point, ground.part)
                                                      : std::vector<std::uint32_t>{0};
        const auto is_selected = [&](const Selection& selection) {
            return [&](std::uint32_t group) { return selection.contains(ground.part, group); };
        };
        return (!on_ || std::all_of(groups.begin(), groups.end(), is_selected(*on_))) &&
               (!not_on_ || std::none_of(groups.begin(), groups.end(), is_selected(*not_on_)));
    });
}

bool PlaceJudge::complies(const SettledPose& pose, double lift) const
{
    std::vector<GroundPoint> grounds;
    for (const RestContact& contact : pose.contacts) grounds.push_back({contact.point, contact.ground});
    return complies(pose.lifted(lift), grounds);
}

bool PlaceJudge::is_near(const Pose& pose) const
{
    if (near_.empty()) return true;
    std::vector<Convex> bodies;
    for (const Convex& body : bodies_) bodies.push_back(moved(body, {Vec3::Zero(), pose.rotation}));
    return std::all_of(near_.begin(), near_.end(), [&](const NearParts& near) {
        const bool is_open = std::isinf(near.high);
        const std::optional<Vec3> way = near.parts.way_from(bodies, pose.position, is_open ? near.low : near.high);
        return way ? way->norm() >= near.low : is_open;
    });
}

bool PlaceJudge::is_in_view(const Pose& pose) const
{
    const Vec3 sensor = pose.position + sensor_height_ * pose.rotation.col(2);
    const auto is_visible = [&](const Vec3& point) { return is_clear_line(geometry_, point, sensor); };
    return std::all_of(rules_.in_view_of.begin(), rules_.in_view_of.end(), is_visible) &&
           std::none_of(rules_.hidden_from.begin(), rules_.hidden_from.end(), is_visible);
}

double PlaceJudge::facing_yaw(const Vec3& place) const
{
    constexpr double straight = 1e-9;  // m
    const Vec3 centre = place + half_height_ * Vec3::UnitZ();
    const std::optional<Vec3> way = facing_->way_from({convex_of(Vec3(Vec3::Zero()))}, centre,
                                                      std::numeric_limits<double>::infinity());
    return !way || way->head<2>().norm() < straight ? 0 : std::atan2(way->y(), way->x());
}

}  // namespace spawnfield
