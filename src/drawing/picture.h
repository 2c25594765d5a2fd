#pragma once

#include "drawing/figure.h"
#include "drawing/ticks.h"

#include <functional>
#include <optional>

namespace spawnfield {

/// The part of the ground that a plot shows, m. (x0, y0) is its lower left corner.
struct View {
    double x0 = 0, y0 = 0, width = 1, height = 1;
};

/// Returns the view with its shorter side widened at both ends, so that it is at least 1/12 of the longer side.
View with_room(View view);

/// Colours for the values from `low` to `high`.
struct ColourScale {
    std::string heading;  ///< quantity and unit
    std::string detail;   ///< second line, may be empty
    Ticks ticks;          ///< at least one
    Ramp ramp;
    double low = ticks.lowest(), high = ticks.highest();

    Colour colour(double value) const;  ///< values beyond the scale get the colour of the nearest end
};

/// Returns a scale from low to high with round ticks in between. A range without length is widened by 1.
ColourScale scale_between(const std::string& heading, double low, double high, const Ramp& ramp);

struct LegendEntry {
    Colour colour;
    std::string name;
    std::string detail;  ///< second line, may be empty
};

/// A symbol that marks something in the plot, for example a spawn.
struct LegendSymbol {
    std::string name;
    /// Draws the symbol into a square of symbol_size units. Empty: the entry is text only.
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

/// Everything in a picture except its plot.
struct PictureFrame {
    View view;
    int pixels = 1000;  ///< longer side
    std::string title;  ///< may be empty
    Legend legend;
    std::string caption = {};  ///< second line, below the title; may be empty
};

/// The places of everything in a picture, pixels.
struct Layout {
    double unit = 1;  ///< a thousandth of the longer side; the unit of texts and lines
    cv::Size size;    ///< size of the picture
    cv::Rect plot;
    cv::Point2d panel;         ///< upper left corner of the legend
    double column_height = 0;  ///< largest height of the legend's columns
    cv::Point2d bearing;       ///< upper left corner of scale bar and north arrow
    Ticks x_ticks, y_ticks;
};

/// Returns the layout of a picture. The legend is to the right of the plot, or below it if the view is wide.
Layout lay_out(const PictureFrame& frame);

/// Draws everything but the plot: title, axes, legend, scale bar and north arrow.
void draw_surroundings(Figure& figure, const PictureFrame& frame, const Layout& layout);

/// Returns the whole picture. `plot` must have the size of layout.plot.
Image draw_picture(const PictureFrame& frame, const Layout& layout, const Image& plot);

}  // namespace spawnfield
