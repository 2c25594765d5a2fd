#include "base/deflate.h"
#include "base/parallel.h"
#include "base/text.h"
#include "base/tiff.h"
#include "column/columns.h"
#include "export/words.h"
#include "picture/gradient.h"

#include <spawnfield/error.h>
#include <spawnfield/map_export.h>
#include <spawnfield/output_file.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>

namespace spawnfield {
namespace {

constexpr float no_data = std::numeric_limits<float>::quiet_NaN();
constexpr int side = TerrainMap::tile;
constexpr std::size_t tile_cells = std::size_t(side) * side;

// ---------------------------------------------------------------- bands

struct Band {
    std::string name, unit;
};

bool is_settled(const VerdictImage& verdicts) { return !verdicts.tilt.empty(); }

/// Tilt and margin have bands of their own.
std::string unit_of(PlaceQuantity quantity)
{
    if (quantity == PlaceQuantity::Room) return "m2";
    return quantity == PlaceQuantity::View ? "" : "m";
}

std::vector<Band> bands_of(int layers, const VerdictImage* verdicts)
{
    std::vector<Band> bands{{"elevation", "m"}};
    for (int layer = 1; layer < layers; ++layer) bands.push_back({"elevation_" + std::to_string(layer), "m"});
    bands.insert(bands.end(),
                 {{"layers", ""}, {"free_height", "m"}, {"slope", "degrees"}, {"water", "m"}, {"obstacle", "m"}});
    if (verdicts == nullptr) return bands;
    bands.push_back({"verdict", ""});
    if (is_settled(*verdicts)) bands.insert(bands.end(), {{"tilt", "degrees"}, {"margin", "m"}});
    for (const VerdictImage::Measured& measured : verdicts->measured)
        bands.push_back({to_string(measured.quantity), unit_of(measured.quantity)});
    return bands;
}

/// The tiles of a frame.
struct Tiles {
    const GridFrame& frame;
    int rows, cols;

    explicit Tiles(const GridFrame& f) : frame(f), rows((f.rows + side - 1) / side), cols((f.cols + side - 1) / side) {}

    /// Calls visit(row, col, column) for the cells of a tile and of a border around it that are in the frame. row and
    /// col are relative to the tile; row 0 has the largest y.
    template <class Visit>
    void visit_cells(const Geometry& geometry, std::size_t tile, int border, const Visit& visit) const
    {
        constexpr int part = 64;  // cells; the columns of part x part cells stay in a core's cache
        const int top = int(tile) / cols * side, left = int(tile) % cols * side;
        const int row0 = std::max(0, top - border), row1 = std::min(frame.rows, top + side + border);
        const int col0 = std::max(0, left - border), col1 = std::min(frame.cols, left + side + border);
        for (int row = row0; row < row1; row += part)
            for (int col = col0; col < col1; col += part) {
                const int part_rows = std::min(part, row1 - row), part_cols = std::min(part, col1 - col);
                const Columns centres(geometry, {frame.x0, frame.y0, frame.cell, col, frame.rows - row - part_rows,
                                                 part_cols, part_rows, 0.5});
                for (int j = 0; j < part_rows; ++j)
                    for (int i = 0; i < part_cols; ++i)
                        visit(row + part_rows - 1 - j - top, col + i - left, centres.at(i, j));
            }
    }
};

ZRange ground_z(const Map& map, const GeoTiffOptions& options) { return overlap(map.z_limits, options.z); }

/// Returns the largest number of layers at a cell's centre. Layers are counted again for this frame, because finer
/// cells may have more layers than the map's own cells.
int most_layers(const Map& map, const GridFrame& frame, const GeoTiffOptions& options)
{
    const ZRange z = ground_z(map, options);
    const Tiles tiles(frame);
    std::vector<int> most(std::size_t(tiles.rows) * std::size_t(tiles.cols), 0);
    parallel_for(most.size(), options.threads, {}, [&](std::size_t t) {
        tiles.visit_cells(map.geometry, t, 0, [&](int, int, const ColumnView& column) {
            most[t] = std::max(most[t], int(heights_within(column.layers, z).size()));
        });
    });
    return *std::max_element(most.begin(), most.end());
}

/// Returns the free height above a layer, up to the next span; NaN if there is none.
float free_height(const ColumnView& column, double height)
{
    double lowest = std::numeric_limits<double>::infinity();
    for (const Span& span : column.spans)
        if (span.top > height + layer_tolerance) lowest = std::min(lowest, std::max(span.bottom, height));
    return std::isfinite(lowest) ? float(lowest - height) : no_data;
}

class TileBands {
public:
    TileBands(const Map& map, const Tiles& tiles, const VerdictImage* verdicts, const GeoTiffOptions& options,
              int layer_bands)
        : map_(map), tiles_(tiles), verdicts_(verdicts), layers_(options.layers), z_(ground_z(map, options)),
          layer_bands_(std::size_t(layer_bands))
    {
    }

    /// Returns the bands of a tile as deflated streams.
    std::vector<std::string> streams(std::size_t tile) const
    {
        constexpr int border = 1;
        HeightImage chosen(side + 2 * border, side + 2 * border, no_data);
        const std::size_t of_robot = verdicts_ == nullptr
                                         ? 0
                                         : (is_settled(*verdicts_) ? 3 : 1) + verdicts_->measured.size();
        std::vector<std::vector<float>> bands(layer_bands_ + 5 + of_robot, std::vector<float>(tile_cells, no_data));
        tiles_.visit_cells(map_.geometry, tile, border, [&](int row, int col, const ColumnView& column) {
            const bool inside = row >= 0 && row < side && col >= 0 && col < side;
            const std::span<const double> heights = heights_within(column.layers, z_);
            const int layer = chosen_layer(int(heights.size()));
            if (layer >= 0) chosen(row + border, col + border) = float(heights[std::size_t(layer)]);
            if (inside) add_cell(bands, std::size_t(row) * side + std::size_t(col), column, heights, layer);
        });
        add_slopes(bands[layer_bands_ + 2], chosen, border);
        if (verdicts_ != nullptr) add_verdicts(std::span(bands).last(of_robot), tile);
        std::vector<std::string> out;
        for (const std::vector<float>& band : bands) out.push_back(deflate_floats(band, side));
        return out;
    }

private:
    int chosen_layer(int count) const
    {
        for (int layer = 0; layer < count; ++layer)
            if (layers_.includes(layer, count)) return layer;
        return -1;
    }

    void add_cell(std::vector<std::vector<float>>& bands, std::size_t cell, const ColumnView& column,
                  std::span<const double> heights, int layer) const
    {
        for (std::size_t l = 0; l < heights.size(); ++l) bands[l][cell] = float(heights[l]);
        bands[layer_bands_][cell] = float(heights.size());
        if (layer >= 0) bands[layer_bands_ + 1][cell] = free_height(column, heights[std::size_t(layer)]);
        const std::span<const double> water = heights_within(column.water, z_);
        if (!water.empty()) bands[layer_bands_ + 3][cell] = float(water.front());
        if (const auto top = obstacle_above(column, heights, z_)) bands[layer_bands_ + 4][cell] = float(*top);
    }

    void add_slopes(std::vector<float>& band, const HeightImage& heights, int border) const
    {
        for (int row = 0; row < side; ++row)
            for (int col = 0; col < side; ++col) {
                const double rise = gradient(heights, row + border, col + border, tiles_.frame.cell).norm();
                band[std::size_t(row) * side + std::size_t(col)] = float(std::atan(rise) * 180 / std::numbers::pi);
            }
    }

    /// Fills the band of verdicts, for settled robots those of tilt and margin, and those of measured quantities.
    void add_verdicts(std::span<std::vector<float>> bands, std::size_t tile) const
    {
        constexpr double degree = std::numbers::pi / 180;
        const int top = int(tile) / tiles_.cols * side, left = int(tile) % tiles_.cols * side;
        for (int row = 0; row < std::min(side, tiles_.frame.rows - top); ++row)
            for (int col = 0; col < std::min(side, tiles_.frame.cols - left); ++col) {
                const std::uint8_t verdict = verdicts_->at(top + row, left + col);
                if (verdict == VerdictImage::no_pose) continue;
                const std::size_t cell = std::size_t(row) * side + std::size_t(col),
                                  source = std::size_t(top + row) * std::size_t(tiles_.frame.cols) +
                                           std::size_t(left + col);
                bands[0][cell] = float(verdict);
                std::size_t band = 1;
                if (is_settled(*verdicts_)) {
                    bands[band++][cell] = float(verdicts_->tilt[source] / degree);
                    bands[band++][cell] = verdicts_->margin[source];
                }
                for (const VerdictImage::Measured& measured : verdicts_->measured)
                    bands[band++][cell] = measured.values[source];
            }
    }

    const Map& map_;
    const Tiles& tiles_;
    const VerdictImage* verdicts_;
    const LayerChoice& layers_;
    const ZRange z_;  ///< layers outside this range are left out
    const std::size_t layer_bands_;
};

// ---------------------------------------------------------------- tags

constexpr std::uint32_t pixel_scale_tag = 33550, tiepoint_tag = 33922, geo_keys_tag = 34735, geo_text_tag = 34737,
                        gdal_metadata_tag = 42112, gdal_no_data_tag = 42113;

std::string layer_text(const LayerChoice& layers)
{
    return layers.kind == LayerChoice::Kind::Top      ? "top"
           : layers.kind == LayerChoice::Kind::Bottom ? "bottom"
                                                      : std::to_string(layers.index);
}

std::string metadata(const Map& map, const std::vector<Band>& bands, const LayerChoice& layers, bool has_verdicts)
{
    std::string text = "<GDALMetadata>\n";
    const auto add = [&](const std::string& name, const std::string& attributes, const std::string& value) {
        text += "  <Item name=\"" + name + "\"" + attributes + ">" + xml_escaped(value) + "</Item>\n";
    };
    add("MAP", "", map.name);
    add("MAP_HASH", "", map.hash);
    add("LAYER", "", layer_text(layers));
    if (has_verdicts) add("VERDICTS", "", verdict_numbers());
    for (std::size_t b = 0; b < bands.size(); ++b) {
        const std::string sample = " sample=\"" + std::to_string(b) + "\" role=\"";
        add("DESCRIPTION", sample + "description\"", bands[b].name);
        if (!bands[b].unit.empty()) add("UNITTYPE", sample + "unittype\"", bands[b].unit);
    }
    return text + "</GDALMetadata>\n";
}

/// Returns the code of a text like "EPSG:32611"; nothing if a GeoTIFF cannot contain the code.
std::optional<std::uint16_t> epsg_code(const std::string& crs)
{
    std::uint16_t code = 0;
    if (!crs.starts_with("EPSG:")) return std::nullopt;
    const auto [end, error] = std::from_chars(crs.data() + 5, crs.data() + crs.size(), code);
    if (error != std::errc{} || end != crs.data() + crs.size() || code < 1024 || code > 32766) return std::nullopt;
    return code;
}

/// Sets the keys of a projected coordinate system by its code. Without a code, sets those of the scene's own frame, in
/// metres, which has no place on Earth.
void set_geo_keys(TIFF* tiff, const std::optional<std::uint16_t>& code)
{
    static const std::string citation = "spawnfield scene, m, x right, y up|";
    const std::uint16_t user_defined = 32767, projected = 1, pixel_is_area = 1, metre = 9001,
                        length = std::uint16_t(citation.size());
    // Version, revision, minor revision and number of keys; then key, place, count and value of each key.
    const std::uint16_t survey[] = {1,    1, 0, 3,                  //
                                    1024, 0, 1, projected,          // GTModelType
                                    1025, 0, 1, pixel_is_area,      // GTRasterType
                                    3072, 0, 1, code.value_or(0)};  // ProjectedCSType
    const std::uint16_t local[] = {1,      1,
                                   0,      4,  //
                                   1024,   0,
                                   1,      user_defined,  // GTModelType
                                   1025,   0,
                                   1,      pixel_is_area,  // GTRasterType
                                   1026,   geo_text_tag,
                                   length, 0,  // GTCitation
                                   3076,   0,
                                   1,      metre};  // ProjLinearUnits
    if (code)
        libtiff().set_field(tiff, geo_keys_tag, int(std::size(survey)), survey);
    else
        libtiff().set_field(tiff, geo_keys_tag, int(std::size(local)), local);
    if (!code) libtiff().set_field(tiff, geo_text_tag, citation.c_str());
}

void set_geo_tags(TIFF* tiff, const GridFrame& frame, const std::optional<GeoOrigin>& survey)
{
    const GeoOrigin origin = survey.value_or(GeoOrigin{});
    const double scale[] = {frame.cell / origin.unit, frame.cell / origin.unit, 0};
    const double top = frame.y0 + frame.rows * frame.cell;
    const double tiepoint[] = {0, 0, 0, origin.x + frame.x0 / origin.unit, origin.y + top / origin.unit,
                               0};  // the upper left corner
    libtiff().set_field(tiff, pixel_scale_tag, int(std::size(scale)), scale);
    libtiff().set_field(tiff, tiepoint_tag, int(std::size(tiepoint)), tiepoint);
    set_geo_keys(tiff, epsg_code(origin.crs));
    libtiff().set_field(tiff, gdal_no_data_tag, "nan");
}

/// Returns the map's origin if the file gets the coordinates of the survey; nothing if it gets the map's own.
std::optional<GeoOrigin> survey_of(const Map& map, const GeoTiffOptions& options)
{
    return options.survey && map.origin && epsg_code(map.origin->crs) ? map.origin : std::nullopt;
}

void set_tags(TIFF* tiff, const GridFrame& frame, std::size_t bands)
{
    libtiff().set_field(tiff, TIFFTAG_IMAGEWIDTH, frame.cols);
    libtiff().set_field(tiff, TIFFTAG_IMAGELENGTH, frame.rows);
    libtiff().set_field(tiff, TIFFTAG_TILEWIDTH, side);
    libtiff().set_field(tiff, TIFFTAG_TILELENGTH, side);
    libtiff().set_field(tiff, TIFFTAG_BITSPERSAMPLE, 32);
    libtiff().set_field(tiff, TIFFTAG_SAMPLESPERPIXEL, int(bands));
    libtiff().set_field(tiff, TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_IEEEFP);
    libtiff().set_field(tiff, TIFFTAG_COMPRESSION, COMPRESSION_ADOBE_DEFLATE);
    libtiff().set_field(tiff, TIFFTAG_PREDICTOR, PREDICTOR_FLOATINGPOINT);
    libtiff().set_field(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
    libtiff().set_field(tiff, TIFFTAG_PLANARCONFIG, PLANARCONFIG_SEPARATE);
    const std::vector<std::uint16_t> kinds(bands - 1, EXTRASAMPLE_UNSPECIFIED);
    libtiff().set_field(tiff, TIFFTAG_EXTRASAMPLES, int(kinds.size()), kinds.data());
}

/// Writes the tiles, row after row. Returns false if one cannot be written.
bool write_tiles(TIFF* tiff, const TileBands& source, const Tiles& tiles, std::size_t bands,
                 const GeoTiffOptions& options)
{
    const std::size_t count = std::size_t(tiles.rows) * std::size_t(tiles.cols);
    for (int row = 0; row < tiles.rows; ++row) {
        std::vector<std::vector<std::string>> streams(std::size_t(tiles.cols));
        Progress progress;
        if (options.progress) progress = [&](double share) { options.progress((row + share) / tiles.rows); };
        const std::size_t first = std::size_t(row) * streams.size();
        parallel_for(streams.size(), options.threads, progress,
                     [&](std::size_t col) { streams[col] = source.streams(first + col); });
        for (std::size_t band = 0; band < bands; ++band)
            for (std::size_t col = 0; col < streams.size(); ++col) {
                std::string& bytes = streams[col][band];
                const auto number = std::uint32_t(band * count + first + col);
                if (libtiff().write_raw_tile(tiff, number, bytes.data(), tmsize_t(bytes.size())) !=
                    tmsize_t(bytes.size()))
                    return false;
            }
    }
    return true;
}

}  // namespace

void write_geotiff(const Map& map, const GridFrame& frame, const VerdictImage* verdicts, const GeoTiffOptions& options,
                   const std::filesystem::path& file)
{
    if (options.layers.kind == LayerChoice::Kind::All)
        throw ArgumentError("write_geotiff",
                            "layers is all, needs top, bottom or a number, because a cell has one free height");
    if (verdicts != nullptr && (verdicts->frame.rows != frame.rows || verdicts->frame.cols != frame.cols))
        throw ArgumentError("write_geotiff",
                            "verdicts have another frame than the file, need the same rows and columns");
    const int layers = std::max(1, most_layers(map, frame, options));
    const std::vector<Band> bands = bands_of(layers, verdicts);
    const Tiles tiles(frame);
    const double most_bytes = double(tiles.rows) * tiles.cols * double(bands.size()) *
                              (sizeof(float) * tile_cells + 1000);
    OutputFile out(file);
    Tiff tiff = open_tiff(out.path(), most_bytes < 4e9 ? "w" : "w8");
    const auto failed = [&] {
        return OutputError(file.string(), "cannot be written; is there enough space, and is it a file?");
    };
    if (!tiff) throw failed();
    set_tags(tiff.get(), frame, bands.size());
    set_geo_tags(tiff.get(), frame, survey_of(map, options));
    libtiff().set_field(tiff.get(), gdal_metadata_tag,
                        metadata(map, bands, options.layers, verdicts != nullptr).c_str());
    if (!write_tiles(tiff.get(), TileBands(map, tiles, verdicts, options, layers), tiles, bands.size(), options) ||
        libtiff().flush(tiff.get()) != 1)
        throw failed();
    tiff.reset();
    out.commit();
}

}  // namespace spawnfield
