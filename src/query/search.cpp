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
    if (!rule) return;
    if (stance == Stance::Level)
        throw ArgumentError(function, "heading is given, but stance is Level: only settled robots have a rule for it");
    if (rule->has_several() && (rule->count < 1 || rule->count > HeadingRule::most))
        throw ArgumentError(function, "heading.count", rule->count, "1 .. " + std::to_string(HeadingRule::most));
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

/// One search: makes the draws, and keeps the positions that were judged.
class Searcher {
public:
    Searcher(const Judge& judge, const SearchOptions& options)
        : shared_(judge.impl()), options_(options), area_(options.area),
          box_(overlap(chosen_bounds("search", options.bounds, shared_.map.bounds), options.area.bounds())),
          ground_z_(options.bounds.is_empty() ? ZRange{} : options.bounds.z()), avoided_(options.avoid, box_),
          far_above_(shared_.options.exhaustive ? nullptr : &shared_.map, shared_.options.max_height),
          checked_(options.min_distance)
    {
    }

    SpawnList run()
    {
        SpawnList out = empty_list(options_);
        std::uint64_t failures = 0;
        const auto batch_size = [&](std::uint64_t draws) {
            return batch_for(options_.count, options_.min_distance, out.spawns.size(), draws);
        };
        const auto place = [&](Draw& draw) {
            const double x = draw.uniform(box_.min.x(), box_.max.x()), y = draw.uniform(box_.min.y(), box_.max.y());
            return Vec2(x, y);
        };
        const auto look_at = [&](const Draw& draw, const Vec2& at, PoseJudge& judge, const ColumnView*,
                                 Candidate& candidate) { look(draw, at, judge, candidate); };
        draw_in_order(0, shared_, options_, out, checked_, false, batch_size, place, look_at,
                      [&](const Candidate& candidate) {
                          failures = take(candidate, out) ? 0 : failures + 1;
                          return out.spawns.size() < options_.count && failures < options_.max_failures;
                      });
        out.is_stopped = out.spawns.size() < options_.count && failures < options_.max_failures && is_stopped(options_);
        return out;
    }

private:
    void look(Draw draw, const Vec2& at, PoseJudge& judge, Candidate& out)
    {
        const Vec3& p = out.spawn.position = {at.x(), at.y(), draw.uniform(box_.min.z(), box_.max.z())};
        out.spawn.yaw = draw_yaw(options_, draw);
        out.off_area = !area_.contains(at, p.z());
        if (out.off_area) return;
        const bool is_aerial = far_above_.holds(p);
        if (is_settled_ && !is_aerial) {
            settle(judge, draw, out);
            return;
        }
        if (!is_clear(out, avoided_, checked_)) return;
        if (is_aerial) {
            out.verdict = Verdict::Aerial;
            return;
        }
        judge.set_rotation(out.spawn.yaw);
        out.set(judge.judge(p));
    }

    /// Lets the robot of a draw down.
    void settle(PoseJudge& judge, Draw& draw, Candidate& out)
    {
        const Vec3 place = out.spawn.position;
        const Column& column = judge.column_at(place.head<2>());
        const std::optional<Ground> ground = ground_below(column, place.z());
        const bool is_near = ground && place.z() - ground->height <= shared_.options.max_height + touch_tolerance;
        out.off_area = is_near && (!ground_z_.contains(ground->height, touch_tolerance) ||
                                   !area_.contains(place.head<2>(), ground->height));
        if (out.off_area) return;
        let_down(stand_judges_.local(), column, place, shared_.options.stand.lift, options_, draw, out);
        is_clear(out, avoided_, checked_);
    }

    /// Counts a draw. Returns whether it gave a spawn.
    bool take(const Candidate& candidate, SpawnList& out)
    {
        ++out.draws;
        if (candidate.off_area) {
            ++out.off_area;
            return false;
        }
        if (candidate.near_avoided) {
            ++out.near_avoided;
            return false;
        }
        if (!candidate.clear || !checked_.is_still_clear(candidate.spawn.position)) {
            ++out.too_close;
            return false;
        }
        checked_.add(candidate.spawn.position);
        ++out.counts[candidate.verdict];
        out.exact_checks += candidate.exact_checks;
        if (candidate.verdict != Verdict::Valid) return false;
        add_spawn(candidate, out);
        return true;
    }

    const Judge::Impl& shared_;
    const SearchOptions& options_;
    const bool is_settled_ = options_.stance == Stance::Settled;
    const AreaIndex area_;
    const Bounds box_;
    const ZRange ground_z_;  ///< settled: ground beyond it does not count
    const AvoidIndex avoided_;
    const FarAbove far_above_;
    PerThread<StandJudge> stand_judges_{[this] { return StandJudge(shared_); }};  ///< only for settled poses
    TakenPoints checked_;
};

}  // namespace

SpawnList search(const Judge& judge, const SearchOptions& options)
{
    check_spawn_options("search", options);
    check_heading("search", options.heading, options.stance);
    if (options.max_failures < 1) throw ArgumentError("search", "max_failures", double(options.max_failures), ">= 1");
    if (options.stance == Stance::Settled) judge.impl().settler();  // throws if the obstacles are voxels
    return Searcher(judge, options).run();
}

}  // namespace spawnfield
