#pragma once

#include "picture/canvas.h"
#include "picture/ticks.h"

#include <optional>

namespace spawnfield {

/// Part of the ground that a plot shows, m; (x0, y0) is its lower left corner.
struct View {
    double x0 = 0, y0 = 0, width = 1, height = 1;
};

/// The view with its shorter side widened on both ends until it is at least 1/12 of the longer one.
View with_room(View view);

/// Colours for the values from the lowest tick to the highest.
struct ColourScale {
    std::string heading;  ///< quantity and unit
    std::string detail;   ///< second line, may be empty
    Ticks ticks;
    Ramp ramp;

    Colour at(double value) const;  ///< beyond the ticks the nearest one's
};

struct LegendEntry {
    Colour colour;
    std::string name;
    std::string detail;  ///< second line, may be empty
};

struct Legend {
    std::string heading;               ///< may be empty
    std::optional<ColourScale> scale;  ///< drawn as a bar
    std::vector<LegendEntry> entries;
    std::string arrow;                 ///< what arrows in the plot are; empty: there are none
    double arrow_length = 0;           ///< units, as in the plot
};

/// All of a picture but its plot.
struct Frame {
    View view;
    int pixels = 1000;  ///< longer side
    std::string title;  ///< may be empty
    Legend legend;
};

/// Where everything stands, in pixels.
struct Layout {
    double unit = 1;           ///< a thousandth of the longer side: what texts and lines are measured in
    cv::Size size;             ///< of the picture
    cv::Rect plot;
    cv::Point2d panel;         ///< upper left corner of the legend
    double column_height = 0;  ///< of the legend's columns
    cv::Point2d bearing;       ///< upper left corner of scale bar and north arrow
    Ticks x_ticks, y_ticks;
};

/// The legend stands to the right of the plot, or below it where the view is wide.
Layout lay_out(const Frame& frame);

/// The whole picture; plot has the size layout.plot.
Image draw_picture(const Frame& frame, const Layout& layout, const Image& plot);

/// White with a dark outline, pointing along yaw (from x to y, which is up); a dot if shorter than smallest_arrow.
/// `length` is in units.
void draw_arrow(Image& image, cv::Point2d centre, double yaw, double length, double unit);
inline constexpr double smallest_arrow = 10;

}  // namespace spawnfield
