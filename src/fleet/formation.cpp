#include <spawnfield/error.h>
#include <spawnfield/formation.h>
#include <spawnfield/heading_rule.h>
#include <spawnfield/path.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace spawnfield {
namespace {

constexpr const char* function_name = "formation_slots";

void check_formation(const Formation& formation, std::size_t count)
{
    if (!(formation.spacing > 0) || !std::isfinite(formation.spacing))
        throw ArgumentError(function_name, "spacing", formation.spacing, "> 0 m");
    if (formation.columns < 0) throw ArgumentError(function_name, "columns", formation.columns, ">= 0");
    if (count < 1) throw ArgumentError(function_name, "count", double(count), ">= 1");
}

int columns_of(const Formation& formation, std::size_t count)
{
    if (formation.form == Formation::Form::Line) return int(count);
    if (formation.columns > 0) return std::min(formation.columns, int(count));
    return int(std::ceil(std::sqrt(double(count))));
}

/// Returns the place of a robot if the formation is at 0, 0 and looks along x.
FormationSlot unturned_slot(const Formation& formation, std::size_t count, std::size_t robot)
{
    constexpr double turn = 2 * std::numbers::pi;
    if (formation.form == Formation::Form::Circle) {
        // Neighbours are `spacing` apart in a straight line. A single robot stands in the middle.
        const double radius = count == 1 ? 0 : formation.spacing / (2 * std::sin(std::numbers::pi / double(count)));
        const double angle = turn * double(robot) / double(count);
        return {radius * std::cos(angle), radius * std::sin(angle), angle + std::numbers::pi};
    }
    const int columns = columns_of(formation, count), row = int(robot) / columns, column = int(robot) % columns;
    return {-row * formation.spacing, ((columns - 1) / 2.0 - column) * formation.spacing, 0};
}

/// Returns the path without corners that are straight above each other: turns on the spot.
std::vector<Vec3> distinct_corners(const std::vector<Vec3>& path)
{
    std::vector<Vec3> out;
    for (const Vec3& corner : path)
        if (out.empty() || (corner - out.back()).head<2>().norm() > 0) out.push_back(corner);
    return out;
}

/// Returns how the robot rests at a place, at each heading.
std::vector<SettledPose> rests_at(const Judge& judge, const StartPlace& place)
{
    constexpr int headings = 16;
    double z = 0;
    if (place.z)
        z = *place.z;
    else if (const std::vector<double> layers = column_at(judge.map().geometry, place.x, place.y).layers;
             !layers.empty())
        z = layers.front();
    std::vector<SettledPose> out;
    for (int k = 0; k < headings; ++k) out.push_back(judge.settle({place.x, place.y, z}, heading_of(k, headings)));
    return out;
}

/// Returns the settled poses at a place, at all headings at which the robot can stand and belongs to an island.
std::vector<SettledPose> poses_at(const Judge& judge, const ReachGraph& graph, const std::string& what,
                                  const StartPlace& place)
{
    check_standing(judge, what, place);
    std::vector<SettledPose> out = rests_at(judge, place);
    std::erase_if(out,
                  [&](const SettledPose& pose) { return pose.verdict != Verdict::Valid || !graph.island_of(pose); });
    if (out.empty())
        throw ArgumentError("drivable_path", what + " is " + to_string(place) +
                                                 ", where the robot can stand, but from where it cannot drive; choose "
                                                 "another place, or give a smaller reach step");
    return out;
}

}  // namespace

std::vector<FormationSlot> formation_slots(const Formation& formation, std::size_t count, const StartPlace& at,
                                           double heading)
{
    check_formation(formation, count);
    if (formation.form == Formation::Form::Convoy)
        throw ArgumentError(function_name, "form is Convoy; use convoy_slots()");
    const double cos = std::cos(heading), sin = std::sin(heading);
    std::vector<FormationSlot> out;
    for (std::size_t robot = 0; robot < count; ++robot) {
        const FormationSlot slot = unturned_slot(formation, count, robot);
        out.push_back({at.x + cos * slot.x - sin * slot.y, at.y + sin * slot.x + cos * slot.y,
                       std::remainder(heading + slot.yaw, 2 * std::numbers::pi), at.z});
    }
    return out;
}

double path_length(const Formation& formation)
{
    double out = 0;
    for (std::size_t i = 1; i < formation.path.size(); ++i)
        out += (formation.path[i] - formation.path[i - 1]).head<2>().norm();
    return out;
}

std::vector<FormationSlot> convoy_slots(const Formation& formation, std::size_t count, double start)
{
    check_formation(formation, count);
    const std::vector<Vec3> corners = distinct_corners(formation.path);
    if (corners.size() < 2) throw ArgumentError("convoy_slots", "path needs at least two corners that differ");
    constexpr double rounding = 1e-9;  // m
    if (start + double(count - 1) * formation.spacing > path_length(formation) + rounding) return {};
    std::vector<FormationSlot> out(count);
    std::size_t end = 1;                       // of the piece of the path on which the robot stands
    double before = 0;                         // m, length of the path up to the start of this piece
    for (std::size_t i = 0; i < count; ++i) {  // from the last robot to the first one
        const double wanted = start + double(i) * formation.spacing;
        const auto length = [&] { return (corners[end] - corners[end - 1]).head<2>().norm(); };
        for (; end + 1 < corners.size() && before + length() < wanted; ++end) before += length();
        const Vec3 along = corners[end] - corners[end - 1];
        const Vec3 at = corners[end - 1] + std::min(1.0, (wanted - before) / length()) * along;
        FormationSlot& slot = out[count - 1 - i];
        slot = {at.x(), at.y(), std::atan2(along.y(), along.x()), {}};
        if (!std::isnan(at.z())) slot.z = at.z();
    }
    return out;
}

void check_standing(const Judge& judge, const std::string& what, const StartPlace& place)
{
    const std::vector<SettledPose> rests = rests_at(judge, place);
    if (std::ranges::any_of(rests, [](const SettledPose& pose) { return pose.verdict == Verdict::Valid; })) return;
    throw ArgumentError("check_standing", what + " is " + to_string(place) +
                                              ", where the robot can stand at none of 16 headings (at the first one: " +
                                              judge.describe(rests[0]) + "); choose another place");
}

std::vector<Vec3> drivable_path(const Judge& judge, const ReachGraph& graph, const StartPlace& from,
                                const StartPlace& to)
{
    const std::vector<SettledPose> starts = poses_at(judge, graph, "from", from),
                                   goals = poses_at(judge, graph, "to", to);
    PathSearch search(graph);
    for (const SettledPose& start : starts)
        for (const SettledPose& goal : goals) {
            if (graph.island_of(start) != graph.island_of(goal)) continue;
            const std::optional<Path> path = search.path(start, goal);
            if (!path) continue;
            std::vector<Vec3> out;
            for (const SettledPose& pose : path->poses) {
                Vec3 point = pose.position;
                if (pose.ground) point.z() = pose.ground->height;
                out.push_back(point);
            }
            return out;
        }
    throw ArgumentError("drivable_path", "the robot cannot drive from " + to_string(from) + " to " + to_string(to));
}

}  // namespace spawnfield
