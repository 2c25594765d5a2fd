#include "query/raster_judge.h"

#include <algorithm>
#include <cmath>

namespace spawnfield {

bool has_step(const Steps& steps, int k) { return std::find(steps.begin(), steps.end(), k) != steps.end(); }

Steps replaced_steps(const RasterGrid& grid, double offset, std::span<const RasterPose> column)
{
    Steps out;
    const auto add = [&](int k) {
        if (k < grid.heights && !has_step(out, k)) out.push_back(k);
    };
    for (const RasterPose& pose : column) {
        if (!pose.snapped) continue;
        add(grid.step_above(pose.z - offset));
        const int there = grid.step_above(pose.z);
        if (there < grid.heights && grid.z_of(there) <= pose.z + touch_tolerance) add(there);
    }
    return out;
}

RasterJudge::RasterJudge(const Judge::Impl& shared, const RasterOptions& options, const RasterGrid& grid, double offset,
                         double top, int headings)
    : shared_(shared), options_(options), grid_(grid), offset_(offset), top_(top),
      ground_z_(overlap(shared.map.z_limits, options.dims == 2 ? options.z : ZRange{})), area_(options.area),
      is_everywhere_(area_.is_everywhere()), headings_(headings)
{
    if (!is_settled_) return;
    const int settled = settled_block(shared.settler(), options.step);
    if (settled > 1) block_ = settled;
}

void RasterJudge::judge_rows(int first, std::span<RasterRow> out) const
{
    Worker& worker = workers_.local();
    if (options_.dims == 2 && is_everywhere_)
        for (RasterRow& row : out) row.poses.reserve(std::size_t(grid_.cols));  // one layer for each column, mostly
    for (int col = 0; col < grid_.cols; col += block_) {
        const int cols = std::min(block_, grid_.cols - col);
        const Rect block{grid_.x_of(col), grid_.y_of(first), grid_.x_of(col + cols - 1),
                         grid_.y_of(first + int(out.size()) - 1)};
        if (area_.misses(block)) continue;
        if (options_.height_check)
            worker.columns.set(shared_.map.geometry,
                               {grid_.x0, grid_.y0, grid_.step, col, first, cols, int(out.size())});
        if (worker.stand && block_ < most_columns) worker.stand->expect(block);
        if (options_.dims == 2 && worker.columns.are_dense()) {  // else poses are too far apart, also in height
            if (worker.judge) worker.judge->expect(block);
            if (worker.at_headings) worker.at_headings->expect(block);
        }
        for (int i = 0; i < cols; ++i) worker.x[std::size_t(i)] = grid_.x_of(col + i);
        for (int j = 0; j < int(out.size()); ++j)
            judge_row(worker, std::span(worker.x).first(std::size_t(cols)), j, grid_.y_of(first + j),
                      out[std::size_t(j)]);
    }
}

void RasterJudge::judge_row(Worker& worker, std::span<const double> x, int j, double y, RasterRow& out) const
{
    const std::span<Columns::OpenGround> ground = std::span(worker.ground).first(x.size());
    const std::span<PoseJudge::RowVerdict> verdicts = std::span(worker.verdicts).first(x.size());
    const bool is_simple = is_simple_ && worker.judge->can_judge_rows();
    if (is_simple) {
        worker.columns.open_ground(j, ground);
        worker.layered.clear();
        for (std::size_t i = 0; i < x.size(); ++i) {
            if (ground_z_.contains(ground[i].terrain, touch_tolerance)) continue;
            ground[i].terrain = std::numeric_limits<double>::quiet_NaN();
            const ColumnView column = worker.columns.at(int(i), j);
            const std::span<const double> heights = ground_layers(column);
            if (heights.size() != 1) continue;
            ground[i].terrain = heights.front();
            worker.layered.push_back({i, column});
        }
        worker.judge->judge_row(x, y, ground, worker.layered, offset_, verdicts);
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

void RasterJudge::judge_column(Worker& worker, int i, int j, double x, double y, RasterRow& out) const
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

std::span<const double> RasterJudge::ground_layers(const ColumnView& column) const
{
    return heights_within(column.layers, ground_z_);
}

void RasterJudge::layers(Worker& worker, const ColumnView& column, double x, double y, RasterRow& out) const
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

void RasterJudge::settle(StandJudge& stand, const ColumnView& column, const Vec3& place, int layer,
                         RasterRow& out) const
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

const Steps& RasterJudge::near_heights(const ColumnView& column, const Steps& replaced) const
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

void RasterJudge::heights(PoseJudge& judge, const ColumnView& column, const Steps& replaced, double x, double y,
                          RasterRow& out) const
{
    const bool every_layer = options_.layers.kind == LayerChoice::Kind::All;
    const Steps& near = near_heights(column, replaced);
    if (every_layer) out.aerial += std::uint64_t(grid_.heights) - near.size();
    for (const int k : near) {
        if (has_step(replaced, k)) continue;
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

void RasterJudge::all_heights(PoseJudge& judge, const Steps& replaced, double x, double y, RasterRow& out) const
{
    for (int k = grid_.heights - 1; k >= 0; --k) {
        if (has_step(replaced, k)) continue;
        const double z = grid_.z_of(k);
        Judgement judged;  // default: Verdict::Outside
        if (!options_.height_check) judged = judge.judge_collision({x, y, z});
        out.exact_checks += judged.exact_check;
        out.poses.push_back({x, y, z, -1, judged.verdict});
    }
}

std::int32_t RasterJudge::layer_of(const ColumnView& column, const std::optional<Ground>& ground) const
{
    if (!ground || !ground->terrain) return -1;
    const std::span<const double> heights = ground_layers(column);
    for (std::size_t layer = 0; layer < heights.size(); ++layer)
        if (std::abs(heights[layer] - ground->height) <= layer_tolerance) return std::int32_t(layer);
    return -1;
}

Steps RasterJudge::steps_outside() const
{
    Steps out;
    for (int k = 0; k < grid_.heights; ++k)
        if (!shared_.map.z_limits.contains(grid_.z_of(k), touch_tolerance)) out.push_back(k);
    return out;
}

}  // namespace spawnfield
