#include "base/chosen_bounds.h"
#include "base/large_list.h"
#include "query/raster_grid.h"
#include "query/raster_judge.h"

#include <spawnfield/error.h>
#include <spawnfield/query.h>

#include <algorithm>
#include <cmath>

namespace spawnfield {
namespace {

/// Returns the number of poses from `from` to `to`, both included, to 1e-9 of a step.
int count_steps(double from, double to, double step, const char* axis)
{
    const double count = std::floor((to - from) / step + 1e-9) + 1;
    if (!(count <= 2147483647.0))
        throw ArgumentError("raster", std::string("steps along ") + axis, count,
                            "at most 2147483647; take a larger step");
    return static_cast<int>(count);
}

bool has_no_z_limits(const Area& area)
{
    const auto is_unlimited = [](const Region& region) { return region.z.is_unlimited(); };
    return std::all_of(area.within.begin(), area.within.end(), is_unlimited) &&
           std::all_of(area.keep_out.begin(), area.keep_out.end(), is_unlimited);
}

void check(const RasterOptions& options)
{
    if (options.dims != 2 && options.dims != 3) throw ArgumentError("raster", "dims", options.dims, "2 or 3");
    if (!(options.step > 0) || !std::isfinite(options.step))
        throw ArgumentError("raster", "step", options.step, "> 0 m");
    if (!(options.step_z >= 0) || !std::isfinite(options.step_z))
        throw ArgumentError("raster", "step_z", options.step_z, "> 0 m");
    check_ground("raster", options.z, options.stance, options.offset);
    if (!std::isfinite(options.yaw)) throw ArgumentError("raster", "yaw", options.yaw, "a finite number, rad");
    if (!options.height_check && options.dims != 3)
        throw ArgumentError(
            "raster", "without height check needs dims 3: a pose of a 2D raster stands on its layer by definition");
    if (options.dims == 3 && !has_no_z_limits(options.area))
        throw ArgumentError(
            "raster", "area has z limits, but with dims 3 its regions must have none; limit the heights with bounds");
    if (options.stance == Stance::Settled && options.dims != 2)
        throw ArgumentError("raster", "settled poses need dims 2: the robot is let down onto the layers of a column");
    check_heading("raster", options.heading, options.stance);
    check_filter("raster", options.is_reachable, options.stance);
    if (!options.snap) return;
    if (options.dims != 3)
        throw ArgumentError("raster", "snap needs dims 3: a pose of a 2D raster stands on its layer by definition");
    if (!options.height_check)
        throw ArgumentError("raster", "snap needs the height check, because only it finds the layers");
}

double chosen_offset(const Judge& judge, const RasterOptions& options)
{
    if (options.stance == Stance::Settled) return judge.options().stand.lift - judge.robot().bounds().min.z();
    const double offset = options.offset.value_or(auto_offset(judge.robot()));
    if (options.snap && !(offset >= 0 && offset <= judge.options().max_height))
        throw ArgumentError("raster", "offset", offset,
                            "0 .. max_height with snap: poses on their layers would be aerial");
    return offset;
}

/// Makes room for the poses of these rows. If more room is needed, also makes room for the rows that follow: as if they
/// had as many poses, but at most four times as many poses as now, or one for each column of the raster. `share` is the
/// share of the rows so far, 0 to 1.
void reserve_poses(std::vector<RasterPose>& poses, const std::vector<RasterRow>& rows, double share, double columns)
{
    std::size_t needed = poses.size();
    for (const RasterRow& row : rows) needed += row.poses.size();
    if (needed <= poses.capacity()) return;
    const double expected = std::min(double(needed) / share, std::max(4 * double(needed), columns));
    reserve_large(poses, std::max(needed + needed / 2, std::size_t(expected)));
}

}  // namespace

RasterGrid raster_grid(const Bounds& bounds, const RasterOptions& options)
{
    RasterGrid grid;
    grid.x0 = bounds.min.x();
    grid.y0 = bounds.min.y();
    grid.z0 = bounds.min.z();
    grid.step = options.step;
    grid.step_z = options.step_z > 0 ? options.step_z : options.step;
    grid.cols = count_steps(grid.x0, bounds.max.x(), grid.step, "x");
    grid.rows = count_steps(grid.y0, bounds.max.y(), grid.step, "y");
    if (double(grid.cols) * grid.rows > 2147483647.0)
        throw ArgumentError("raster", "columns", double(grid.cols) * grid.rows,
                            "at most 2147483647; take a larger step");
    if (options.dims == 3) grid.heights = count_steps(grid.z0, bounds.max.z(), grid.step_z, "z");
    return grid;
}

int RasterGrid::step_above(double height) const
{
    const double lowest = height - touch_tolerance;
    int k = int(std::clamp(std::ceil((lowest - z0) / step_z), 0.0, double(heights)));
    while (k > 0 && z_of(k - 1) >= lowest) --k;  // corrects rounding
    while (k < heights && z_of(k) < lowest) ++k;
    return k;
}

namespace {

/// Returns the progress of a part of some work, for the rows of the whole.
Progress part_of(const Progress& whole, int first, int count, int all)
{
    if (!whole) return {};
    return [=](double share) { whole((first + share * count) / all); };
}

/// Makes rasters of one judge and one set of options.
class RasterMaker {
public:
    RasterMaker(const Judge& judge, const RasterOptions& options, int headings)
        : options_(options), empty_(empty_result(judge, options)),
          strips_(judge.impl(), options_, empty_.grid, empty_.offset, top_, headings)
    {
        // Rows share no work without the height check, and each row takes long.
        if (!options.height_check) most_rows_ = 1;
        if (options.stance == Stance::Settled)
            most_rows_ = RasterJudge::settled_block(judge.impl().settler(), empty_.grid.step);
        judge.map().geometry.impl().expect_all();
    }

    /// Returns the result without poses.
    const RasterResult& empty() const { return empty_; }

    /// Returns the result of these rows. `tallies`, if given, gets those of the poses.
    RasterResult rows(int first, int count, const Progress& progress, std::vector<VerdictTally>* tallies) const
    {
        RasterResult out = empty_;
        out.grid.first_row = first;
        out.grid.rows = count;
        const int strip = std::clamp(count / (4 * thread_count(options_.threads)), 1, most_rows_);
        int taken = 0;  // rows
        parallel_in_order<std::vector<RasterRow>>(
            std::size_t((count + strip - 1) / strip), options_.threads, progress,
            [&](std::size_t s, std::vector<RasterRow>& made) {
                const int begin = int(s) * strip;
                made.resize(std::size_t(std::min(strip, count - begin)));
                strips_.judge_rows(first + begin, made);
            },
            [&](std::vector<RasterRow>& made) {
                taken += int(made.size());
                reserve_poses(out.poses, made, double(taken) / count, double(count) * out.grid.cols);
                for (RasterRow& row : made) take(row, out, tallies);
            });
        return out;
    }

private:
    static void take(RasterRow& row, RasterResult& out, std::vector<VerdictTally>* tallies)
    {
        for (const RasterPose& pose : row.poses) ++out.counts[pose.verdict];
        out.counts[Verdict::Aerial] += row.aerial;
        out.exact_checks += row.exact_checks;
        out.poses.insert(out.poses.end(), row.poses.begin(), row.poses.end());
        out.rests.insert(out.rests.end(), row.rests.begin(), row.rests.end());
        if (tallies != nullptr) tallies->insert(tallies->end(), row.tallies.begin(), row.tallies.end());
        row.clear();
    }

    RasterResult empty_result(const Judge& judge, const RasterOptions& options)
    {
        check(options);
        if (options.stance == Stance::Settled) judge.impl().settler();  // throws if the obstacles are voxels
        const Map& map = judge.map();
        RasterResult out;
        out.dims = options.dims;
        out.stance = options.stance;
        out.yaw = options.yaw;
        out.heading = options.heading;
        out.offset = chosen_offset(judge, options);
        out.area = options.area;
        if (options.dims == 2) out.z = overlap(map.z_limits, options.z);
        const Bounds bounds = chosen_bounds("raster", options.bounds, map.bounds, options.dims);
        out.grid = raster_grid(bounds, options);
        top_ = bounds.max.z();
        return out;
    }

    const RasterOptions options_;
    double top_ = 0;  ///< of the raster's bounds, m
    const RasterResult empty_;
    const RasterJudge strips_;
    int most_rows_ = RasterJudge::most_rows;
};

}  // namespace

RasterResult raster_with(const Judge& judge, const RasterOptions& options, int headings,
                         std::vector<VerdictTally>* tallies)
{
    const RasterMaker maker(judge, options, headings);
    return maker.rows(0, maker.empty().grid.rows, options.progress, tallies);
}

RasterResult raster(const Judge& judge, const RasterOptions& options)
{
    return raster_with(judge, options, 0, nullptr);
}

RasterResult raster_in_parts(const Judge& judge, const RasterOptions& options,
                             const std::function<void(const RasterResult& part)>& take, std::int64_t poses)
{
    const RasterMaker maker(judge, options, 0);
    RasterResult out = maker.empty();
    const RasterGrid& grid = out.grid;
    const std::int64_t in_row = std::int64_t(grid.cols) * std::max(grid.heights, 1);
    const int rows = int(std::clamp<std::int64_t>(poses / in_row, 1, grid.rows));
    for (int first = 0; first < grid.rows; first += rows) {
        const int count = std::min(rows, grid.rows - first);
        const RasterResult part = maker.rows(first, count, part_of(options.progress, first, count, grid.rows), nullptr);
        for (const Verdict verdict : all_verdicts) out.counts[verdict] += part.counts[verdict];
        out.exact_checks += part.exact_checks;
        take(part);
    }
    return out;
}

void for_each_pose(const RasterResult& raster, bool aerial, const std::function<void(const RasterPose&)>& visit)
{
    if (!aerial || raster.dims != 3) {
        for (const RasterPose& pose : raster.poses) visit(pose);
        return;
    }
    const RasterGrid& grid = raster.grid;
    const AreaIndex area(raster.area);
    auto next = raster.poses.begin();
    for (int j = 0; j < grid.rows; ++j)
        for (int i = 0; i < grid.cols; ++i) {
            const double x = grid.x_of(i), y = grid.y_of(j);
            if (!area.contains({x, y})) continue;
            const auto end = std::find_if(next, raster.poses.end(),
                                          [&](const RasterPose& pose) { return pose.x != x || pose.y != y; });
            const Steps replaced = replaced_steps(grid, raster.offset, std::span(next, end));
            for (int k = grid.heights - 1; k >= 0; --k) {
                const double z = grid.z_of(k);
                while (next != end && next->z > z) visit(*next++);
                if (next != end && next->z == z)
                    visit(*next++);
                else if (!has_step(replaced, k))
                    visit({x, y, z, -1, Verdict::Aerial});
            }
            while (next != end) visit(*next++);
        }
}

}  // namespace spawnfield
