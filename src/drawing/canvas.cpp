#include "drawing/canvas.h"

#include "base/png.h"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cassert>
#include <string_view>

namespace spawnfield {
namespace {

constexpr int font = cv::FONT_HERSHEY_SIMPLEX;
constexpr double font_cap = 21;  // height of its capitals at scale 1, pixels

/// Mixes `colour` into the image where `cover` is not 0. Parts beyond the image are left out.
void blend(Image& image, const cv::Mat_<std::uint8_t>& cover, cv::Point corner, Colour colour)
{
    const cv::Rect inside = cv::Rect(corner, cover.size()) & cv::Rect({}, image.size());
    for (int row = inside.y; row < inside.y + inside.height; ++row)
        for (int col = inside.x; col < inside.x + inside.width; ++col) {
            const int alpha = cover(row - corner.y, col - corner.x);
            Colour& pixel = image(row, col);
            for (int c = 0; c < 3; ++c)
                pixel[c] = static_cast<std::uint8_t>((pixel[c] * (255 - alpha) + colour[c] * alpha + 127) / 255);
        }
}

constexpr int shift = 6;  // fraction bits in OpenCV's coordinates of shapes

/// Returns a place in OpenCV's coordinates, whose origin is the middle of the first pixel.
cv::Point in_fractions(cv::Point2d p)
{
    return {cvRound((p.x - 0.5) * (1 << shift)), cvRound((p.y - 0.5) * (1 << shift))};
}

cv::Scalar scalar(Colour colour) { return {double(colour[0]), double(colour[1]), double(colour[2])}; }

std::vector<cv::Point> in_fractions(const std::vector<cv::Point2d>& corners)
{
    std::vector<cv::Point> points;
    for (const cv::Point2d& corner : corners) points.push_back(in_fractions(corner));
    return points;
}

}  // namespace

std::string printable(const std::string& text)
{
    constexpr std::string_view latin =  // U+00C0 .. U+00FF without their accents
        "AAAAAAACEEEEIIIIDNOOOOOxOUUUUYPsaaaaaaaceeeeiiiidnooooo/ouuuuypy";
    std::string result;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const auto byte = static_cast<unsigned char>(text[i]);
        const auto next = static_cast<unsigned char>(i + 1 < text.size() ? text[i + 1] : 0);
        if (byte == 0xc3 && next >= 0x80 && next < 0xc0)
            result += latin[next - 0x80];
        else if ((byte & 0xc0) != 0x80)
            result += byte >= ' ' && byte < 127 ? text[i] : '?';
    }
    return result;
}

Ramp viridis()
{
    cv::Mat_<std::uint8_t> steps(1, 256);
    for (int i = 0; i < 256; ++i) steps(i) = static_cast<std::uint8_t>(i);
    Image colours;
    cv::applyColorMap(steps, colours, cv::COLORMAP_VIRIDIS);
    Ramp ramp;
    std::copy(colours.begin(), colours.end(), ramp.begin());
    return ramp;
}

Ramp ramp_through(const std::vector<Colour>& colours)
{
    Ramp ramp;
    for (std::size_t i = 0; i < ramp.size(); ++i) {
        const double place = static_cast<double>(i) / 255 * static_cast<double>(colours.size() - 1);
        const std::size_t from = std::min(static_cast<std::size_t>(place), colours.size() - 2);
        const double share = place - static_cast<double>(from);
        for (int c = 0; c < 3; ++c)
            ramp[i][c] = static_cast<std::uint8_t>(
                cvRound(colours[from][c] * (1 - share) + colours[from + 1][c] * share));
    }
    return ramp;
}

/// Draws the text several times as large and then shrinks it, because OpenCV places text and its lines at whole pixels
/// only.
void draw_text(Image& image, const std::string& text, cv::Point2d baseline, const TextStyle& style)
{
    if (text.empty()) return;
    constexpr int finer = 4;
    const double width = text_width(text, style.cap);
    if (style.align == Align::Centre) baseline.x -= width / 2;
    if (style.align == Align::Right) baseline.x -= width;
    const double border = style.cap / 2 + 1;
    const cv::Point corner(cvFloor(baseline.x - border), cvFloor(baseline.y - style.cap - border));
    const cv::Size size(cvCeil(width + 2 * border) + 1, cvCeil(style.cap + 2 * border) + 1);

    cv::Mat_<std::uint8_t> large, cover;
    const cv::Point origin(cvRound((baseline.x - corner.x) * finer), cvRound((baseline.y - corner.y) * finer));
    const double pen = 0.125 * style.cap;
    const auto write = [&](double pen_width, Colour colour) {
        large.create(size * finer);
        large = 0;
        const int thickness = std::max(1, cvRound(pen_width * finer));
        cv::putText(large, printable(text), origin, font, style.cap * finer / font_cap, cv::Scalar(255), thickness,
                    cv::LINE_AA);
        cv::resize(large, cover, size, 0, 0, cv::INTER_AREA);
        blend(image, cover, corner, colour);
    };
    if (style.halo) write(pen + halo_width(style.cap), *style.halo);
    write(pen, style.colour);
}

double text_width(const std::string& text, double cap)
{
    constexpr int scale = 16;  // measured large, because OpenCV rounds to whole pixels
    int baseline = 0;
    return cv::getTextSize(printable(text), font, scale, 1, &baseline).width * cap / (scale * font_cap);
}

std::string cut_to(std::string text, double cap, double width)
{
    if (text_width(text, cap) <= width) return text;
    text = printable(text);
    while (!text.empty() && text_width(text + "...", cap) > width) text.pop_back();
    return text + "...";
}

int whole(double pixels) { return std::max(1, cvRound(pixels)); }

void fill(Image& image, const cv::Rect& area, Colour colour) { image(area & cv::Rect({}, image.size())) = colour; }

std::array<cv::Rect, 4> sides_around(const cv::Rect& area, int thickness)
{
    const cv::Rect outer(area.x - thickness, area.y - thickness, area.width + 2 * thickness,
                         area.height + 2 * thickness);
    return {cv::Rect(outer.x, outer.y, outer.width, thickness), cv::Rect(outer.x, area.br().y, outer.width, thickness),
            cv::Rect(outer.x, outer.y, thickness, outer.height),
            cv::Rect(area.br().x, outer.y, thickness, outer.height)};
}

void fill_polygon(Image& image, const std::vector<cv::Point2d>& corners, Colour colour)
{
    cv::fillPoly(image, std::vector{in_fractions(corners)}, scalar(colour), cv::LINE_AA, shift);
}

void draw_outline(Image& image, const std::vector<cv::Point2d>& corners, Colour edge, double edge_width)
{
    cv::polylines(image, std::vector{in_fractions(corners)}, true, scalar(edge), whole(edge_width), cv::LINE_AA, shift);
}

void draw_dot(Image& image, cv::Point2d centre, double radius, Colour inside, Colour edge, double edge_width)
{
    const int fractions = cvRound(radius * (1 << shift));
    cv::circle(image, in_fractions(centre), fractions, scalar(inside), cv::FILLED, cv::LINE_AA, shift);
    cv::circle(image, in_fractions(centre), fractions, scalar(edge), whole(edge_width), cv::LINE_AA, shift);
}

void write_png(const Image& image, const std::filesystem::path& file)
{
    assert(image.isContinuous());
    write_bgr_png(file, image.rows, image.cols, image.ptr());
}

}  // namespace spawnfield
