#pragma once

#include <opencv2/core.hpp>

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace spawnfield {

/// A colour in OpenCV's order: blue, green, red.
using Colour = cv::Vec3b;
using Image = cv::Mat_<Colour>;

inline Colour rgb(unsigned hex)
{
    return {static_cast<std::uint8_t>(hex), static_cast<std::uint8_t>(hex >> 8), static_cast<std::uint8_t>(hex >> 16)};
}

inline const Colour white = rgb(0xffffff), ink = rgb(0x262626), muted = rgb(0x666666);

/// 256 colours from low to high.
using Ramp = std::array<Colour, 256>;

Ramp viridis();

/// Returns a ramp through at least 2 colours at equal distances, linear in between.
Ramp ramp_through(const std::vector<Colour>& colours);

enum class Align { Left, Centre, Right };

struct TextStyle {
    double cap;  ///< height of capital letters, pixels
    Colour colour = ink;
    Align align = Align::Left;
    std::optional<Colour> halo = {};  ///< drawn around the letters, so that they can be read on any background
};

/// Returns the width of the pen that draws the halo of text, pixels.
inline double halo_width(double cap) { return 0.5 * cap; }

// In all functions below, places and lengths are in pixels from the upper left corner of the image, y points down, and
// a pixel's centre is at .5. Parts beyond the image are left out.

/// Returns UTF-8 text in the characters of the font, which is ASCII only: western letters lose their accents, and other
/// characters become question marks.
std::string printable(const std::string& text);
void draw_text(Image& image, const std::string& text, cv::Point2d baseline, const TextStyle& style);
double text_width(const std::string& text, double cap);
std::string cut_to(std::string text, double cap, double width);  ///< wider text is cut and ends in "..."

int whole(double pixels);  ///< rounded, at least 1
void fill(Image& image, const cv::Rect& area, Colour colour);
/// Returns the four sides of a frame around the area, outside of it.
std::array<cv::Rect, 4> sides_around(const cv::Rect& area, int thickness);
void fill_polygon(Image& image, const std::vector<cv::Point2d>& corners, Colour colour);
void draw_outline(Image& image, const std::vector<cv::Point2d>& corners, Colour edge,
                  double edge_width);  ///< a closed line
void draw_dot(Image& image, cv::Point2d centre, double radius, Colour inside, Colour edge, double edge_width);

/// Throws OutputError.
void write_png(const Image& image, const std::filesystem::path& file);

}  // namespace spawnfield
