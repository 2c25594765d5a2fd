#pragma once

#include "drawing/canvas.h"

#include <spawnfield/picture_format.h>

#include <optional>
#include <variant>

namespace spawnfield {

// The marks of a figure. Places and lengths are as in canvas.h.
struct TextMark {
    std::string text;
    cv::Point2d baseline;
    TextStyle style;
};
struct AreaMark {
    cv::Rect area;
    Colour colour;
};
struct PolygonMark {
    std::vector<cv::Point2d> corners;
    std::optional<Colour> inside;  ///< none: the edge alone
    Colour edge;
    double edge_width = 0;  ///< 0: no edge
};
struct DotMark {
    cv::Point2d centre;
    double radius;
    Colour inside, edge;
    double edge_width;
};
struct ImageMark {
    cv::Point corner;
    Image pixels;
};
/// Clips the following marks to this area, until the next ClipMark. An empty area ends the clipping.
struct ClipMark {
    cv::Rect area;
};
using Mark = std::variant<TextMark, AreaMark, PolygonMark, DotMark, ImageMark, ClipMark>;

/// A picture as a list of marks, the first at the bottom. The same list becomes PNG, SVG or PDF.
struct Figure {
    cv::Size size;  ///< pixels
    std::vector<Mark> marks;
};

// These append marks to the figure. They are named like those of canvas.h, which draw into an image.
void draw_text(Figure& figure, const std::string& text, cv::Point2d baseline, const TextStyle& style);
void draw_image(Figure& figure, cv::Point corner, const Image& pixels);
void fill(Figure& figure, const cv::Rect& area, Colour colour);
void outline(Figure& figure, const cv::Rect& area, int thickness, Colour colour);
void draw_polygon(Figure& figure, std::vector<cv::Point2d> corners, Colour inside, Colour edge, double edge_width);
void draw_outline(Figure& figure, std::vector<cv::Point2d> corners, Colour edge, double edge_width);
void draw_dot(Figure& figure, cv::Point2d centre, double radius, Colour inside, Colour edge, double edge_width);
void clip(Figure& figure, const cv::Rect& area);

Image paint(const Figure& figure);         ///< draws it on white
std::string svg_of(const Figure& figure);  ///< one pixel is one unit. Source: Scalable Vector Graphics 1.1, W3C, 2011
std::string pdf_of(const Figure& figure);  ///< one pixel is 0.72 points, a hundredth of an inch

/// Writes a figure to a file. The same figure gives the same bytes. Throws OutputError.
void write_figure(const Figure& figure, PictureFormat format, const std::filesystem::path& file);

}  // namespace spawnfield
