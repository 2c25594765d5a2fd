#include "picture/palette.h"
#include "picture/relief.h"

#include <spawnfield/error.h>
#include <spawnfield/heatmap.h>

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace spawnfield {
namespace {

constexpr float no_value = std::numeric_limits<float>::quiet_NaN();

// ---------------------------------------------------------------- colours and words

Colour colour_of(Verdict verdict) { return rgb(verdict_palette[static_cast<std::size_t>(verdict)]); }

const Colour no_pose = rgb(0xe6e6e6), not_valid = rgb(0x9a9a9a), beyond = rgb(0xffffff);

std::string name_of(Verdict verdict)
{
    std::string name = to_string(verdict);
    std::replace(name.begin(), name.end(), '_', ' ');
    return name;
}

std::string counted(std::uint64_t count, const std::string& noun)
{
    return with_commas(count) + ' ' + noun + (count == 1 ? "" : "s");
}

/// "1,234  5.6 %"
std::string count_and_share(std::uint64_t count, std::uint64_t total)
{
    std::string text = with_commas(count);
    if (count == 0) return text;
    const double percent = 100 * static_cast<double>(count) / static_cast<double>(total);
    return text + "   " + (percent < 0.05 ? "< 0.1" : fixed(percent, 1)) + " %";
}

// ---------------------------------------------------------------- columns

void check(const RasterResult& raster, const HeatmapOptions& options)
{
    const RasterGrid& grid = raster.grid;
    if (options.pixels < 200 || options.pixels > 16000)
        throw ArgumentError("write_heatmap", "pixels", options.pixels, "200 .. 16000");
    if (!(grid.step > 0) || !std::isfinite(grid.step)) throw ArgumentError("write_heatmap", "raster.grid.step", grid.step, "> 0 m");
    if (grid.cols < 1) throw ArgumentError("write_heatmap", "raster.grid.cols", grid.cols, ">= 1");
    if (grid.rows < 1) throw ArgumentError("write_heatmap", "raster.grid.rows", grid.rows, ">= 1");
}

/// The pose that the picture shows of each column, nullptr where it has none. Row 0 is the largest y.
struct ShownPoses {
    int rows = 0, cols = 0;
    std::vector<const RasterPose*> poses;

    const RasterPose* at(int row, int col) const { return poses[static_cast<std::size_t>(row) * cols + col]; }
    bool is_valid(int row, int col) const { return at(row, col) && at(row, col)->verdict == Verdict::Valid; }
};

/// Valid before not, then higher before lower.
bool is_shown_before(const RasterPose& pose, const RasterPose& other)
{
    const bool valid = pose.verdict == Verdict::Valid, other_valid = other.verdict == Verdict::Valid;
    return valid != other_valid ? valid : pose.z > other.z;
}

ShownPoses shown_poses(const RasterResult& raster)
{
    const RasterGrid& grid = raster.grid;
    ShownPoses shown{grid.rows, grid.cols, {}};
    shown.poses.resize(static_cast<std::size_t>(grid.rows) * grid.cols);
    for (const RasterPose& pose : raster.poses) {
        const double i = std::round((pose.x - grid.x0) / grid.step), j = std::round((pose.y - grid.y0) / grid.step);
        if (!(i >= 0 && i < grid.cols)) throw ArgumentError("write_heatmap", "x of a pose", pose.x, "a column of the raster");
        if (!(j >= 0 && j < grid.rows)) throw ArgumentError("write_heatmap", "y of a pose", pose.y, "a column of the raster");
        const std::size_t row = static_cast<std::size_t>(grid.rows - 1 - static_cast<int>(j));
        const RasterPose*& current = shown.poses[row * grid.cols + static_cast<std::size_t>(i)];
        if (!current || is_shown_before(pose, *current)) current = &pose;
    }
    return shown;
}

/// What a column without a pose is: in 3D rasters all its poses are aerial, which are counted but not listed.
bool is_aerial_without_pose(const RasterResult& raster)
{
    return raster.dims == 3 && raster.counts[static_cast<std::size_t>(Verdict::Aerial)] > 0 && raster.area.is_everywhere();
}

Image verdict_colours(const ShownPoses& shown, Colour without_pose)
{
    Image colours(shown.rows, shown.cols);
    for (int row = 0; row < shown.rows; ++row)
        for (int col = 0; col < shown.cols; ++col) {
            const RasterPose* pose = shown.at(row, col);
            colours(row, col) = pose ? colour_of(pose->verdict) : without_pose;
        }
    return colours;
}

// ---------------------------------------------------------------- quantities: NaN where the column is not valid

cv::Mat_<float> pose_heights(const ShownPoses& shown)
{
    cv::Mat_<float> values(shown.rows, shown.cols, no_value);
    for (int row = 0; row < shown.rows; ++row)
        for (int col = 0; col < shown.cols; ++col)
            if (shown.is_valid(row, col)) values(row, col) = static_cast<float>(shown.at(row, col)->z);
    return values;
}

cv::Mat_<float> clearances(const ShownPoses& shown, double step)
{
    cv::Mat_<std::uint8_t> valid(shown.rows + 2, shown.cols + 2, std::uint8_t{0});  // a ring that is not, around all
    for (int row = 0; row < shown.rows; ++row)
        for (int col = 0; col < shown.cols; ++col)
            if (shown.is_valid(row, col)) valid(row + 1, col + 1) = 1;
    cv::Mat_<float> columns;
    cv::distanceTransform(valid, columns, cv::DIST_L2, cv::DIST_MASK_PRECISE);
    cv::Mat_<float> values(shown.rows, shown.cols, no_value);
    for (int row = 0; row < shown.rows; ++row)
        for (int col = 0; col < shown.cols; ++col)
            if (shown.is_valid(row, col)) values(row, col) = static_cast<float>(columns(row + 1, col + 1) * step);
    return values;
}

cv::Mat_<float> slopes(const ShownPoses& shown, const RasterGrid& grid, const GridFrame& frame, const HeightImage& heights)
{
    constexpr double degrees = 180 / 3.14159265358979323846;
    cv::Mat_<float> values(shown.rows, shown.cols, no_value);
    for (int row = 0; row < shown.rows; ++row)
        for (int col = 0; col < shown.cols; ++col) {
            if (!shown.is_valid(row, col)) continue;
            const int cell_col = cell_index((grid.x_of(col) - frame.x0) / frame.cell, frame.cols);
            const int from_below = cell_index((grid.y_of(grid.rows - 1 - row) - frame.y0) / frame.cell, frame.rows);
            if (cell_col < 0 || from_below < 0) continue;
            const double slope = gradient(heights, frame.rows - 1 - from_below, cell_col, frame.cell).norm();
            values(row, col) = static_cast<float>(std::atan(slope) * degrees);
        }
    return values;
}

cv::Mat_<float> quantity_values(const ShownPoses& shown, const RasterGrid& grid, const GridFrame& frame,
                                const HeightImage& heights, HeatmapQuantity quantity)
{
    switch (quantity) {
    case HeatmapQuantity::Height: return pose_heights(shown);
    case HeatmapQuantity::Slope: return slopes(shown, grid, frame, heights);
    case HeatmapQuantity::Clearance:
    case HeatmapQuantity::Verdict: break;
    }
    return clearances(shown, grid.step);
}

/// Clearances and slopes begin at 0, heights at the lowest.
ColourScale scale_for(const cv::Mat_<float>& values, HeatmapQuantity quantity)
{
    const bool from_zero = quantity != HeatmapQuantity::Height;
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const float value : values)
        if (std::isfinite(value)) {
            low = std::min<double>(low, value);
            high = std::max<double>(high, value);
        }
    if (from_zero || low > high) low = 0;
    if (high < low) high = 1;
    if (from_zero && high == 0) high = 1;
    const char* heading = quantity == HeatmapQuantity::Height      ? "height of the pose, m"
                          : quantity == HeatmapQuantity::Clearance ? "clearance, m"
                                                                   : "slope, degrees";
    return {heading, "", ticks_around(low, high), viridis()};
}

Image quantity_colours(const ShownPoses& shown, const cv::Mat_<float>& values, const ColourScale& scale,
                                  Colour without_pose)
{
    Image colours(shown.rows, shown.cols);
    for (int row = 0; row < shown.rows; ++row)
        for (int col = 0; col < shown.cols; ++col) {
            const float value = values(row, col);
            colours(row, col) = std::isfinite(value)   ? scale.at(value)
                                : shown.at(row, col) ? not_valid
                                                       : without_pose;
        }
    return colours;
}

// ---------------------------------------------------------------- legend

std::uint64_t total(const VerdictCounts& counts)
{
    std::uint64_t sum = 0;
    for (const std::uint64_t count : counts) sum += count;
    return sum;
}

/// The one for columns without a pose, if there are any.
void append_no_pose(const ShownPoses& shown, const RasterResult& raster, Legend& legend)
{
    const auto count = std::count(shown.poses.begin(), shown.poses.end(), nullptr);
    if (count == 0 || is_aerial_without_pose(raster)) return;
    const bool lower_layer = !raster.poses.empty() && std::all_of(raster.poses.begin(), raster.poses.end(),
                                                                  [](const RasterPose& pose) { return pose.layer > 0; });
    const std::string name = !raster.area.is_everywhere() ? "off the region, or no terrain" : raster.dims == 3 ? "no pose" : lower_layer ? "no such layer" : "no terrain";
    legend.entries.push_back({no_pose, name, counted(static_cast<std::uint64_t>(count), "column")});
}

/// Those that can occur, or did.
Legend verdict_legend(const RasterResult& raster)
{
    const std::uint64_t all = total(raster.counts);
    Legend legend;
    legend.heading = counted(all, "pose");
    for (const Verdict verdict : {Verdict::Valid, Verdict::Steep, Verdict::Unstable, Verdict::Collision, Verdict::Submerged,
                                  Verdict::OffTerrain, Verdict::Aerial, Verdict::Outside}) {
        const std::uint64_t count = raster.counts[static_cast<std::size_t>(verdict)];
        const bool rare = verdict == Verdict::Outside || verdict == Verdict::Steep || verdict == Verdict::Unstable || (verdict == Verdict::Aerial && raster.dims == 2);
        if (count > 0 || !rare) legend.entries.push_back({colour_of(verdict), name_of(verdict), count_and_share(count, all)});
    }
    return legend;
}

Legend quantity_legend(const RasterResult& raster, const ColourScale& scale)
{
    const std::uint64_t all = total(raster.counts), valid = raster.counts[static_cast<std::size_t>(Verdict::Valid)];
    Legend legend;
    legend.heading = counted(all, "pose");
    legend.scale = scale;
    legend.scale->detail = "valid   " + count_and_share(valid, all);
    legend.entries.push_back({not_valid, "not valid", count_and_share(all - valid, all)});
    return legend;
}

// ---------------------------------------------------------------- plot

View view_of(const RasterGrid& grid)
{
    return {grid.x_of(0) - grid.step / 2, grid.y_of(0) - grid.step / 2, grid.cols * grid.step, grid.rows * grid.step};
}

/// Each pixel as its nearest column says.
Image draw_columns(const Image& colours, const View& columns, const View& view, cv::Size pixels)
{
    Image plot(pixels, beyond);
    std::vector<int> across;
    for (int col = 0; col < pixels.width; ++col) {
        const double x = view.x0 + (col + 0.5) / pixels.width * view.width;
        across.push_back(cell_index((x - columns.x0) / columns.width * colours.cols, colours.cols));
    }
    for (int row = 0; row < pixels.height; ++row) {
        const double y = view.y0 + view.height - (row + 0.5) / pixels.height * view.height;
        const int from = cell_index((columns.y0 + columns.height - y) / columns.height * colours.rows, colours.rows);
        if (from < 0) continue;
        for (int col = 0; col < pixels.width; ++col)
            if (const int column = across[static_cast<std::size_t>(col)]; column >= 0) plot(row, col) = colours(from, column);
    }
    return plot;
}

void shade(Image& plot, const cv::Mat_<float>& light, float depth)
{
    for (int row = 0; row < plot.rows; ++row)
        for (int col = 0; col < plot.cols; ++col)
            if (plot(row, col) != beyond) plot(row, col) = shaded(plot(row, col), light(row, col), depth);
}

/// In units; smaller where they are many, so that they stay apart.
double arrow_length(const Layout& layout, std::size_t count)
{
    const double apart = std::sqrt(layout.plot.area() / std::max(1.0, static_cast<double>(count))) / layout.unit;
    return std::clamp(0.5 * apart, smallest_arrow - 1, 22.0);
}

void draw_spawns(Image& plot, const std::vector<Spawn>& spawns, const View& view, double length, double unit)
{
    for (const Spawn& spawn : spawns) {
        const cv::Point2d at((spawn.position.x() - view.x0) / view.width * plot.cols,
                             (view.y0 + view.height - spawn.position.y()) / view.height * plot.rows);
        const bool inside = at.x >= 0 && at.x <= plot.cols && at.y >= 0 && at.y <= plot.rows;
        if (inside) draw_arrow(plot, at, spawn.yaw, length, unit);
    }
}

}  // namespace

void write_heatmap(const Map& map, const TerrainMap& terrain, const RasterResult& raster, const HeatmapOptions& options,
                   const std::filesystem::path& file)
{
    check(raster, options);
    const ShownPoses shown = shown_poses(raster);
    const HeightImage heights = page_image(terrain, "height.0");
    const Colour without_pose = is_aerial_without_pose(raster) ? colour_of(Verdict::Aerial) : no_pose;
    const View columns = view_of(raster.grid);
    Frame frame{with_room(columns), options.pixels, options.title.empty() ? map.name : options.title, {}};

    Image colours;
    if (options.quantity == HeatmapQuantity::Verdict) {
        colours = verdict_colours(shown, without_pose);
        frame.legend = verdict_legend(raster);
    } else {
        const cv::Mat_<float> values = quantity_values(shown, raster.grid, terrain.frame, heights, options.quantity);
        const ColourScale scale = scale_for(values, options.quantity);
        colours = quantity_colours(shown, values, scale, is_aerial_without_pose(raster) ? not_valid : no_pose);
        frame.legend = quantity_legend(raster, scale);
    }
    append_no_pose(shown, raster, frame.legend);
    if (!options.spawns.empty()) frame.legend.arrow = counted(options.spawns.size(), "spawn");

    const Layout layout = lay_out(frame);
    Image plot = draw_columns(colours, columns, frame.view, layout.plot.size());
    const float depth = options.quantity == HeatmapQuantity::Verdict ? 1 : 0.5f;  // values are read from the lightness
    shade(plot, relief(terrain.frame, heights, frame.view, plot.size()), depth);
    frame.legend.arrow_length = arrow_length(layout, options.spawns.size());
    draw_spawns(plot, options.spawns, frame.view, frame.legend.arrow_length, layout.unit);
    write_png(draw_picture(frame, layout, plot), file);
}

}  // namespace spawnfield
