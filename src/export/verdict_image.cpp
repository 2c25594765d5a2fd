#include <spawnfield/error.h>
#include <spawnfield/map_export.h>
#include <spawnfield/raster_quantities.h>

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

/// Returns the cell of each pose of a strip whose lowest row is `last`.
std::vector<std::size_t> cells_of(const RasterResult& strip, const GridFrame& frame, int last)
{
    std::vector<std::size_t> out;
    for (const RasterPose& pose : strip.poses) {
        const int col = int(std::round((pose.x - strip.grid.x0) / strip.grid.step));
        const int row = last - int(std::round((pose.y - strip.grid.y0) / strip.grid.step));
        out.push_back(std::size_t(row) * std::size_t(frame.cols) + std::size_t(col));
    }
    return out;
}

void add_strip(VerdictImage& image, const std::vector<std::size_t>& cells, const RasterResult& strip)
{
    for (std::size_t p = 0; p < cells.size(); ++p) {
        image.verdicts[cells[p]] = std::uint8_t(strip.poses[p].verdict);
        if (image.tilt.empty()) continue;
        image.tilt[cells[p]] = float(strip.rests[p].tilt);
        image.margin[cells[p]] = float(strip.rests[p].margin);
    }
    image.counts += strip.counts;
    image.exact_checks += strip.exact_checks;
}

void measure_strip(VerdictImage& image, const std::vector<std::size_t>& cells, const RasterResult& strip,
                   const Judge& judge, const PlaceMeasures& measures, int threads)
{
    for (VerdictImage::Measured& measured : image.measured) {
        const std::vector<double> values = raster_quantity(judge, strip, measured.quantity, measures,
                                                           {.threads = threads});
        for (std::size_t p = 0; p < cells.size(); ++p) measured.values[cells[p]] = float(values[p]);
    }
}

}  // namespace

VerdictImage verdict_image(const Judge& judge, const GridFrame& frame, const RasterOptions& options,
                           const PlaceMeasures& measures)
{
    if (options.layers.kind == LayerChoice::Kind::All)
        throw ArgumentError("verdict_image",
                            "layers is all, needs top, bottom or a number, because a cell has one verdict");
    VerdictImage image{frame, {}, {}};
    image.verdicts.assign(std::size_t(frame.rows) * std::size_t(frame.cols), VerdictImage::no_pose);
    constexpr float unknown = std::numeric_limits<float>::quiet_NaN();
    if (options.stance == Stance::Settled) {
        image.tilt.assign(image.verdicts.size(), unknown);
        image.margin = image.tilt;
    }
    for (const PlaceQuantity quantity : measures.columns)
        image.measured.push_back({quantity, std::vector<float>(image.verdicts.size(), unknown)});
    for (int first = 0; first < frame.rows; first += strip_rows) {
        const int last = std::min(first + strip_rows, frame.rows) - 1;
        const RasterResult strip = raster(judge, strip_options(frame, first, last, options));
        const std::vector<std::size_t> cells = cells_of(strip, frame, last);
        add_strip(image, cells, strip);
        measure_strip(image, cells, strip, judge, measures, options.threads);
    }
    return image;
}

}  // namespace spawnfield
