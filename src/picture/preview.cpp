#include "picture/relief.h"

#include <spawnfield/error.h>
#include <spawnfield/heatmap.h>

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace spawnfield {
namespace {

const Colour nothing = rgb(0xffffff), water_colour = rgb(0x5fa8d3);

/// From lowlands to heights, each lighter than the one before: readable without seeing colours apart.
Ramp hypsometric()
{
    return ramp_through({rgb(0x2f6b52), rgb(0x5f8f4e), rgb(0x9aae5a), rgb(0xd0bf78), rgb(0xe8d6a8), rgb(0xf7ecd5)});
}

/// Without a hue, which tells obstacles from terrain; higher is lighter.
Ramp greys() { return ramp_through({rgb(0x4a4a4a), rgb(0x8a8a8a), rgb(0xb8b8b8)}); }

/// What a look from above meets at each pixel, m; NaN where there is nothing of its kind.
struct TopView {
    cv::Mat_<float> terrain, solid, water;

    bool has_water(int row, int col) const  // a comparison with NaN is false
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

/// The obstacles, and the ground beside them.
void add_obstacles(const TerrainMap& terrain, HeightImage& ground)
{
    if (!terrain.find("obstacle")) return;
    const HeightImage obstacle = page_image(terrain, "obstacle");
    ground = obstacle.isNaN().select(ground, obstacle);
}

/// The cells at the pixels' centres.
cv::Mat_<float> samples(const GridFrame& frame, const HeightImage& page, const View& view, cv::Size pixels)
{
    cv::Mat_<float> result(pixels, std::numeric_limits<float>::quiet_NaN());
    if (page.size() == 0) return result;
    for (int row = 0; row < pixels.height; ++row) {
        const double y = view.y0 + view.height - (row + 0.5) / pixels.height * view.height;
        const int from_below = cell_index((y - frame.y0) / frame.cell, frame.rows);
        for (int col = 0; col < pixels.width && from_below >= 0; ++col) {
            const double x = view.x0 + (col + 0.5) / pixels.width * view.width;
            const int cell = cell_index((x - frame.x0) / frame.cell, frame.cols);
            if (cell >= 0) result(row, col) = page(frame.rows - 1 - from_below, cell);
        }
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
    bool terrain = false, obstacles = false, water = false;  ///< whether there are any
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
                pixel = shaded(grey.at(view.solid(row, col)), light(row, col));
            } else if (std::isfinite(view.terrain(row, col))) {
                drawing.terrain = true;
                pixel = shaded(heights.at(view.terrain(row, col)), light(row, col));
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

}  // namespace

void write_preview(const TerrainMap& terrain, const std::string& title, const std::filesystem::path& file)
{
    const GridFrame& grid = terrain.frame;
    if (grid.rows < 1 || grid.cols < 1) throw ArgumentError("write_preview", "terrain.frame.rows * cols", 0, ">= 1");
    const View view = with_room({grid.x0, grid.y0, grid.cols * grid.cell, grid.rows * grid.cell});
    // Drawn two or three times as fine as the plot will be, then shrunk: smooth edges, and thin walls do not vanish.
    constexpr double finer = 2000;
    const double scale = finer / std::max(view.width, view.height);
    const cv::Size pixels(std::max(1, cvRound(scale * view.width)), std::max(1, cvRound(scale * view.height)));

    TopView top;
    top.water = samples(grid, page_or_nothing(terrain, "water"), view, pixels);
    HeightImage solid = page_image(terrain, "height.0");
    top.terrain = samples(grid, solid, view, pixels);
    add_obstacles(terrain, solid);
    top.solid = samples(grid, solid, view, pixels);
    const ColourScale heights = scale_over(top.terrain, "terrain height, m", hypsometric());
    const Drawing drawing = draw_top(top, relief(grid, solid, view, pixels), heights);

    const Frame frame{view, 1000, title, legend_of(drawing, heights)};
    const Layout layout = lay_out(frame);
    Image plot;
    cv::resize(drawing.image, plot, layout.plot.size(), 0, 0, cv::INTER_AREA);
    write_png(draw_picture(frame, layout, plot), file);
}

}  // namespace spawnfield
