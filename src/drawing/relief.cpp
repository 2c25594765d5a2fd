#include "drawing/relief.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace spawnfield {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

/// Heights on a coarser raster than the frame's, with its own corner.
struct Blocks {
    HeightImage heights;
    double left = 0, top = 0;  ///< upper left corner, in cells of the frame from the frame's upper left corner
    int cells = 1;             ///< cells of the frame along a side of a block
};

float mean_height(const HeightImage& heights, int row, int col, int cells)
{
    const int last_row = std::min(row + cells, heights.rows);
    const int last_col = std::min(col + cells, heights.cols);
    double sum = 0;
    int count = 0;
    for (int r = row; r < last_row; ++r)
        for (int c = col; c < last_col; ++c)
            if (std::isfinite(heights(r, c))) {
                sum += heights(r, c);
                ++count;
            }
    return count > 0 ? static_cast<float>(sum / count) : nan;
}

/// Returns the part of the frame that the view needs, in blocks of cells. A block is no larger than a pixel, or it is
/// one cell.
Blocks blocks_in(const GridFrame& frame, const HeightImage& heights, const View& view, double pixel)
{
    Blocks blocks;
    blocks.cells = std::max(1, static_cast<int>(std::min(pixel / frame.cell, 1e6)));
    const int border = 2 * blocks.cells;  // gradients at the view's edge use heights beyond it
    const auto clipped = [](double cell, int n) {
        return static_cast<int>(std::clamp<double>(std::floor(cell), 0, n));
    };
    const double top = frame.rows - (view.y0 + view.height - frame.y0) / frame.cell;
    const double left = (view.x0 - frame.x0) / frame.cell;
    const int row0 = clipped(top - border, frame.rows), col0 = clipped(left - border, frame.cols);
    const int row1 = clipped(top + view.height / frame.cell + border + 1, frame.rows);
    const int col1 = clipped(left + view.width / frame.cell + border + 1, frame.cols);
    blocks.left = col0;
    blocks.top = row0;
    const auto count = [&](int first, int last) { return (last - first + blocks.cells - 1) / blocks.cells; };
    blocks.heights = HeightImage(count(row0, row1), count(col0, col1));
    for (int row = 0; row < blocks.heights.rows; ++row)
        for (int col = 0; col < blocks.heights.cols; ++col)
            blocks.heights(row, col) = mean_height(heights, row0 + row * blocks.cells, col0 + col * blocks.cells,
                                                   blocks.cells);
    return blocks;
}

/// Returns the factor for slopes at which ground that is not level looks 19 degrees steep on average.
double exaggeration(const HeightImage& heights, double cell)
{
    constexpr double level = 0.01, cliff = 1, wanted = 0.35, largest = 6;
    double sum = 0, count = 0;
    for (int row = 0; row < heights.rows; ++row)
        for (int col = 0; col < heights.cols; ++col) {
            const double slope = gradient(heights, row, col, cell).norm();
            if (!(slope > level)) continue;
            sum += std::min(slope, cliff);
            ++count;
        }
    return count > 0 ? std::clamp(wanted * count / sum, 1.0, largest) : 1;
}

/// Returns the brightness of a slope compared with level ground, by Lambert's law, with light from the north-west, 45
/// degrees high: -1 to 1.
float light_on(const Eigen::Vector2d& slope)
{
    if (!slope.allFinite()) return 0;
    static const double level = std::sqrt(0.5);
    const Vec3 to_light(-0.5, 0.5, level);
    const double brightness = Vec3(-slope.x(), -slope.y(), 1).normalized().dot(to_light);
    const double relative = brightness < level ? brightness / level - 1 : (brightness - level) / (1 - level);
    return static_cast<float>(std::max(relative, -1.0));
}

/// A place between the centres of two neighbouring cells in a row of n.
struct Between {
    int first, second;
    float share;  ///< weight of the second cell
};

Between between(double place, int n)
{
    const double from_centre = std::clamp(place - 0.5, 0.0, n - 1.0);  // of the first cell
    const int first = static_cast<int>(from_centre);
    return {first, std::min(first + 1, n - 1), static_cast<float>(from_centre - first)};
}

}  // namespace

int cell_index(double distance, int n)
{
    constexpr double tolerance = 1e-6;  // of a cell; for the rounding of coordinates
    if (!(distance >= -tolerance && distance <= n + tolerance)) return -1;
    return std::clamp(static_cast<int>(std::floor(distance)), 0, n - 1);
}

cv::Mat_<float> relief(const GridFrame& frame, const HeightImage& heights, const View& view, cv::Size pixels)
{
    cv::Mat_<float> light(pixels, 0.0f);
    if (heights.values.empty()) return light;
    const Blocks blocks = blocks_in(frame, heights, view, view.width / pixels.width);
    const int rows = blocks.heights.rows, cols = blocks.heights.cols;
    if (rows == 0 || cols == 0) return light;

    const double cell = frame.cell * blocks.cells, steeper = exaggeration(blocks.heights, cell);
    cv::Mat_<float> lit(rows, cols);
    for (int row = 0; row < rows; ++row)
        for (int col = 0; col < cols; ++col)
            lit(row, col) = light_on(steeper * gradient(blocks.heights, row, col, cell));

    std::vector<Between> across;
    for (int col = 0; col < pixels.width; ++col) {
        const double x = view.x0 + (col + 0.5) / pixels.width * view.width;
        across.push_back(between(((x - frame.x0) / frame.cell - blocks.left) / blocks.cells, cols));
    }
    for (int row = 0; row < pixels.height; ++row) {
        const double y = view.y0 + view.height - (row + 0.5) / pixels.height * view.height;
        const Between down = between((frame.rows - (y - frame.y0) / frame.cell - blocks.top) / blocks.cells, rows);
        const float* above = lit[down.first];
        const float* under = lit[down.second];
        for (int col = 0; col < pixels.width; ++col) {
            const auto [a, b, share] = across[static_cast<std::size_t>(col)];
            const float upper = above[a] + share * (above[b] - above[a]),
                        lower = under[a] + share * (under[b] - under[a]);
            light(row, col) = upper + down.share * (lower - upper);
        }
    }
    return light;
}

}  // namespace spawnfield
