#pragma once

#include "drawing/shown_columns.h"

namespace spawnfield {

/// The islands that a heat map shows.
struct ShownIslands {
    static constexpr std::int32_t no_way = -1, not_valid = -2;

    /// The number of each column's island. no_way: the robot can stand there, but it can go nowhere. Row 0 is the
    /// largest y.
    cv::Mat_<std::int32_t> of_columns;
    std::vector<std::int32_t> numbers;  ///< those that occur, ascending: the largest island first
};

ShownIslands shown_islands(const ShownPoses& shown, const RasterResult& raster, const HeatmapOptions& options);

/// Returns the colour of each column. The largest islands have a colour each; all others share one.
Image island_colours(const ShownIslands& islands, const Kinds& kinds);

/// Returns an entry for each island with its own colour, and one for all others, with their areas. The last one is for
/// places without a way, if there are any.
std::vector<LegendEntry> island_entries(const ShownIslands& islands, const HeatmapOptions& options);

/// Writes the number of each island where it has most room, the largest island first, if there is room. Islands without
/// their own colour get a number only if they are larger than it. `columns` is the view of the columns, `view` that of
/// the plot.
void write_island_numbers(Figure& figure, const ShownIslands& islands, const View& columns, const View& view,
                          const Layout& layout);

}  // namespace spawnfield
