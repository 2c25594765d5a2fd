#include "base/chosen_bounds.h"
#include "base/number.h"
#include "free_space/bounds_tile.h"
#include "query/area_index.h"
#include "query/avoid_index.h"
#include "query/spawning.h"

#include <spawnfield/error.h>

#include <cmath>

namespace spawnfield {

void check_avoided(const char* function, const AvoidedPoints& group)
{
    if (!(group.distance >= 0) || !std::isfinite(group.distance))
        throw ArgumentError(function, "avoid.distance", group.distance, ">= 0 m");
    for (const Vec3& point : group.points)
        for (const double value : point)
            if (!std::isfinite(value)) throw ArgumentError(function, "avoid.points", value, "finite numbers, m");
}

void check_ground(const char* function, const ZRange& z, Stance stance, const std::optional<double>& offset)
{
    if (!(z.low <= z.high)) throw ArgumentError(function, "z.high", z.high, "at least z.low");
    if (offset && !std::isfinite(*offset)) throw ArgumentError(function, "offset", *offset, "a finite number, m");
    if (offset && stance == Stance::Settled)
        throw ArgumentError(function, "offset is " + number(*offset) +
                                          ", but stance is Settled: settled robots stand on the ground, and only level "
                                          "ones have an offset; give stance Level, or no offset");
}

void check_heading(const char* function, const std::optional<HeadingRule>& rule, Stance stance)
{
    constexpr int most = 64;  // bits of RasterRest::valid_headings
    if (!rule) return;
    if (stance == Stance::Level)
        throw ArgumentError(function, "heading is given, but stance is Level: only settled robots have a rule for it");
    if (rule->has_several() && (rule->count < 1 || rule->count > most))
        throw ArgumentError(function, "heading.count", rule->count, "1 .. " + std::to_string(most));
    for (const double value : {rule->x, rule->y})
        if (!std::isfinite(value)) throw ArgumentError(function, "heading.x and y", value, "finite numbers, m");
}

void check_offset(const char* function, double offset, double max_height)
{
    if (offset > max_height + touch_tolerance)
        throw ArgumentError(function, "offset", offset,
                            "at most max_height, " + number(max_height) + " m: such poses are aerial");
}

double auto_offset(const Robot& robot)
{
    constexpr double above_ground = 0.1;  // m
    return above_ground - robot.bounds().min.z();
}

bool is_in_flat_ground(const Robot& robot, double offset) { return offset + robot.bounds().min.z() <= touch_margin; }

namespace {

/// Recognises poses so far above all solid space that they are certainly aerial, without looking at their columns. Uses
/// a coarse image of the highest solid points.
class FarAbove {
public:
    /// Without a map, `holds()` is always false.
    explicit FarAbove(const Map* map, double max_height) : max_height_(max_height)
    {
        if (map == nullptr) return;
        raster_ = &map->solid_bounds.impl();
        map_ = map;
        while (level_ + 1 < raster_->levels().size() && raster_->levels()[level_].cell < finest) ++level_;
        if (raster_->levels().empty()) raster_ = nullptr;
    }

    bool holds(const Vec3& p) const
    {
        if (raster_ == nullptr || !is_within(*map_, p)) return false;
        const TileLevel& level = raster_->levels()[level_];
        const double u = (p.x() - raster_->x0) / level.cell, v = (p.y() - raster_->y0) / level.cell;
        const double col = std::floor(u), row = std::floor(v);
        // A line along a border between cells may also meet solids of the other cell.
        const auto is_near_border = [](double in_cell) { return in_cell < 1e-6 || in_cell > 1 - 1e-6; };
        if (is_near_border(u - col) || is_near_border(v - row)) return false;
        if (!(col >= 0 && row >= 0 && col < double(raster_->whole_cols(level_)) &&
              row < double(raster_->whole_rows(level_))))
            return false;
        const auto c = std::uint32_t(col), r = std::uint32_t(row);
        const BoundsTile tile = raster_->open(level_, c / BoundsTile::side, r / BoundsTile::side);
        if (tile.is_empty()) return true;
        const std::uint16_t top = tile.tops[r % BoundsTile::side * BoundsTile::side + c % BoundsTile::side];
        return top == 0 || p.z() - max_height_ > tile.height(top) + margin;
    }

private:
    static constexpr double finest = 1.5;   // m; finer images are too large for the cache
    static constexpr double margin = 1e-5;  // m

    const SolidBounds::Impl* raster_ = nullptr;
    const Map* map_ = nullptr;
    std::size_t level_ = 0;
    const double max_height_;
};

}  // namespace

SpawnList search(const Judge& judge, const SearchOptions& options)
{
    check_spawn_options("search", options);
    if (options.max_failures < 1) throw ArgumentError("search", "max_failures", double(options.max_failures), ">= 1");
    const AreaIndex area(options.area);
    const Map& map = judge.map();
    const Bounds box = overlap(chosen_bounds("search", options.bounds, map.bounds), options.area.bounds());
    const FarAbove far_above(judge.options().exhaustive ? nullptr : &map, judge.options().max_height);
    const AvoidIndex avoided(options.avoid, box);
    TakenPoints checked(options.min_distance);

    const auto position = [&](Draw& draw) {
        const double x = draw.uniform(box.min.x(), box.max.x()), y = draw.uniform(box.min.y(), box.max.y());
        return Vec3(x, y, draw.uniform(box.min.z(), box.max.z()));
    };
    const auto place = [&](std::uint64_t index) -> Vec2 {
        Draw draw(options.seed, index);
        return position(draw).head<2>();
    };
    const auto look = [&](std::uint64_t index, PoseJudge& pose_judge) {
        Draw draw(options.seed, index);
        Candidate out;
        const Vec3& p = out.spawn.position = position(draw);
        out.spawn.yaw = draw_yaw(options, draw);
        out.off_area = !area.contains(p.head<2>(), p.z());
        if (out.off_area) return out;
        out.near_avoided = !avoided.is_clear(p);
        if (out.near_avoided) return out;
        out.clear = checked.before().is_clear(p);
        if (!out.clear) return out;
        if (far_above.holds(p)) {
            out.verdict = Verdict::Aerial;
            return out;
        }
        pose_judge.set_rotation(out.spawn.yaw);
        out.set(pose_judge.judge(p));
        return out;
    };
    SpawnList out;
    std::uint64_t failures = 0;
    const auto batch_size = [&](std::uint64_t draws) {
        return batch_for(options.count, options.min_distance, out.spawns.size(), draws);
    };
    draw_in_order(0, judge.impl(), options, out, checked, batch_size, place, look, [&](const Candidate& candidate) {
        ++out.draws;
        ++failures;
        if (candidate.off_area) {
            ++out.off_area;
        } else if (candidate.near_avoided) {
            ++out.near_avoided;
        } else if (!candidate.clear || !checked.is_still_clear(candidate.spawn.position)) {
            ++out.too_close;
        } else {
            checked.add(candidate.spawn.position);
            ++out.counts[candidate.verdict];
            out.exact_checks += candidate.exact_checks;
            if (candidate.verdict == Verdict::Valid) {
                out.spawns.push_back(candidate.spawn);
                failures = 0;
            }
        }
        return out.spawns.size() < options.count && failures < options.max_failures;
    });
    return out;
}

}  // namespace spawnfield
