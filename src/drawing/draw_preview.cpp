#include "base/number.h"
#include "column/columns.h"
#include "drawing/relief.h"
#include "picture/drawing_module.h"

#include <spawnfield/error.h>
#include <spawnfield/heatmap.h>

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace spawnfield {
namespace {

const Colour nothing = rgb(0xffffff), water_colour = rgb(0x5fa8d3);

/// Returns the colours of terrain from low to high. Each is lighter than the one before, so that they can be read
/// without colour vision.
Ramp hypsometric()
{
    return ramp_through({rgb(0x2f6b52), rgb(0x5f8f4e), rgb(0x9aae5a), rgb(0xd0bf78), rgb(0xe8d6a8), rgb(0xf7ecd5)});
}

/// Returns the colours of obstacles from low to high, lighter with height. They have no hue, unlike those of terrain.
Ramp greys() { return ramp_through({rgb(0x4a4a4a), rgb(0x8a8a8a), rgb(0xb8b8b8)}); }

/// The heights that are seen from above at each pixel, m; NaN where there is nothing of that kind.
struct TopView {
    cv::Mat_<float> terrain, solid, water;

    bool has_water(int row, int col) const  // comparisons with NaN are false
    {
        const float level = water(row, col);
        return std::isfinite(level) && !(level < terrain(row, col)) && !(level < solid(row, col));
    }
    bool has_obstacle(int row, int col) const
    {
        constexpr float above = 1e-3f;
        const float ground = terrain(row, col), top = solid(row, col);
        return std::isfinite(top) && !(top <= ground + above);
    }
};

HeightImage page_or_nothing(const TerrainMap& terrain, const std::string& name)
{
    return terrain.find(name) ? page_image(terrain, name) : HeightImage();
}

/// Replaces the ground by obstacles where there are any.
void add_obstacles(const TerrainMap& terrain, HeightImage& ground)
{
    if (!terrain.find("obstacle")) return;
    const HeightImage obstacle = page_image(terrain, "obstacle");
    for (std::size_t i = 0; i < obstacle.values.size(); ++i)
        if (!std::isnan(obstacle.values[i])) ground.values[i] = obstacle.values[i];
}

/// Returns the heights of the cells at the pixels' centres; NaN beyond the frame.
cv::Mat_<float> samples(const GridFrame& frame, const HeightImage& page, const View& view, cv::Size pixels)
{
    cv::Mat_<float> result(pixels, std::numeric_limits<float>::quiet_NaN());
    if (page.values.empty()) return result;
    std::vector<int> cells;  // of the pixels in a row
    for (int col = 0; col < pixels.width; ++col) {
        const double x = view.x0 + (col + 0.5) / pixels.width * view.width;
        cells.push_back(cell_index((x - frame.x0) / frame.cell, frame.cols));
    }
    for (int row = 0; row < pixels.height; ++row) {
        const double y = view.y0 + view.height - (row + 0.5) / pixels.height * view.height;
        const int from_below = cell_index((y - frame.y0) / frame.cell, frame.rows);
        for (int col = 0; col < pixels.width && from_below >= 0; ++col)
            if (const int cell = cells[std::size_t(col)]; cell >= 0)
                result(row, col) = page(frame.rows - 1 - from_below, cell);
    }
    return result;
}

ColourScale scale_over(const cv::Mat_<float>& heights, const std::string& heading, const Ramp& ramp)
{
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const float height : heights)
        if (std::isfinite(height)) {
            low = std::min<double>(low, height);
            high = std::max<double>(high, height);
        }
    return {heading, "", low <= high ? ticks_around(low, high) : ticks_around(0, 1), ramp};
}

cv::Mat_<float> obstacle_heights(const TopView& view)
{
    cv::Mat_<float> heights = view.solid.clone();
    for (int row = 0; row < heights.rows; ++row)
        for (int col = 0; col < heights.cols; ++col)
            if (!view.has_obstacle(row, col)) heights(row, col) = std::numeric_limits<float>::quiet_NaN();
    return heights;
}

struct Drawing {
    Image image;
    bool terrain = false, obstacles = false, water = false;  ///< whether the image shows any
};

Drawing draw_top(const TopView& view, const cv::Mat_<float>& light, const ColourScale& heights)
{
    const ColourScale grey = scale_over(obstacle_heights(view), "", greys());
    Drawing drawing{Image(view.solid.size(), nothing)};
    for (int row = 0; row < drawing.image.rows; ++row)
        for (int col = 0; col < drawing.image.cols; ++col) {
            Colour& pixel = drawing.image(row, col);
            if (view.has_water(row, col)) {
                drawing.water = true;
                pixel = water_colour;
            } else if (view.has_obstacle(row, col)) {
                drawing.obstacles = true;
                pixel = shaded(grey.colour(view.solid(row, col)), light(row, col));
            } else if (std::isfinite(view.terrain(row, col))) {
                drawing.terrain = true;
                pixel = shaded(heights.colour(view.terrain(row, col)), light(row, col));
            }
        }
    return drawing;
}

Legend legend_of(const Drawing& drawing, const ColourScale& heights)
{
    Legend legend;
    if (drawing.terrain) legend.scale = heights;
    if (drawing.obstacles) legend.entries.push_back({greys()[128], "obstacle", ""});
    if (drawing.water) legend.entries.push_back({water_colour, "water", ""});
    return legend;
}

/// The things that a picture shows, at its pixels.
struct Scenery {
    View view;
    TopView top;
    cv::Mat_<float> light;
};

/// Returns the number of pixels at which a plot is drawn before it is shrunk: two or three times as many along a side
/// as the plot has. That gives smooth edges and keeps thin walls visible.
cv::Size fine_pixels(const View& view, int pixels)
{
    const double scale = 2.0 * pixels / std::max(view.width, view.height);
    return {std::max(1, cvRound(scale * view.width)), std::max(1, cvRound(scale * view.height))};
}

View view_of(const GridFrame& frame)
{
    return with_room({frame.x0, frame.y0, frame.cols * frame.cell, frame.rows * frame.cell});
}

/// Returns the whole map as seen from above. Keeps one page of the terrain in memory at a time, or two while obstacles
/// are added.
Scenery from_above(const TerrainMap& terrain, int pixels)
{
    const GridFrame& grid = terrain.frame;
    Scenery out{view_of(grid), {}, {}};
    const cv::Size fine = fine_pixels(out.view, pixels);
    out.top.water = samples(grid, page_or_nothing(terrain, "water"), out.view, fine);
    HeightImage solid = page_image(terrain, "height.0");
    out.top.terrain = samples(grid, solid, out.view, fine);
    add_obstacles(terrain, solid);
    out.top.solid = samples(grid, solid, out.view, fine);
    out.light = relief(grid, solid, out.view, fine);
    return out;
}

Image picture_of(const Scenery& scenery, const std::string& title, int pixels)
{
    const ColourScale heights = scale_over(scenery.top.terrain, "terrain height, m", hypsometric());
    const Drawing drawing = draw_top(scenery.top, scenery.light, heights);
    const PictureFrame frame{scenery.view, pixels, title, legend_of(drawing, heights)};
    const Layout layout = lay_out(frame);
    Image plot;
    cv::resize(drawing.image, plot, layout.plot.size(), 0, 0, cv::INTER_AREA);
    return draw_picture(frame, layout, plot);
}

// ---------------------------------------------------------------- floors

constexpr double cut_height = 2;         // m above a floor; things that begin higher are not drawn, as in a floor plan
constexpr double most_hidden = 0.25;     // largest share of hidden ground for one picture from above
constexpr std::size_t most_floors = 16;  // with a picture

/// Returns a frame of cells for a picture or an estimate, with at most `most` cells along the longer side.
GridFrame coarse_frame(const Map& map, int most)
{
    const Vec3 size = map.bounds.max - map.bounds.min;
    return frame_around(map.bounds, std::max(map.resolution, std::max(size.x(), size.y()) / most));
}

/// Calls visit(row, col, column) for every cell's centre; row 0 is the largest y.
template <class Visit>
void visit_columns(const Geometry& geometry, const GridFrame& frame, const Visit& visit)
{
    constexpr int block = 64;  // cells; the columns of block x block cells stay in a core's cache
    for (int j0 = 0; j0 < frame.rows; j0 += block)
        for (int i0 = 0; i0 < frame.cols; i0 += block) {
            const int rows = std::min(block, frame.rows - j0), cols = std::min(block, frame.cols - i0);
            const Columns centres(geometry, {frame.x0, frame.y0, frame.cell, i0, j0, cols, rows, 0.5});
            for (int j = 0; j < rows; ++j)
                for (int i = 0; i < cols; ++i) visit(frame.rows - 1 - j0 - j, i0 + i, centres.at(i, j));
        }
}

/// Returns the highest layer of a floor in a column; NaN if there is none.
double ground_of(const ColumnView& column, const Floor& floor, const Map& map)
{
    const std::span<const double> layers = heights_within(column.layers, overlap(floor.z, map.z_limits));
    return layers.empty() ? std::numeric_limits<double>::quiet_NaN() : layers.front();
}

/// Returns the share of all floors' ground that something above it hides, as seen from above. Things that begin less
/// than cut_height above the ground hide nothing: they stand on the ground.
double hidden_share(const Map& map, const std::vector<Floor>& floors)
{
    std::size_t all = 0, hidden = 0;
    visit_columns(map.geometry, coarse_frame(map, 200), [&](int, int, const ColumnView& column) {
        for (const Floor& floor : floors) {
            const double ground = ground_of(column, floor, map);
            if (std::isnan(ground)) continue;
            ++all;
            hidden += std::any_of(column.spans.begin(), column.spans.end(), [&](const Span& span) {
                return span.bottom > ground + cut_height && span.bottom <= map.z_limits.high;
            });
        }
    });
    return all == 0 ? 0 : double(hidden) / double(all);
}

/// Returns the terrain of a floor and everything on it up to cut_height.
Scenery floor_plan(const Map& map, const Floor& floor, int pixels)
{
    const GridFrame grid = coarse_frame(map, 2 * pixels);
    HeightImage terrain(grid.rows, grid.cols), solid = terrain, water = terrain;
    visit_columns(map.geometry, grid, [&](int row, int col, const ColumnView& column) {
        const double ground = ground_of(column, floor, map), level = std::isnan(ground) ? floor.height : ground;
        terrain(row, col) = solid(row, col) = float(ground);
        // Where there is no ground, anything that rises through the floor's height is an obstacle, for example a wall.
        if (const auto top = obstacle_above(column, {&level, 1}, {level, level + cut_height}))
            solid(row, col) = float(std::min(*top, level + cut_height));
        const std::span<const double> surfaces = heights_within(column.water, {level, level + cut_height});
        if (!surfaces.empty()) water(row, col) = float(surfaces.front());
    });
    const View view = view_of(grid);
    const cv::Size fine = fine_pixels(view, pixels);
    return {view,
            {samples(grid, terrain, view, fine), samples(grid, solid, view, fine), samples(grid, water, view, fine)},
            relief(grid, solid, view, fine)};
}

/// Returns an image with a small picture of each floor, in rows, the lowest floor first.
Image floor_pictures(const Map& map, const std::vector<Floor>& floors)
{
    constexpr int longest = 2000, smallest = 400, border = 24;  // pixels
    const std::size_t count = std::min(floors.size(), most_floors);
    const int cols = int(std::ceil(std::sqrt(double(count)))), rows = (int(count) + cols - 1) / cols;
    const int pixels = std::clamp(longest / cols, smallest, 1000);
    std::vector<Image> pictures;
    cv::Size largest;
    for (std::size_t k = 0; k < count; ++k) {
        std::string title = map.name + ", floor " + std::to_string(k) + " at " + number(floors[k].height) + " m";
        if (k + 1 == count && count < floors.size())
            title += " (" + std::to_string(floors.size() - count) + " more are not drawn)";
        pictures.push_back(picture_of(floor_plan(map, floors[k], pixels), title, pixels));
        largest = {std::max(largest.width, pictures[k].cols), std::max(largest.height, pictures[k].rows)};
    }
    Image sheet(rows * (largest.height + border) - border, cols * (largest.width + border) - border, white);
    for (std::size_t k = 0; k < count; ++k) {
        const cv::Point corner(int(k) % cols * (largest.width + border), int(k) / cols * (largest.height + border));
        pictures[k].copyTo(sheet(cv::Rect(corner, pictures[k].size())));
    }
    return sheet;
}

}  // namespace

void drawing_module::write_preview(const Map& map, const TerrainMap& terrain, const std::filesystem::path& file)
{
    if (terrain.frame.rows < 1 || terrain.frame.cols < 1)
        throw ArgumentError("write_preview", "terrain.frame.rows * cols", 0, ">= 1");
    const std::vector<Floor> floors = map.floors.value_or(std::vector<Floor>{});
    const bool by_floor = !floors.empty() && hidden_share(map, floors) > most_hidden;
    write_png(by_floor ? floor_pictures(map, floors) : picture_of(from_above(terrain, 1000), map.name, 1000), file);
}

}  // namespace spawnfield
