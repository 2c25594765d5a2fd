#include "base/chosen_bounds.h"
#include "query/area_index.h"
#include "query/headings_judge.h"
#include "query/raster_grid.h"
#include "query/stand_judge.h"

#include <spawnfield/error.h>
#include <spawnfield/query.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

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

/// Numbers of steps, without duplicates.
using Steps = std::vector<int>;

bool contains(const Steps& steps, int k) { return std::find(steps.begin(), steps.end(), k) != steps.end(); }

/// Returns the steps that a column's snapped poses replace, and the steps at the same heights as these poses.
Steps replaced_steps(const RasterGrid& grid, double offset, std::span<const RasterPose> column)
{
    Steps out;
    const auto add = [&](int k) {
        if (k < grid.heights && !contains(out, k)) out.push_back(k);
    };
    for (const RasterPose& pose : column) {
        if (!pose.snapped) continue;
        add(grid.step_above(pose.z - offset));
        const int there = grid.step_above(pose.z);
        if (there < grid.heights && grid.z_of(there) <= pose.z + touch_tolerance) add(there);
    }
    return out;
}

/// The listed poses of one row of columns, and the counts of those that are not listed.
struct Row {
    std::vector<RasterPose> poses;
    std::vector<VerdictTally> tallies;  ///< of the poses, if they are judged at several headings
    std::vector<RasterRest> rests;      ///< of the poses, if they are settled at one yaw
    std::uint64_t aerial = 0, exact_checks = 0;

    void clear()  // keeps the memory
    {
        poses.clear();
        tallies.clear();
        rests.clear();
        aerial = exact_checks = 0;
    }
};

/// Makes room for the poses of these rows. If more room is needed, also makes room for the rows that follow: as if they
/// had as many poses, but at most four times as many poses as now, or one for each column of the raster. `share` is the
/// share of the rows so far, 0 to 1.
void reserve_poses(std::vector<RasterPose>& poses, const std::vector<Row>& rows, double share, double columns)
{
    std::size_t needed = poses.size();
    for (const Row& row : rows) needed += row.poses.size();
    if (needed <= poses.capacity()) return;
    const double expected = std::min(double(needed) / share, std::max(4 * double(needed), columns));
    poses.reserve(std::max(needed + needed / 2, std::size_t(expected)));
}

/// Judges strips of rows. In a strip, it goes from block to block, so that neighbouring columns share work.
class RasterJudge {
public:
    static constexpr int most_rows = 32, most_columns = 128;  ///< of a strip and a block

    /// Returns the number of rows and columns of a block of settled poses. The robots of a block share the search for
    /// the solids below them, if their columns are near enough to each other. 1: they are not.
    static int settled_block(const Settler& settler, double step)
    {
        constexpr double size = 8;  // of a block's side, times the robot's reach
        constexpr int most = 8;
        return std::clamp(int(size * settler.reach() / step), 1, most);
    }

    RasterJudge(const Judge::Impl& shared, const RasterOptions& options, const RasterGrid& grid, double offset,
                double top, int headings)
        : shared_(shared), options_(options), grid_(grid), offset_(offset), top_(top),
          ground_z_(overlap(shared.map.z_limits, options.dims == 2 ? options.z : ZRange{})), area_(options.area),
          is_everywhere_(area_.is_everywhere()), headings_(headings)
    {
        if (!is_settled_) return;
        const int settled = settled_block(shared.settler(), options.step);
        if (settled > 1) block_ = settled;
    }

    /// Judges as many rows as `out` has entries, beginning with row `first`.
    void judge_rows(int first, std::span<Row> out) const
    {
        Worker& worker = workers_.local();
        if (options_.dims == 2 && is_everywhere_)
            for (Row& row : out) row.poses.reserve(std::size_t(grid_.cols));  // one layer for each column, mostly
        for (int col = 0; col < grid_.cols; col += block_) {
            const int cols = std::min(block_, grid_.cols - col);
            if (area_.misses({grid_.x_of(col), grid_.y_of(first), grid_.x_of(col + cols - 1),
                              grid_.y_of(first + int(out.size()) - 1)}))
                continue;
            if (options_.height_check)
                worker.columns.set(shared_.map.geometry,
                                   {grid_.x0, grid_.y0, grid_.step, col, first, cols, int(out.size())});
            if (worker.stand && block_ < most_columns)
                worker.stand->expect({grid_.x_of(col), grid_.y_of(first), grid_.x_of(col + cols - 1),
                                      grid_.y_of(first + int(out.size()) - 1)});
            for (int i = 0; i < cols; ++i) worker.x[std::size_t(i)] = grid_.x_of(col + i);
            for (int j = 0; j < int(out.size()); ++j)
                judge_row(worker, std::span(worker.x).first(std::size_t(cols)), j, grid_.y_of(first + j),
                          out[std::size_t(j)]);
        }
    }

private:
    /// What a thread keeps from strip to strip: mostly memory.
    struct Worker {
        // Only one of these three has a value:
        std::optional<PoseJudge> judge;                            ///< of level poses at options.yaw
        std::optional<HeadingsJudge> at_headings;                  ///< of level poses at several yaws
        std::optional<StandJudge> stand;                           ///< of settled poses
        Columns columns;                                           ///< of the current block
        std::array<double, most_columns> x;                        ///< of the block's columns
        std::array<Columns::OpenGround, most_columns> ground;      ///< in one row of the block
        std::array<PoseJudge::RowVerdict, most_columns> verdicts;  ///< in the same row

        explicit Worker(const RasterJudge& raster)
        {
            if (raster.is_settled_)
                stand.emplace(raster.shared_, raster.options_.is_reachable);
            else if (raster.headings_ > 0)
                at_headings.emplace(raster.shared_, raster.headings_, raster.max_height());
            else
                judge.emplace(raster.shared_, raster.options_.yaw, raster.max_height());
        }
    };

    /// A pose of a 2D raster is `offset` above its layer by definition.
    double max_height() const
    {
        return options_.dims == 2 ? std::numeric_limits<double>::infinity() : shared_.options.max_height;
    }

    /// Judges row j of a block.
    void judge_row(Worker& worker, std::span<const double> x, int j, double y, Row& out) const
    {
        const std::span<Columns::OpenGround> ground = std::span(worker.ground).first(x.size());
        const std::span<PoseJudge::RowVerdict> verdicts = std::span(worker.verdicts).first(x.size());
        const bool is_simple = is_simple_ && worker.judge->can_judge_rows();
        if (is_simple) {
            for (std::size_t i = 0; i < x.size(); ++i) {
                ground[i] = worker.columns.open_ground(int(i), j);
                if (!ground_z_.contains(ground[i].terrain, touch_tolerance))
                    ground[i].terrain = std::numeric_limits<double>::quiet_NaN();
            }
            worker.judge->judge_row(x, y, ground, offset_, verdicts);
        }
        for (std::size_t i = 0; i < x.size(); ++i) {
            if (is_simple && !std::isnan(ground[i].terrain)) {
                out.poses.push_back({x[i], y, ground[i].terrain + offset_, 0, verdicts[i].verdict});
                out.exact_checks += verdicts[i].exact_check;
            } else if (is_everywhere_ || area_.contains({x[i], y})) {
                judge_column(worker, int(i), j, x[i], y, out);
            }
        }
    }

    void judge_column(Worker& worker, int i, int j, double x, double y, Row& out) const
    {
        const ColumnView column = options_.height_check ? worker.columns.at(i, j) : ColumnView();
        if (options_.dims == 2) {
            layers(worker, column, x, y, out);
            return;
        }
        const std::size_t first = out.poses.size();
        if (options_.snap) layers(worker, column, x, y, out);
        const std::size_t steps = out.poses.size();
        const Steps replaced = replaced_steps(grid_, offset_, std::span(out.poses).subspan(first));
        if (options_.height_check && shared_.map.bounds.contains_xy(x, y, touch_tolerance))
            heights(*worker.judge, column, replaced, x, y, out);
        else
            all_heights(*worker.judge, replaced, x, y, out);
        if (steps > first)
            std::inplace_merge(out.poses.begin() + std::ptrdiff_t(first), out.poses.begin() + std::ptrdiff_t(steps),
                               out.poses.end(), [](const RasterPose& a, const RasterPose& b) { return a.z > b.z; });
    }

    /// Returns the layers that are ground, from the top down. RasterPose::layer counts these.
    std::span<const double> ground_layers(const ColumnView& column) const
    {
        return heights_within(column.layers, ground_z_);
    }

    void layers(Worker& worker, const ColumnView& column, double x, double y, Row& out) const
    {
        const std::span<const double> heights = ground_layers(column);
        const int count = int(heights.size());
        for (int layer = 0; layer < count; ++layer) {
            const double height = heights[std::size_t(layer)];
            if (!options_.layers.includes(layer, count)) continue;
            if (options_.dims == 2 && !is_everywhere_ && !area_.contains({x, y}, height)) continue;
            if (options_.snap && !(height >= grid_.z0 - touch_tolerance && height <= top_ + touch_tolerance)) continue;
            if (worker.stand) {
                settle(*worker.stand, column, {x, y, height}, layer, out);
                continue;
            }
            const double z = height + offset_;
            Verdict verdict;
            if (worker.at_headings) {
                out.tallies.push_back(worker.at_headings->judge(column, {x, y, z}, out.exact_checks));
                verdict = merged(out.tallies.back());
            } else {
                const Judgement judged = worker.judge->judge(column, {x, y, z});
                out.exact_checks += judged.exact_check;
                verdict = judged.verdict;
            }
            out.poses.push_back({x, y, z, layer, verdict, options_.snap});
        }
    }

    /// Lets the robot down at a place on a layer.
    void settle(StandJudge& stand, const ColumnView& column, const Vec3& place, int layer, Row& out) const
    {
        const auto settled = [&](double yaw) {
            SettledPose pose = stand.judge(column, place, yaw);
            out.exact_checks += pose.exact_check;
            return pose;
        };
        if (headings_ > 0) {
            VerdictTally tally{};
            for (int k = 0; k < headings_; ++k) ++tally[std::size_t(settled(heading_of(k, headings_)).verdict)];
            out.tallies.push_back(tally);
            out.poses.push_back({place.x(), place.y(), place.z() + offset_, layer, merged(tally)});
            return;
        }
        StandJudge::Choice choice;
        if (options_.heading) {
            choice = stand.judge(column, place, *options_.heading, 0);
            out.exact_checks += choice.exact_checks;
        } else {
            choice.pose = settled(options_.yaw);
        }
        const SettledPose& pose = choice.pose;
        RasterRest rest{.layer_height = place.z()};
        if (pose.has_pose) rest = {place.z(), pose.roll, pose.pitch, pose.tilt, pose.margin, pose.tip_over, pose.belly};
        rest.yaw = pose.yaw;
        rest.valid_headings = choice.valid_headings;
        rest.free_length = choice.free_length;
        out.rests.push_back(rest);
        const double z = pose.has_pose ? pose.position.z() + shared_.options.stand.lift : place.z() + offset_;
        out.poses.push_back({place.x(), place.y(), z, layer, pose.verdict});
    }

    /// Returns the steps that may be near enough to the ground, the steps beyond the map's z limits, and the replaced
    /// steps, from the top down. All other steps are certainly aerial.
    const Steps& near_heights(const ColumnView& column, const Steps& replaced) const
    {
        thread_local Steps near;
        near.clear();
        for (const Span& span : column.spans) {
            const double first = std::ceil((span.top - grid_.z0) / grid_.step_z) - 1;
            const double last = std::floor((span.top + shared_.options.max_height - grid_.z0) / grid_.step_z) + 1;
            const int from = int(std::clamp(first, 0.0, double(grid_.heights)));
            const int to = int(std::clamp(last, -1.0, double(grid_.heights - 1)));
            for (int k = to; k >= from; --k) near.push_back(k);
        }
        near.insert(near.end(), replaced.begin(), replaced.end());
        near.insert(near.end(), outside_.begin(), outside_.end());
        if (column.spans.size() + replaced.size() + outside_.size() > 1) {
            std::sort(near.begin(), near.end(), std::greater<>());
            near.erase(std::unique(near.begin(), near.end()), near.end());
        }
        return near;
    }

    void heights(PoseJudge& judge, const ColumnView& column, const Steps& replaced, double x, double y, Row& out) const
    {
        const bool every_layer = options_.layers.kind == LayerChoice::Kind::All;
        const Steps& near = near_heights(column, replaced);
        if (every_layer) out.aerial += std::uint64_t(grid_.heights) - near.size();
        for (const int k : near) {
            if (contains(replaced, k)) continue;
            const double z = grid_.z_of(k);
            if (!every_layer) {
                const std::int32_t layer = layer_of(column, ground_below(column, z));
                if (layer < 0 || !options_.layers.includes(layer, int(ground_layers(column).size()))) continue;
            }
            const Judgement judged = judge.judge(column, {x, y, z});
            out.exact_checks += judged.exact_check;
            if (judged.verdict == Verdict::Aerial)
                out.aerial += every_layer;
            else
                out.poses.push_back({x, y, z, layer_of(column, judged.ground), judged.verdict});
        }
    }

    /// Judges a column whose aerial poses are listed too: a column outside the map, or any column without height check.
    void all_heights(PoseJudge& judge, const Steps& replaced, double x, double y, Row& out) const
    {
        for (int k = grid_.heights - 1; k >= 0; --k) {
            if (contains(replaced, k)) continue;
            const double z = grid_.z_of(k);
            Judgement judged;  // default: Verdict::Outside
            if (!options_.height_check) judged = judge.judge_collision({x, y, z});
            out.exact_checks += judged.exact_check;
            out.poses.push_back({x, y, z, -1, judged.verdict});
        }
    }

    std::int32_t layer_of(const ColumnView& column, const std::optional<Ground>& ground) const
    {
        if (!ground || !ground->terrain) return -1;
        const std::span<const double> heights = ground_layers(column);
        for (std::size_t layer = 0; layer < heights.size(); ++layer)
            if (std::abs(heights[layer] - ground->height) <= layer_tolerance) return std::int32_t(layer);
        return -1;
    }

    /// Returns the steps of a 3D raster beyond the map's z limits.
    Steps steps_outside() const
    {
        Steps out;
        for (int k = 0; k < grid_.heights; ++k)
            if (!shared_.map.z_limits.contains(grid_.z_of(k), touch_tolerance)) out.push_back(k);
        return out;
    }

    const Judge::Impl& shared_;
    const RasterOptions& options_;
    const RasterGrid& grid_;
    const double offset_;
    const double top_;       ///< upper limit of the bounds' z
    const ZRange ground_z_;  ///< layers beyond it are not ground
    const AreaIndex area_;
    const bool is_everywhere_;
    const int headings_;  ///< 0: only options.yaw
    const bool is_settled_ = options_.stance == Stance::Settled;
    int block_ = most_columns;  ///< columns of a block
    /// Whether all poses on open ground are judged alike: at one yaw, above their layer, anywhere.
    const bool is_simple_ = options_.dims == 2 && !is_settled_ && options_.height_check && headings_ == 0 &&
                            is_everywhere_ && offset_ >= 0 && options_.layers.includes(0, 1);
    const Steps outside_ = steps_outside();
    mutable PerThread<Worker> workers_{[this] { return Worker(*this); }};
};

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
        parallel_in_order<std::vector<Row>>(
            std::size_t((count + strip - 1) / strip), options_.threads, progress,
            [&](std::size_t s, std::vector<Row>& made) {
                const int begin = int(s) * strip;
                made.resize(std::size_t(std::min(strip, count - begin)));
                strips_.judge_rows(first + begin, made);
            },
            [&](std::vector<Row>& made) {
                taken += int(made.size());
                reserve_poses(out.poses, made, double(taken) / count, double(count) * out.grid.cols);
                for (Row& row : made) take(row, out, tallies);
            });
        return out;
    }

private:
    static void take(Row& row, RasterResult& out, std::vector<VerdictTally>* tallies)
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
                else if (!contains(replaced, k))
                    visit({x, y, z, -1, Verdict::Aerial});
            }
            while (next != end) visit(*next++);
        }
}

}  // namespace spawnfield
