#include "base/base64.h"
#include "base/png.h"
#include "base/text.h"
#include "drawing/figure.h"

#include <charconv>
#include <cstdint>
#include <cstdio>
#include <string_view>

namespace spawnfield {
namespace {

/// Returns a number rounded to hundredths, without trailing zeros.
std::string number(double value)
{
    char text[400];
    char* end = std::to_chars(text, text + sizeof text, value + 0.0, std::chars_format::fixed, 2).ptr;
    while (end[-1] == '0') --end;
    if (end[-1] == '.') --end;
    const std::string_view shown(text, static_cast<std::size_t>(end - text));
    return shown == "-0" ? "0" : std::string(shown);
}

std::string hex(Colour colour)
{
    char text[8];
    std::snprintf(text, sizeof text, "#%02x%02x%02x", colour[2], colour[1], colour[0]);
    return text;
}

std::string attribute(const char* name, const std::string& value)
{
    return std::string(" ") + name + "=\"" + value + '"';
}

class SvgWriter {
public:
    void operator()(const TextMark& mark)
    {
        constexpr std::array anchors{"start", "middle", "end"};
        std::string element = "<text" + attribute("x", number(mark.baseline.x)) +
                              attribute("y", number(mark.baseline.y)) +
                              attribute("font-size", number(mark.style.cap / cap_height)) +
                              attribute("text-anchor", anchors[static_cast<std::size_t>(mark.style.align)]);
        const std::string text = ">" + xml_escaped(printable(mark.text)) + "</text>\n";
        if (mark.style.halo)
            out_ += element + attribute("fill", "none") + attribute("stroke", hex(*mark.style.halo)) +
                    attribute("stroke-width", number(halo_width(mark.style.cap))) + text;
        out_ += element + attribute("fill", hex(mark.style.colour)) + text;
    }
    void operator()(const AreaMark& mark)
    {
        out_ += "<rect" + box(mark.area) + attribute("fill", hex(mark.colour)) + "/>\n";
    }
    void operator()(const PolygonMark& mark)
    {
        std::string points;
        for (const cv::Point2d& corner : mark.corners)
            points += (points.empty() ? "" : " ") + number(corner.x) + ',' + number(corner.y);
        out_ += "<polygon" + attribute("points", points) + attribute("fill", mark.inside ? hex(*mark.inside) : "none") +
                edge(mark.edge, mark.edge_width) + "/>\n";
    }
    void operator()(const DotMark& mark)
    {
        out_ += "<circle" + attribute("cx", number(mark.centre.x)) + attribute("cy", number(mark.centre.y)) +
                attribute("r", number(mark.radius)) + attribute("fill", hex(mark.inside)) +
                edge(mark.edge, mark.edge_width) + "/>\n";
    }
    void operator()(const ImageMark& mark)
    {
        out_ += "<image" + box({mark.corner, mark.pixels.size()}) + attribute("preserveAspectRatio", "none") +
                " xlink:href=\"data:image/png;base64," +
                base64(bgr_png("picture", mark.pixels.rows, mark.pixels.cols, mark.pixels.ptr())) + "\"/>\n";
    }
    void operator()(const ClipMark& mark)
    {
        if (is_clipped_) out_ += "</g>\n";
        is_clipped_ = !mark.area.empty();
        if (!is_clipped_) return;
        const std::string id = "clip" + std::to_string(++clips_);
        out_ += "<clipPath" + attribute("id", id) + "><rect" + box(mark.area) + "/></clipPath>\n<g" +
                attribute("clip-path", "url(#" + id + ")") + ">\n";
    }
    std::string take()
    {
        (*this)(ClipMark{});
        return std::move(out_);
    }

private:
    static constexpr double cap_height = 0.72;  ///< height of a sans-serif font's capitals, as a share of the font size

    static std::string box(const cv::Rect& area)
    {
        return attribute("x", number(area.x)) + attribute("y", number(area.y)) +
               attribute("width", number(area.width)) + attribute("height", number(area.height));
    }
    static std::string edge(Colour colour, double width)
    {
        return width > 0 ? attribute("stroke", hex(colour)) + attribute("stroke-width", number(width)) +
                               attribute("stroke-linejoin", "round")
                         : "";
    }

    std::string out_;
    bool is_clipped_ = false;
    int clips_ = 0;
};

}  // namespace

std::string svg_of(const Figure& figure)
{
    const std::string width = std::to_string(figure.size.width), height = std::to_string(figure.size.height);
    SvgWriter writer;
    for (const Mark& mark : figure.marks) std::visit(writer, mark);
    return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
           "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\" version=\"1.1\"" +
           attribute("width", width) + attribute("height", height) +
           attribute("viewBox", "0 0 " + width + ' ' + height) +
           " font-family=\"Helvetica, Arial, 'Liberation Sans', sans-serif\" xml:space=\"preserve\">\n<rect" +
           attribute("width", width) + attribute("height", height) + attribute("fill", "#ffffff") + "/>\n" +
           writer.take() + "</svg>\n";
}

}  // namespace spawnfield
