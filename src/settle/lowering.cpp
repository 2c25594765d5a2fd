#include "settle/descent.h"

#include "settle/underside.h"

#include <algorithm>
#include <cmath>

namespace spawnfield {
namespace {

/// Touches that are farther below the highest one than this cannot carry the robot after the next step, m: at most
/// `most_seen` (of large robots, `large_seen` times the robot's size), and `seen_share` times the limit of the step and
/// the robot's size; but those that may count for the margin are always seen.
constexpr double large_seen = 0.3, seen_share = 4;

double highest_of(const std::vector<Touch>& touches)
{
    double out = -std::numeric_limits<double>::infinity();
    for (const Touch& touch : touches) out = std::max(out, touch.height);
    return out;
}

}  // namespace

/// Returns a height of the robot above which this part of it cannot touch the solid from above.
double Settler::Descent::highest_possible(const PlacedBody& part, const NearSolid& solid)
{
    constexpr double rounding = 1e-9;  // m
    double out = solid.bounds.max.z() - part.bounds.min.z();
    if (solid.face) out = std::min(out, height_bound(part, *solid.face));
    return out + rounding;
}

/// Returns a height of the robot below which this part of it cannot touch the solid from below.
double Settler::Descent::lowest_possible(const PlacedBody& part, const NearSolid& solid)
{
    return solid.bounds.min.z() - part.bounds.max.z();
}

/// Returns the level robot at this yaw. Keeps it for the next places.
const Settler::Descent::Level& Settler::Descent::level_robot(double yaw)
{
    const auto found = std::find_if(levels_.begin(), levels_.end(), [&](const Level& l) { return l.yaw == yaw; });
    if (found != levels_.end()) return *found;
    if (levels_.size() == most_yaws) levels_.clear();
    Level& out = levels_.emplace_back();
    out.yaw = yaw;
    out.rotation = rotation(Vec2::Zero());
    const auto placed = [&](const std::vector<Convex>& bodies) {
        std::vector<PlacedBody> all;
        for (const Convex& body : bodies) place(all.emplace_back(PlacedBody{.body = body}), body, out.rotation);
        return all;
    };
    out.parts = placed(settler_.parts_);
    out.joints = placed(settler_.joints_);
    double top = -std::numeric_limits<double>::infinity();
    for (const PlacedBody& part : out.parts) top = std::max(top, part.bounds.max.z());
    out.bottom = underside_of(out.parts).value_or(top);
    return out;
}

/// Sets parts_ to those of the robot with this rotation.
void Settler::Descent::turn_parts(const Mat3& rotation)
{
    if (rotation == placed_) return;
    placed_ = rotation;
    if (rotation == level_->rotation) {
        parts_ = level_->parts;
        return;
    }
    for (std::size_t p = 0; p < turned_.size(); ++p) place(turned_[p], settler_.parts_[p], rotation);
    parts_ = turned_;
}

/// Prepares the solids between which the robot is let down for find_pairs().
void Settler::Descent::set_solids(std::span<const NearSolid> solids)
{
    solids_ = solids;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        lows_[axis].resize(solids.size());
        highs_[axis].resize(solids.size());
        for (std::size_t s = 0; s < solids.size(); ++s) {
            lows_[axis][s] = solids[s].bounds.min[int(axis)];
            highs_[axis][s] = solids[s].bounds.max[int(axis)];
        }
    }
    near_.resize(solids.size());
}

/// Sets near_ to the solids that overlap the robot's bounds seen from above and may touch it while its origin is
/// between two heights. Returns their number.
std::size_t Settler::Descent::find_near(const Bounds& robot, double low_z, double high_z)
{
    const double x0 = robot.min.x(), y0 = robot.min.y(), x1 = robot.max.x(), y1 = robot.max.y(),
                 bottom = robot.min.z() + low_z, top = robot.max.z() + high_z;
    std::size_t count = 0;
    for (std::uint32_t s = 0; s < solids_.size(); ++s) {
        near_[count] = s;
        const bool meets = lows_[0][s] <= x1 && highs_[0][s] >= x0 && lows_[1][s] <= y1 && highs_[1][s] >= y0 &&
                           highs_[2][s] >= bottom && lows_[2][s] <= top;
        count += meets ? 1 : 0;
    }
    return count;
}

/// Sets pairs_ to the parts of the robot and the solids that overlap seen from above, except solids that are above
/// the robot even if its origin is at height `high_z`, or below it at `low_z`. The pair that may be the highest is the
/// first.
void Settler::Descent::find_pairs(double low_z, double high_z)
{
    constexpr double margin = 1e-6;  // m: more than the rounding of highest_possible()
    pairs_.clear();
    Bounds robot;
    for (const PlacedBody& part : parts_) {
        robot.extend(part.bounds.min);
        robot.extend(part.bounds.max);
    }
    const std::span near(near_.data(), find_near(robot, low_z - margin, high_z + margin));
    std::size_t first = 0;
    for (std::uint32_t p = 0; p < parts_.size(); ++p) {
        const Bounds& part = parts_[p].bounds;
        for (const std::uint32_t s : near) {
            const NearSolid& solid = solids_[s];
            if (!part.meets(solid.bounds, 2) || lowest_possible(parts_[p], solid) > high_z) continue;
            const double possible = highest_possible(parts_[p], solid);
            if (possible < low_z) continue;
            pairs_.push_back({possible, p, s});
            if (possible > pairs_[first].possible) first = pairs_.size() - 1;
        }
    }
    if (!pairs_.empty()) std::swap(pairs_[0], pairs_[first]);
}

/// Sets touches_ to those of a part of the robot with a solid, and returns the highest of them.
double Settler::Descent::touch(const PlacedBody& part, const NearSolid& solid, const WantedTouches& wanted)
{
    touches_.clear();
    if (solid.face)
        add_touches(part, *solid.face, touches_, wanted);
    else
        add_touches(part.body, solid.body(), touches_, wanted);
    return highest_of(touches_);
}

/// Lets the level robot down to the lowest height where it has room above its layer.
void Settler::Descent::level(Lowered& out)
{
    turn_parts(level_->rotation);
    out.clear();
    out.rotation = level_->rotation;
    double z = -level_->bottom;
    find_pairs(z, settler_.options_.max_height);
    const auto raise = [&](double height, std::size_t solid) {
        z = height;
        out.wall = solids_[solid].part;
        for (Pair& pair : pairs_) pair.is_ceiling &= pair.bottom >= z + contact_tolerance;
    };
    // The pair that touches highest decides, unless it is a ceiling: then the next one.
    for (;;) {
        while (const auto between = solid_between_parts(z)) raise(between->height, between->solid);
        Pair* const highest = highest_above(z);
        if (highest == nullptr) break;
        highest->bottom = bottom_of(*highest, highest->height, z + contact_tolerance);
        highest->is_ceiling = highest->bottom >= z + contact_tolerance;
        if (!highest->is_ceiling) raise(highest->height, highest->solid);
    }
    if (z > settler_.options_.max_height) return;
    lower(Vec2::Zero(), z, contact_tolerance, out);
    if (const auto between = solid_between_parts(out.z)) {  // the parts find no hold above it
        out.has_room = false;
        out.wall = solids_[between->solid].part;
    }
}

/// Returns a solid that is between two parts of the level robot at height z, and the height at which it is below
/// both. A sheet may be there without touching a part: a foot would be below the ground.
std::optional<Settler::Descent::Between> Settler::Descent::solid_between_parts(double z)
{
    for (const PlacedBody& placed : level_->joints) {
        for (std::size_t s = 0; s < solids_.size(); ++s) {
            const Bounds& solid = solids_[s].bounds;
            if (!placed.bounds.meets(solid, 2) || solid.max.z() - placed.bounds.min.z() <= z ||
                solid.min.z() - placed.bounds.max.z() >= z + contact_tolerance)
                continue;
            const double highest = touch(placed, solids_[s], {.min_height = z});
            if (highest <= z + contact_tolerance) continue;
            if (lowest_blocked(placed.body, solids_[s].body()) < z + contact_tolerance) return Between{highest, s};
        }
    }
    return std::nullopt;
}

/// Returns the pair whose highest touch is higher than z and higher than those of the others, without ceilings;
/// nullptr if there is none.
Settler::Descent::Pair* Settler::Descent::highest_above(double z)
{
    Pair* out = nullptr;
    for (Pair& pair : pairs_) {
        if (pair.is_ceiling || pair.possible <= z) continue;
        if (std::isnan(pair.height))
            pair.possible = pair.height = touch(parts_[pair.part], solids_[pair.solid], {.min_height = z});
        if (pair.height <= z) continue;
        z = pair.height;
        out = &pair;
    }
    return out;
}

/// Returns the height from which on a pair touches, up to its highest touch. If that is below `enough`, returns any
/// height between both.
double Settler::Descent::bottom_of(const Pair& pair, double highest, double enough)
{
    const Convex& body = parts_[pair.part].body;
    const NearSolid& solid = solids_[pair.solid];
    // Below its highest touch, the part overlaps the solid at least by its thickness there: mostly enough.
    touch(parts_[pair.part], solid, {.min_height = highest - contact_tolerance});
    for (const Touch& touch : touches_) {
        const auto top = upper_end(body, touch.point.x(), touch.point.y());
        const double bottom = top ? touch.point.z() + touch.height - *top : highest;
        if (bottom < enough) return bottom;
    }
    return lowest_blocked(body, solid.body());
}

/// Lowers the robot onto the solids that are not higher than about z. It has no room if a solid reaches from below
/// z to more than `rise` above it: a wall.
void Settler::Descent::lower(const Vec2& angles, double z, double rise, Lowered& out)
{
    out.angles = angles;
    out.z = -std::numeric_limits<double>::infinity();
    out.touches.clear();
    out.has_room = false;
    out.wall.reset();
    out.ceiling = std::numeric_limits<double>::infinity();
    out.seen = z + rise;
    const double below = std::max(2 * contact_gap, std::min(std::max(most_seen, large_seen * settler_.reach_),
                                                            seen_share * settler_.reach_ * limit_));
    const Attitude attitude(rotation(angles), yaw_parts_);
    out.rotation = attitude.rotation;
    turn_parts(attitude.rotation);
    find_pairs(z - rise - below, out.seen);
    for (const Pair& pair : pairs_) {
        const double least = std::max(out.z, z - rise) - below;
        if (pair.possible < least) continue;
        const PlacedBody& part = parts_[pair.part];
        const NearSolid& solid = solids_[pair.solid];
        WantedTouches wanted = solid.wanted;
        wanted.min_height = least;
        const double highest = touch(part, solid, wanted);
        if (highest > out.seen) {
            const double bottom = bottom_of(pair, highest, z - rise);
            if (bottom < out.ceiling) {
                out.ceiling = bottom;
                out.wall = solid.part;
            }
            if (bottom < z - rise) return;
            continue;
        }
        out.z = std::max(out.z, highest);
        for (const Touch& touch : touches_)
            out.touches.push_back({touch, attitude.rise(touch.point, touch.normal), pair.part, pair.solid});
    }
    if (out.touches.empty()) out.z = z;  // nothing is below it
    out.has_room = out.z <= out.ceiling;
}

/// Returns the height of the robot's origin at which the robot, raised without turning, meets something. parts_
/// must have its attitude.
double Settler::Descent::ceiling_above(const Lowered& at)
{
    double out = at.ceiling;
    find_pairs(at.z, at.z + settler_.options_.headroom);
    for (const Pair& pair : pairs_) {
        const PlacedBody& part = parts_[pair.part];
        const NearSolid& solid = solids_[pair.solid];
        const double lowest = lowest_possible(part, solid);
        if (lowest <= at.seen || lowest >= out || pair.possible <= at.z) continue;
        if (touch(part, solid, {.min_height = at.z}) <= at.z + contact_tolerance) continue;
        out = std::min(out, lowest_blocked(part.body, solid.body()));
    }
    return out;
}

}  // namespace spawnfield
