#include "catch.h"
#include "picture/palette.h"

#include <Eigen/Core>

#include <cmath>
#include <limits>
#include <numbers>

using namespace spawnfield;

namespace {

using Lab = Eigen::Vector3d;
constexpr double pi = std::numbers::pi;

double degrees(double radians) { return radians * 180 / pi; }
double radians(double degrees) { return degrees * pi / 180; }

/// Returns linear red, green and blue (0 .. 1) of 0xRRGGBB (IEC 61966-2-1).
Eigen::Vector3d linear(std::uint32_t colour)
{
    Eigen::Vector3d out;
    for (int k = 0; k < 3; ++k) {
        const double c = double(colour >> (16 - 8 * k) & 0xff) / 255;
        out[k] = c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
    }
    return out;
}

/// Returns CIELAB of linear sRGB, for the white point D65.
Lab lab(const Eigen::Vector3d& rgb)
{
    Eigen::Matrix3d xyz_from_rgb;
    xyz_from_rgb << 0.4124564, 0.3575761, 0.1804375, 0.2126729, 0.7151522, 0.0721750, 0.0193339, 0.1191920, 0.9503041;
    const Eigen::Vector3d xyz = (xyz_from_rgb * rgb).cwiseQuotient(Eigen::Vector3d(0.95047, 1, 1.08883));
    const Eigen::Vector3d f = xyz.unaryExpr(
        [](double t) { return t > 216.0 / 24389 ? std::cbrt(t) : (24389.0 / 27 * t + 16) / 116; });
    return {116 * f.y() - 16, 500 * (f.x() - f.y()), 200 * (f.y() - f.z())};
}

/// Returns the colour difference CIEDE2000. Source: Sharma, Wu, Dalal, The CIEDE2000 color-difference formula, 2005.
double difference(const Lab& one, const Lab& other)
{
    const auto power7 = [](double c) { return std::sqrt(std::pow(c, 7) / (std::pow(c, 7) + std::pow(25.0, 7))); };
    const double mean_chroma = (std::hypot(one[1], one[2]) + std::hypot(other[1], other[2])) / 2;
    const double stretch = 1 + 0.5 * (1 - power7(mean_chroma));
    const double a1 = stretch * one[1], a2 = stretch * other[1];
    const double c1 = std::hypot(a1, one[2]), c2 = std::hypot(a2, other[2]);
    const auto hue = [](double a, double b) {
        return a == 0 && b == 0 ? 0 : std::fmod(degrees(std::atan2(b, a)) + 360, 360);
    };
    const double h1 = hue(a1, one[2]), h2 = hue(a2, other[2]);
    double turn = h2 - h1, mean_hue = (h1 + h2) / 2;
    if (std::abs(turn) > 180) {
        turn += turn > 0 ? -360 : 360;
        mean_hue += mean_hue < 180 ? 180 : -180;
    }
    if (c1 * c2 == 0) {
        turn = 0;
        mean_hue = h1 + h2;
    }
    const double lightness = other[0] - one[0], chroma = c2 - c1,
                 dh = 2 * std::sqrt(c1 * c2) * std::sin(radians(turn / 2));
    const double l = (one[0] + other[0]) / 2, c = (c1 + c2) / 2;
    const double t = 1 - 0.17 * std::cos(radians(mean_hue - 30)) + 0.24 * std::cos(radians(2 * mean_hue)) +
                     0.32 * std::cos(radians(3 * mean_hue + 6)) - 0.2 * std::cos(radians(4 * mean_hue - 63));
    const double sl = 1 + 0.015 * std::pow(l - 50, 2) / std::sqrt(20 + std::pow(l - 50, 2)), sc = 1 + 0.045 * c,
                 sh = 1 + 0.015 * c * t;
    const double rotation = -2 * power7(c) * std::sin(radians(60 * std::exp(-std::pow((mean_hue - 275) / 25, 2))));
    return std::sqrt(std::pow(lightness / sl, 2) + std::pow(chroma / sc, 2) + std::pow(dh / sh, 2) +
                     rotation * chroma / sc * dh / sh);
}

struct Vision {
    const char* name;
    Eigen::Matrix3d seen;  ///< from linear sRGB to linear sRGB
};

/// Returns normal vision and the three kinds of colour blindness at full severity. Source: Machado, Oliveira,
/// Fernandes, A physiologically-based model for simulation of color vision deficiency, 2009.
std::vector<Vision> visions()
{
    std::vector<Vision> out(4);
    out[0] = {"normal", Eigen::Matrix3d::Identity()};
    out[1].name = "protanopia";
    out[1].seen << 0.152286, 1.052583, -0.204868, 0.114503, 0.786281, 0.099216, -0.003882, -0.048116, 1.051998;
    out[2].name = "deuteranopia";
    out[2].seen << 0.367322, 0.860646, -0.227968, 0.280085, 0.672501, 0.047413, -0.011820, 0.042940, 0.968881;
    out[3].name = "tritanopia";
    out[3].seen << 1.255528, -0.076749, -0.178779, -0.078411, 0.930809, 0.147602, 0.004733, 0.691367, 0.303900;
    return out;
}

Lab seen(std::uint32_t colour, const Vision& vision)
{
    return lab((vision.seen * linear(colour)).cwiseMax(0).cwiseMin(1));
}

std::vector<std::pair<std::string, std::uint32_t>> coloured_verdicts()
{
    std::vector<std::pair<std::string, std::uint32_t>> out;
    for (std::size_t v = 0; v < verdict_count; ++v) out.emplace_back(to_string(Verdict(v)), verdict_palette[v]);
    return out;
}

}  // namespace

TEST_CASE("the colour difference of this test is CIEDE2000")
{
    // Pairs 1, 7, 13, 17, 25 and 31 of Sharma's test data.
    CHECK(difference({50, 2.6772, -79.7751}, {50, 0, -82.7485}) == Approx(2.0425).margin(1e-4));
    CHECK(difference({50, 0, 0}, {50, -1, 2}) == Approx(2.3669).margin(1e-4));
    CHECK(difference({50, -0.001, 2.49}, {50, 0.0009, -2.49}) == Approx(4.8045).margin(1e-4));
    CHECK(difference({50, 2.5, 0}, {73, 25, -18}) == Approx(27.1492).margin(1e-4));
    CHECK(difference({60.2574, -34.0099, 36.2677}, {60.4626, -34.1751, 39.4387}) == Approx(1.2644).margin(1e-4));
    CHECK(difference({90.9257, -0.5406, -0.9208}, {88.6381, -0.8985, -0.7239}) == Approx(1.5381).margin(1e-4));
    CHECK(lab(linear(0xffffff)).isApprox(Lab(100, 0, 0), 1e-3));
    CHECK(lab(linear(0xff0000)).isApprox(Lab(53.24, 80.09, 67.20), 1e-3));
}

TEST_CASE("valid and collision differ in lightness by 25 or more, in every kind of vision")
{
    for (const Vision& vision : visions()) {
        CAPTURE(vision.name);
        const double valid = seen(verdict_palette[std::size_t(Verdict::Valid)], vision)[0];
        CHECK(std::abs(valid - seen(verdict_palette[std::size_t(Verdict::Collision)], vision)[0]) >= 25);
        CHECK(std::abs(seen(some_headings_colour, vision)[0] - valid) >= 20);
    }
}

TEST_CASE("no two of the ten verdicts are closer than 20 (CIEDE2000 and CIE76), in every kind of vision")
{
    const auto verdicts = coloured_verdicts();
    REQUIRE(verdicts.size() == 10);
    for (const Vision& vision : visions())
        for (std::size_t i = 0; i < verdicts.size(); ++i)
            for (std::size_t j = 0; j < i; ++j) {
                CAPTURE(vision.name, verdicts[i].first, verdicts[j].first);
                const Lab one = seen(verdicts[i].second, vision), other = seen(verdicts[j].second, vision);
                CHECK(difference(one, other) >= 20);
                CHECK((one - other).norm() >= 20);
            }
}

TEST_CASE("the colours of islands differ from each other and from the ground beside them, in every kind of vision")
{
    std::vector<std::uint32_t> colours(island_palette.begin(), island_palette.end());
    colours.insert(colours.end(),
                   {other_islands_colour, no_way_colour, not_valid_colour, obstacle_colour, no_pose_colour});
    for (const Vision& vision : visions())
        for (std::size_t i = 0; i < colours.size(); ++i)
            for (std::size_t j = 0; j < i; ++j) {
                CAPTURE(vision.name, i, j);
                CHECK(difference(seen(colours[i], vision), seen(colours[j], vision)) >= 11);
            }
}

TEST_CASE("the colours of kinds of robots differ from each other and from obstacles, in every kind of vision")
{
    std::vector<std::uint32_t> colours(kind_palette.begin(), kind_palette.end());
    colours.push_back(obstacle_colour);
    for (const Vision& vision : visions())
        for (std::size_t i = 0; i < colours.size(); ++i) {
            CAPTURE(vision.name, i);
            CHECK(difference(seen(colours[i], vision), seen(verdict_palette[std::size_t(Verdict::Valid)], vision)) >=
                  11);
            for (std::size_t j = 0; j < i; ++j) {
                CAPTURE(j);
                CHECK(difference(seen(colours[i], vision), seen(colours[j], vision)) >= 11);
            }
        }
}

TEST_CASE("the other colours of a heat map differ from verdicts and from each other, in every kind of vision")
{
    auto colours = coloured_verdicts();
    const std::size_t verdicts = colours.size();
    colours.insert(
        colours.end(),
        {{"some headings", some_headings_colour}, {"obstacle", obstacle_colour}, {"no pose", no_pose_colour}});
    for (const Vision& vision : visions())
        for (std::size_t i = verdicts; i < colours.size(); ++i)
            for (std::size_t j = 0; j < i; ++j) {
                CAPTURE(vision.name, colours[i].first, colours[j].first);
                CHECK(difference(seen(colours[i].second, vision), seen(colours[j].second, vision)) >= 11);
            }
}
