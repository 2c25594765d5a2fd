#include "reach/straight_ways.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace spawnfield {
namespace {

constexpr double same_ground = 1e-6;  // m: heights of the same layer, looked up from different ways

}  // namespace

/// Returns the height of the ground at a point if a place near it shows that there is nothing but this level ground, as
/// far as the robot gets in a reach step.
std::optional<double> StraightWays::open_ground(const Vec2& at, double ground) const
{
    const RasterGrid& grid = graph_.grid;
    const int col = int(std::lround((at.x() - grid.x_of(0)) / grid.step)),
              row = int(std::lround((at.y() - grid.y_of(0)) / grid.step));
    if (col < 0 || row < 0 || col >= grid.cols || row >= grid.rows) return std::nullopt;
    WayJudge& judge = graph_.way_judges.local();
    const std::size_t column = graph_.column_of(col, row);
    for (std::size_t place = graph_.first[column]; place < graph_.first[column + 1]; ++place)
        if (graph_.is_open(place) && std::abs(graph_.ground[place] - ground) <= 2 * judge.flatness())
            return judge.ground_near({at.x(), at.y(), graph_.ground[place]}, 2 * judge.flatness());
    return std::nullopt;
}

void StraightWays::add(const Vec3& ground, double yaw, std::optional<RobotAtRest> standing)
{
    way_.push_back({ground, yaw});
    standing_ = std::move(standing);
}

/// Returns where the robot stands if it can go there.
std::optional<RobotAtRest> StraightWays::go(const Vec2& to, double yaw)
{
    WayJudge& judge = graph_.way_judges.local();
    if (!standing_) standing_ = judge.stand(way_.back().ground, way_.back().yaw);
    return standing_ ? judge.go(*standing_, to, yaw) : std::nullopt;
}

/// Turns on the spot. Returns whether the robot can do so.
bool StraightWays::turn(double yaw)
{
    constexpr double largest = 2 * std::numbers::pi / lattice_headings;  // rad
    const Stop start = way_.back();
    const double angle = turn_between(start.yaw, yaw);
    const int pieces = int(std::ceil(std::abs(angle) / largest - 1e-9));
    for (int k = 1; k <= pieces; ++k) {
        const double next = k == pieces ? yaw : start.yaw + angle * k / pieces;
        if (is_open_) {
            add(start.ground, next, std::nullopt);
            continue;
        }
        const auto standing = go(start.ground.head<2>(), next);
        if (!standing || std::abs(standing->ground.z() - start.ground.z()) > same_ground) return false;
        add(start.ground, next, standing);
    }
    return true;
}

/// Drives straight ahead, at most a reach step. Returns whether the robot can do so.
bool StraightWays::drive(const Vec2& to)
{
    const Stop from = way_.back();
    const auto open = open_ground(to, from.ground.z());
    if (open) {
        is_open_ = true;
        add({to.x(), to.y(), *open}, from.yaw, std::nullopt);
        return true;
    }
    const auto standing = go(to, from.yaw);
    is_open_ = false;
    if (!standing) return false;
    add(standing->ground, from.yaw, standing);
    return true;
}

std::optional<std::vector<Stop>> StraightWays::find(const Stop& from, const Stop& to, bool ends_anywhere)
{
    way_ = {from};
    standing_.reset();
    is_open_ = open_ground(from.ground.head<2>(), from.ground.z()).has_value();
    const Vec2 begin = from.ground.head<2>(), line = to.ground.head<2>() - begin;
    const double length = line.norm();
    if (length > 0 && !turn(std::atan2(line.y(), line.x()))) return std::nullopt;
    const int pieces = int(std::ceil(length / graph_.grid.step));
    for (int k = 1; k <= pieces; ++k)
        if (!drive(k == pieces ? Vec2(to.ground.head<2>()) : Vec2(begin + line * k / pieces))) return std::nullopt;
    const bool is_there = std::abs(way_.back().ground.z() - to.ground.z()) <= same_ground;
    if (!(ends_anywhere || is_there) || !turn(to.yaw)) return std::nullopt;
    return way_;
}

}  // namespace spawnfield
