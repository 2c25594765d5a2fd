#include <spawnfield/error.h>
#include <spawnfield/map_export.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace spawnfield {
namespace {

constexpr int strip_rows = 256;

/// Returns the options of a raster at the centres of the cells in rows first .. last of a frame. Rows count from the
/// top.
RasterOptions strip_options(const GridFrame& frame, int first, int last, const RasterOptions& options)
{
    RasterOptions out = options;
    out.dims = 2;
    out.step = frame.cell;
    const double beyond = frame.cell / 4;  // so that rounding excludes no centre
    out.bounds = {Vec3(frame.x_of(0), frame.y_of(last), 0),
                  Vec3(frame.x_of(frame.cols - 1) + beyond, frame.y_of(first) + beyond, 0)};
    if (options.progress)
        out.progress = [=, &frame](double share) {
            options.progress((first + share * (last - first + 1)) / frame.rows);
        };
    return out;
}

void add_strip(VerdictImage& image, int last, const RasterResult& strip)
{
    for (std::size_t p = 0; p < strip.poses.size(); ++p) {
        const RasterPose& pose = strip.poses[p];
        const int col = int(std::round((pose.x - strip.grid.x0) / strip.grid.step));
        const int row = last - int(std::round((pose.y - strip.grid.y0) / strip.grid.step));
        const std::size_t cell = std::size_t(row) * std::size_t(image.frame.cols) + std::size_t(col);
        image.verdicts[cell] = std::uint8_t(pose.verdict);
        if (image.tilt.empty()) continue;
        image.tilt[cell] = float(strip.rests[p].tilt);
        image.margin[cell] = float(strip.rests[p].margin);
    }
    image.counts += strip.counts;
    image.exact_checks += strip.exact_checks;
}

}  // namespace

VerdictImage verdict_image(const Judge& judge, const GridFrame& frame, const RasterOptions& options)
{
    if (options.layers.kind == LayerChoice::Kind::All)
        throw ArgumentError("verdict_image",
                            "layers is all, needs top, bottom or a number, because a cell has one verdict");
    VerdictImage image{frame, {}, {}};
    image.verdicts.assign(std::size_t(frame.rows) * std::size_t(frame.cols), VerdictImage::no_pose);
    if (options.stance == Stance::Settled) {
        image.tilt.assign(image.verdicts.size(), std::numeric_limits<float>::quiet_NaN());
        image.margin = image.tilt;
    }
    for (int first = 0; first < frame.rows; first += strip_rows) {
        const int last = std::min(first + strip_rows, frame.rows) - 1;
        add_strip(image, last, raster(judge, strip_options(frame, first, last, options)));
    }
    return image;
}

}  // namespace spawnfield
