#include "picture_args.h"

#include "numbers.h"
#include "streams.h"

#include <cmath>
#include <filesystem>
#include <numbers>

namespace spawnfield::cli {
namespace {

PictureFormat format_named(const std::string& name)
{
    for (const PictureFormat format : {PictureFormat::Svg, PictureFormat::Pdf})
        if (name == to_string(format)) return format;
    return PictureFormat::Png;
}

/// Returns at most four significant digits.
std::string short_number(double value)
{
    char text[32];
    std::snprintf(text, sizeof text, "%.4g", value + 0.0);
    return text;
}

std::string layer_words(const std::string& layers)
{
    if (layers == "all") return "all layers (valid if one is)";
    if (layers == "top" || layers == "bottom") return layers + " layer";
    return "layer " + layers + " from the top";
}

}  // namespace

PictureFile picture_file(const std::string& file, const std::string& format)
{
    const std::string path = output_name(file);
    const PictureFormat by_ending = picture_format(path);
    const PictureFormat chosen = format.empty() ? by_ending : format_named(format);
    if (std::filesystem::path(path).has_extension() && chosen != by_ending)
        throw ArgumentError("--format is " + format + ", but " + path + " ends in ." + to_string(by_ending) +
                            "; make them agree, or leave --format out");
    return {path, chosen};
}

std::string heatmap_caption(const RasterOptions& options, const GroundArgs& ground, const Judge& judge,
                            const std::string& yaw)
{
    std::string text;
    const auto degrees = [](double angle) { return short_number(angle * 180 / std::numbers::pi) + " deg"; };
    const bool is_settled = options.stance == Stance::Settled;
    if (is_settled)
        text = "settled, ";
    else if (options.offset)
        text = "offset " + short_number(*options.offset) + " m, ";
    if (options.heading)
        text += "yaw " + to_string(*options.heading);
    else
        text += yaw.empty() ? "yaw " + degrees(options.yaw) : yaw;
    if (const std::string words = height_words(ground, options.z, judge.map()); options.dims == 2 && !words.empty())
        text += ", " + words;
    if (options.height_check) text += ", " + layer_words(ground.layers);
    if (const StandLimits& limits = judge.options().stand; is_settled)
        text += ", tilt up to " + degrees(limits.max_slope) + ", margin from " + short_number(*limits.min_stability) +
                " m, friction " + short_number(limits.friction);
    else if (const double limit = judge.options().max_slope; std::isfinite(limit))
        text += ", slope up to " + degrees(limit);
    return text;
}

}  // namespace spawnfield::cli
