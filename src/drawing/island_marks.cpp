#include "drawing/island_marks.h"

#include "drawing/text_room.h"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace spawnfield {
namespace {

bool has_own_colour(std::size_t rank) { return rank < island_palette.size(); }

/// Returns the colour of an island by its rank in the picture; 0 is the largest.
Colour colour_of_rank(std::size_t rank)
{
    return rgb(has_own_colour(rank) ? island_palette[rank] : other_islands_colour);
}

std::size_t rank_of(const ShownIslands& islands, std::int32_t number)
{
    return std::size_t(std::lower_bound(islands.numbers.begin(), islands.numbers.end(), number) -
                       islands.numbers.begin());
}

std::string area_text(double area)
{
    char text[40];
    std::snprintf(text, sizeof text, "%.4g m2", area);
    return text;
}

/// Where an island has most room.
struct Middle {
    std::vector<cv::Point> places = {};  ///< the columns that are farthest from the island's edge
    float distance = -1;                 ///< from there to the edge, columns
    int columns = 0;                     ///< number of the island's columns

    cv::Point place() const { return places[places.size() / 2]; }
};

/// Returns 1 for each column whose four neighbours are on the same island, and 0 for all others.
cv::Mat_<std::uint8_t> inner_columns(const cv::Mat_<std::int32_t>& of_columns)
{
    cv::Mat_<std::uint8_t> out(of_columns.size(), std::uint8_t{0});
    for (int row = 1; row + 1 < out.rows; ++row)
        for (int col = 1; col + 1 < out.cols; ++col) {
            const std::int32_t number = of_columns(row, col);
            out(row, col) = number == of_columns(row - 1, col) && number == of_columns(row + 1, col) &&
                            number == of_columns(row, col - 1) && number == of_columns(row, col + 1);
        }
    return out;
}

/// Returns the middle of each island, by its rank.
std::vector<Middle> middles_of(const ShownIslands& islands)
{
    cv::Mat_<float> distances;
    cv::distanceTransform(inner_columns(islands.of_columns), distances, cv::DIST_L2, cv::DIST_MASK_PRECISE);
    std::vector<Middle> out(islands.numbers.size());
    for (int row = 0; row < distances.rows; ++row)
        for (int col = 0; col < distances.cols; ++col) {
            const std::int32_t number = islands.of_columns(row, col);
            if (number < 0) continue;
            Middle& middle = out[rank_of(islands, number)];
            ++middle.columns;
            if (distances(row, col) < middle.distance) continue;
            if (distances(row, col) > middle.distance) middle.places.clear();
            middle.distance = distances(row, col);
            middle.places.emplace_back(col, row);
        }
    return out;
}

}  // namespace

ShownIslands shown_islands(const ShownPoses& shown, const RasterResult& raster, const HeatmapOptions& options)
{
    ShownIslands out{cv::Mat_<std::int32_t>(shown.rows, shown.cols, ShownIslands::not_valid), {}};
    for (int row = 0; row < shown.rows; ++row)
        for (int col = 0; col < shown.cols; ++col)
            if (shown.is_valid(row, col, 1))
                out.of_columns(row, col) = options.islands[std::size_t(shown.at(row, col) - raster.poses.data())];
    out.numbers.assign(out.of_columns.begin(), out.of_columns.end());
    std::sort(out.numbers.begin(), out.numbers.end());
    out.numbers.erase(std::unique(out.numbers.begin(), out.numbers.end()), out.numbers.end());
    std::erase_if(out.numbers, [](std::int32_t number) { return number < 0; });
    return out;
}

Image island_colours(const ShownIslands& islands, const Kinds& kinds)
{
    Image colours(kinds.size());
    for (int row = 0; row < kinds.rows; ++row)
        for (int col = 0; col < kinds.cols; ++col) {
            const std::int32_t number = islands.of_columns(row, col);
            const Kind kind = kinds(row, col);
            colours(row, col) = number >= 0                           ? colour_of_rank(rank_of(islands, number))
                                : number == ShownIslands::no_way      ? rgb(no_way_colour)
                                : kind == obstacle || kind == no_pose ? colour_of(kind)
                                                                      : rgb(not_valid_colour);
        }
    return colours;
}

std::vector<LegendEntry> island_entries(const ShownIslands& islands, const HeatmapOptions& options)
{
    std::vector<LegendEntry> out;
    std::size_t others = 0;
    double area_of_others = 0;
    for (std::size_t rank = 0; rank < islands.numbers.size(); ++rank) {
        const std::int32_t number = islands.numbers[rank];
        const double area = options.island_areas[std::size_t(number)];
        if (has_own_colour(rank)) {
            out.push_back({colour_of_rank(rank), "island " + std::to_string(number), area_text(area)});
        } else {
            ++others;
            area_of_others += area;
        }
    }
    if (others > 0)
        out.push_back({rgb(other_islands_colour),
                       std::to_string(others) + (others == 1 ? " smaller island" : " smaller islands"),
                       (others == 1 ? "" : "together ") + area_text(area_of_others)});
    const auto without_way = std::count(islands.of_columns.begin(), islands.of_columns.end(), ShownIslands::no_way);
    if (without_way > 0)
        out.push_back({rgb(no_way_colour), "no way from there",
                       std::to_string(without_way) + (without_way == 1 ? " column" : " columns")});
    return out;
}

void write_island_numbers(Figure& figure, const ShownIslands& islands, const View& columns, const View& view,
                          const Layout& layout)
{
    const double cap = std::max(11 * layout.unit, 6.0), scale = layout.plot.width / view.width,
                 step = columns.width / islands.of_columns.cols;
    TextRoom room(layout.plot, cap);
    const std::vector<Middle> middles = middles_of(islands);
    for (std::size_t rank = 0; rank < middles.size(); ++rank) {
        const std::string text = std::to_string(islands.numbers[rank]);
        const double width = text_width(text, cap), area = middles[rank].columns * std::pow(step * scale, 2);
        if (!has_own_colour(rank) && area < width * cap) continue;
        const cv::Point place = middles[rank].place();
        const double x = columns.x0 + (place.x + 0.5) * step, y = columns.y0 + columns.height - (place.y + 0.5) * step;
        room.draw(figure, text,
                  {layout.plot.x + (x - view.x0) * scale - width / 2,
                   layout.plot.y + (view.y0 + view.height - y) * scale + cap / 2});
    }
}

}  // namespace spawnfield
