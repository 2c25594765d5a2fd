#include "scene/height_file.h"

#include "base/coordinate_system.h"
#include "base/geotiff.h"
#include "base/input_file.h"
#include "base/input_watch.h"
#include "base/number.h"
#include "base/png.h"
#include "base/tiff.h"
#include "scene/ascii_grid.h"

#include <spawnfield/error.h>
#include <spawnfield/input_file.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

namespace spawnfield {
namespace {

/// Refuses a file that is most likely in degrees. It does not state its coordinate system, its cells are smaller than a
/// hundredth, and its coordinates are in the range of longitude and latitude.
void refuse_likely_degrees(const HeightFile& found, const std::string& file)
{
    const GeoFrame& frame = *found.frame;
    const double west = frame.x, east = frame.x + (found.image.cols - 1) * frame.dx;
    const double north = frame.y, south = frame.y - (found.image.rows - 1) * frame.dy;
    if (!(std::max(frame.dx, frame.dy) < 0.01 && west >= -360 && east <= 360 && south >= -90 && north <= 90)) return;
    const int zone = int(std::floor((west + east) / 2 / 6)) + 31;
    const std::string code = zone >= 1 && zone <= 60 ? std::to_string((south + north < 0 ? 32700 : 32600) + zone)
                                                     : "CODE";
    throw FileError(file, "has cells of " + number(frame.dx) + " at x " + number(frame.x) + ", y " + number(frame.y) +
                              ", which look like degrees, needs metres; reproject it (gdalwarp -t_srs EPSG:" + code +
                              " IN OUT.tif), or give the spacing in metres with the key cell");
}

/// Inverts the pixels, so that white is high, as a viewer shows the image.
void invert(HeightFile& found)
{
    found.is_inverted = true;
    for (double& pixel : found.image.pixels) pixel = found.image.largest - pixel;
}

HeightFile read_geotiff(const std::filesystem::path& file, bool wants_frame, std::vector<std::string>& notices)
{
    const ForeignReading reading("TIFF reader", file);
    HeightFile out;
    out.image = read_grey_tiff(file, max_heights);
    const GeoTags tags = read_geo_tags(file);
    out.no_data = no_data_value(tags, file.string());
    out.height_unit = height_unit(tags, file.string(), notices);
    if (out.image.zero_is_white && !is_georeferenced(tags)) invert(out);
    if (tags.has_mask)
        notices.push_back(
            file.string() +
            ": has a mask, which is ignored; convert it to a no-data value with gdal_translate -a_nodata");
    if (!wants_frame || !is_georeferenced(tags)) return out;
    out.frame = geo_frame(tags, file.string(), notices);
    if (!out.frame->is_projected) refuse_likely_degrees(out, file.string());
    return out;
}

/// Returns the coordinate system in a .prj file beside the file; empty if there is none, or PROJ does not know it.
std::optional<CoordinateSystem> system_beside(const std::filesystem::path& file, std::vector<std::string>& notices)
{
    constexpr std::uintmax_t most = 65536;  // bytes; a .prj has one or two thousand
    for (const char* extension : {".prj", ".PRJ"}) {
        const std::filesystem::path prj = std::filesystem::path(file).replace_extension(extension);
        if (is_missing(prj) || is_folder(prj)) continue;
        require_file(prj);
        std::optional<CoordinateSystem> found;
        if (std::filesystem::file_size(prj) <= most) found = coordinate_system(read_file(prj));
        if (!found)
            notices.push_back(
                prj.string() +
                ": is not a coordinate system (WKT) that PROJ can read; x, y and heights are taken as metres");
        return found;
    }
    return std::nullopt;
}

void use_system(HeightFile& found, const CoordinateSystem& system, bool wants_frame, const std::string& file,
                std::vector<std::string>& notices)
{
    using Kind = CoordinateSystem::Kind;
    if (system.height_unit) {
        found.height_unit = *system.height_unit;
        add_height_unit_notice(file, found.height_unit, system.name, notices);
    }
    if (!wants_frame) return;
    if (system.kind == Kind::Geographic || system.kind == Kind::Geocentric)
        refuse_unprojected(file, system.kind == Kind::Geocentric, system.name);
    found.frame->is_projected = system.kind == Kind::Projected;
    found.frame->unit = system.unit;
    found.frame->crs = system.name;
    add_unit_notice(file, "x and y", system.unit, notices);
}

HeightFile read_ascii_grid(const std::filesystem::path& file, bool wants_frame, std::vector<std::string>& notices)
{
    AsciiGrid grid = parse_ascii_grid(read_file(file), file.string(), max_heights);
    HeightFile out;
    out.image = std::move(grid.image);
    out.no_data = grid.no_data;
    out.frame = grid.frame;
    if (const auto system = system_beside(file, notices)) use_system(out, *system, wants_frame, file.string(), notices);
    if (wants_frame && !out.frame->is_projected) refuse_likely_degrees(out, file.string());
    if (!wants_frame) out.frame.reset();
    return out;
}

static_assert(std::endian::native == std::endian::little, "raw heights are little-endian");

template <class Pixel>
std::vector<double> pixels_of(const std::string& bytes)
{
    std::vector<double> out(bytes.size() / sizeof(Pixel));
    for (std::size_t i = 0; i < out.size(); ++i) {
        Pixel pixel;
        std::memcpy(&pixel, bytes.data() + i * sizeof pixel, sizeof pixel);
        out[i] = double(pixel);
    }
    return out;
}

std::size_t bytes_of(RawLayout::Type type)
{
    constexpr std::array<std::size_t, 5> bytes{1, 2, 2, 4, 8};
    return bytes[std::size_t(type)];
}

HeightFile read_raw(const std::filesystem::path& file, const RawLayout& raw)
{
    const std::uint64_t pixels = std::uint64_t(raw.rows) * std::uint64_t(raw.cols),
                        wanted = pixels * bytes_of(raw.type);
    const std::string shape = std::to_string(raw.cols) + " x " + std::to_string(raw.rows);
    if (pixels > max_heights)
        throw FileError(file.string(), "has " + shape + " pixels, needs at most " + std::to_string(max_heights));
    if (const std::uint64_t size = std::filesystem::file_size(file); size != wanted)
        throw FileError(file.string(), "has " + std::to_string(size) + " bytes, needs " + std::to_string(wanted) +
                                           " (" + shape + " pixels of " + std::to_string(bytes_of(raw.type)) +
                                           " bytes)");
    const std::string bytes = read_file(file);
    HeightFile out;
    out.image = {raw.rows, raw.cols, 0, {}};
    switch (raw.type) {
    case RawLayout::Type::Uint8:
        out.image.largest = 255;
        out.image.pixels = pixels_of<std::uint8_t>(bytes);
        break;
    case RawLayout::Type::Uint16:
        out.image.largest = 65535;
        out.image.pixels = pixels_of<std::uint16_t>(bytes);
        break;
    case RawLayout::Type::Int16: out.image.pixels = pixels_of<std::int16_t>(bytes); break;
    case RawLayout::Type::Float32:
        out.image.is_float32 = true;
        out.image.pixels = pixels_of<float>(bytes);
        break;
    case RawLayout::Type::Float64: out.image.pixels = pixels_of<double>(bytes); break;
    }
    return out;
}

}  // namespace

HeightFile read_height_file(const std::filesystem::path& file, const std::optional<RawLayout>& raw, bool wants_frame,
                            std::vector<std::string>& notices)
{
    require_file(file);
    if (raw) return read_raw(file, *raw);
    const std::string start = read_start(file, 64);
    if (is_tiff(start)) return read_geotiff(file, wants_frame, notices);
    if (is_ascii_grid(start)) return read_ascii_grid(file, wants_frame, notices);
    if (is_png(start)) return {read_grey_png(file, max_heights), {}, {}, 1};
    if (file.extension() == ".asc")
        parse_ascii_grid(start, file.string(), max_heights);  // throws what is wrong with its header
    throw FileError(
        file.string(),
        "is not PNG, TIFF or an ESRI ASCII grid; convert it to one of them, or give its layout with the key raw");
}

}  // namespace spawnfield
