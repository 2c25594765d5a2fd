#pragma once

#include "picture/figure.h"
#include "picture/ticks.h"

#include <functional>
#include <optional>

namespace spawnfield {

/// Part of the ground that a plot shows, m; (x0, y0) is its lower left corner.
struct View {
    double x0 = 0, y0 = 0, width = 1, height = 1;
};

/// The view with its shorter side widened on both ends until it is at least 1/12 of the longer one.
View with_room(View view);

/// Colours for the values from `low` to `high`.
struct ColourScale {
    std::string heading;  ///< quantity and unit
    std::string detail;   ///< second line, may be empty
    Ticks ticks;          ///< at least one
    Ramp ramp;
    double low = ticks.lowest(), high = ticks.highest();

    Colour at(double value) const;  ///< beyond the scale the nearest end's
};

/// A scale that ends at the data: from low to high, with round ticks in between. A range of no length is widened by 1.
ColourScale scale_between(const std::string& heading, double low, double high, const Ramp& ramp);

struct LegendEntry {
    Colour colour;
    std::string name;
    std::string detail;  ///< second line, may be empty
};

/// What stands in the plot, as spawns do.
struct LegendSymbol {
    std::string name;
    /// Draws into a square of symbol_size units. Empty: the symbol is words alone.
    std::function<void(Figure&, cv::Point2d centre)> draw = {};
    Colour colour = white;
};
inline constexpr double symbol_size = 22;

struct Legend {
    std::string heading;               ///< may be empty
    std::optional<ColourScale> scale;  ///< drawn as a bar
    std::vector<LegendEntry> entries;
    std::vector<LegendSymbol> symbols = {};
};

/// All of a picture but its plot.
struct PictureFrame {
    View view;
    int pixels = 1000;  ///< longer side
    std::string title;  ///< may be empty
    Legend legend;
    std::string caption = {};  ///< second line, below the title; may be empty
};

/// Where everything stands, in pixels.
struct Layout {
    double unit = 1;  ///< a thousandth of the longer side: what texts and lines are measured in
    cv::Size size;    ///< of the picture
    cv::Rect plot;
    cv::Point2d panel;         ///< upper left corner of the legend
    double column_height = 0;  ///< of the legend's columns
    cv::Point2d bearing;       ///< upper left corner of scale bar and north arrow
    Ticks x_ticks, y_ticks;
};

/// The legend stands to the right of the plot, or below it where the view is wide.
Layout lay_out(const PictureFrame& frame);

/// Title, axes, legend, scale bar and north arrow: all but the plot.
void draw_surroundings(Figure& figure, const PictureFrame& frame, const Layout& layout);

/// The whole picture; plot has the size layout.plot.
Image draw_picture(const PictureFrame& frame, const Layout& layout, const Image& plot);

}  // namespace spawnfield
