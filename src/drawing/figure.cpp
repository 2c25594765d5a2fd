#include "drawing/figure.h"

#include <spawnfield/output_file.h>

namespace spawnfield {
namespace {

/// Draws marks into an image, one after the other.
class Painter {
public:
    explicit Painter(cv::Size size) : image_(size, white), target_(image_) {}

    void operator()(const TextMark& mark) { draw_text(target_, mark.text, shifted(mark.baseline), mark.style); }
    void operator()(const AreaMark& mark) { fill(target_, mark.area - origin_, mark.colour); }
    void operator()(const PolygonMark& mark)
    {
        std::vector<cv::Point2d> corners;
        for (const cv::Point2d& corner : mark.corners) corners.push_back(shifted(corner));
        if (mark.inside) fill_polygon(target_, corners, *mark.inside);
        if (mark.edge_width > 0) draw_outline(target_, corners, mark.edge, mark.edge_width);
    }
    void operator()(const DotMark& mark)
    {
        draw_dot(target_, shifted(mark.centre), mark.radius, mark.inside, mark.edge, mark.edge_width);
    }
    void operator()(const ImageMark& mark)
    {
        mark.pixels.copyTo(target_(cv::Rect(mark.corner - origin_, mark.pixels.size())));
    }
    void operator()(const ClipMark& mark)
    {
        target_ = mark.area.empty() ? image_ : Image(image_(mark.area));
        origin_ = mark.area.empty() ? cv::Point() : mark.area.tl();
    }
    const Image& image() const { return image_; }

private:
    cv::Point2d shifted(cv::Point2d place) const { return place - cv::Point2d(origin_); }

    Image image_, target_;  ///< target: the part of the image in which marks are drawn; it shares the image's pixels
    cv::Point origin_;      ///< upper left corner of that part
};

}  // namespace

void draw_text(Figure& figure, const std::string& text, cv::Point2d baseline, const TextStyle& style)
{
    if (!text.empty()) figure.marks.emplace_back(TextMark{text, baseline, style});
}

void draw_image(Figure& figure, cv::Point corner, const Image& pixels)
{
    figure.marks.emplace_back(ImageMark{corner, pixels});
}

void fill(Figure& figure, const cv::Rect& area, Colour colour) { figure.marks.emplace_back(AreaMark{area, colour}); }

void outline(Figure& figure, const cv::Rect& area, int thickness, Colour colour)
{
    for (const cv::Rect& side : sides_around(area, thickness)) fill(figure, side, colour);
}

void draw_polygon(Figure& figure, std::vector<cv::Point2d> corners, Colour inside, Colour edge, double edge_width)
{
    figure.marks.emplace_back(PolygonMark{std::move(corners), inside, edge, edge_width});
}

void draw_outline(Figure& figure, std::vector<cv::Point2d> corners, Colour edge, double edge_width)
{
    figure.marks.emplace_back(PolygonMark{std::move(corners), std::nullopt, edge, edge_width});
}

void draw_dot(Figure& figure, cv::Point2d centre, double radius, Colour inside, Colour edge, double edge_width)
{
    figure.marks.emplace_back(DotMark{centre, radius, inside, edge, edge_width});
}

void clip(Figure& figure, const cv::Rect& area) { figure.marks.emplace_back(ClipMark{area}); }

Image paint(const Figure& figure)
{
    Painter painter(figure.size);
    for (const Mark& mark : figure.marks) std::visit(painter, mark);
    return painter.image();
}

void write_figure(const Figure& figure, PictureFormat format, const std::filesystem::path& file)
{
    switch (format) {
    case PictureFormat::Png: return write_png(paint(figure), file);
    case PictureFormat::Svg: return write_file_atomically(file, svg_of(figure));
    case PictureFormat::Pdf: return write_file_atomically(file, pdf_of(figure));
    }
}

}  // namespace spawnfield
