#include "base/geotiff.h"

#include "base/coordinate_system.h"
#include "base/geo_tags.h"
#include "base/number.h"
#include "base/tiff.h"

#include <spawnfield/error.h>

#include <algorithm>
#include <cmath>

namespace spawnfield {
namespace {

enum GeoKey : std::uint16_t {
    model_type = 1024,
    raster_type = 1025,
    citation = 1026,
    geodetic_crs = 2048,
    projected_crs = 3072,
    projected_citation = 3073,
    linear_units = 3076,
    linear_unit_size = 3077,
    vertical_crs = 4096,
    vertical_units = 4099,
};

constexpr unsigned user_defined = 32767;

template <class T>
std::vector<T> array_of(TIFF* tiff, std::uint32_t tag)
{
    std::uint32_t count = 0;
    const T* values = nullptr;
    if (libtiff().get_field(tiff, tag, &count, &values) != 1 || values == nullptr) return {};
    return {values, values + count};
}

std::string text_of(TIFF* tiff, std::uint32_t tag)
{
    const char* text = nullptr;
    return libtiff().get_field(tiff, tag, &text) == 1 && text != nullptr ? text : "";
}

bool second_page_is_mask(TIFF* tiff)
{
    std::uint32_t kind = 0;
    return libtiff().read_directory(tiff) == 1 &&
           libtiff().get_field_defaulted(tiff, TIFFTAG_SUBFILETYPE, &kind) == 1 && (kind & FILETYPE_MASK) != 0;
}

/// The GeoKeyDirectory. It starts with four numbers; the fourth is the number of keys. Then come four numbers for each
/// key: its id, the tag that contains the value (0: the fourth number is the value), a count, and the offset of the
/// value in that tag.
class GeoKeys {
public:
    GeoKeys(const GeoTags& tags, const std::string& file) : tags_(tags), file_(file)
    {
        if (tags.keys.empty()) return;
        if (tags.keys.size() < 4 || tags.keys.size() < 4 + 4 * std::size_t(tags.keys[3]))
            throw FileError(file, "has an incomplete GeoKeyDirectory; is it cut short?");
    }

    std::optional<unsigned> number(GeoKey key) const
    {
        const std::uint16_t* const entry = find(key);
        if (entry == nullptr || entry[1] != 0) return std::nullopt;
        return entry[3];
    }

    std::optional<double> real(GeoKey key) const
    {
        const std::uint16_t* const entry = find(key);
        if (entry == nullptr || entry[1] != geo_double_params) return std::nullopt;
        if (entry[3] >= tags_.doubles.size())
            throw FileError(file_, "has a GeoKey " + std::to_string(key) + " without its value");
        return tags_.doubles[entry[3]];
    }

    std::string text(GeoKey key) const
    {
        const std::uint16_t* const entry = find(key);
        if (entry == nullptr || entry[1] != geo_ascii_params || entry[3] >= tags_.ascii.size()) return "";
        const std::string text = tags_.ascii.substr(entry[3], entry[2]);
        return text.substr(0, text.find('|'));
    }

private:
    const std::uint16_t* find(GeoKey key) const
    {
        for (std::size_t i = 4; !tags_.keys.empty() && i < 4 + 4 * std::size_t(tags_.keys[3]); i += 4)
            if (tags_.keys[i] == key) return &tags_.keys[i];
        return nullptr;
    }

    const GeoTags& tags_;
    const std::string& file_;
};

/// Returns "EPSG:32611", or "" if the key is missing or the coordinate system is user-defined.
std::string epsg_code(const GeoKeys& keys, GeoKey key)
{
    const unsigned code = keys.number(key).value_or(0);
    return code == 0 || code == user_defined ? "" : "EPSG:" + std::to_string(code);
}

std::optional<double> metres_of(unsigned unit)
{
    switch (unit) {
    case 9001: return 1;
    case 9002: return 0.3048;
    case 9003: return 1200.0 / 3937;  // US survey foot
    case 9036: return 1000;
    default: return std::nullopt;
    }
}

/// Maps pixel (col, row) to survey coordinates.
struct Affine {
    double x, dx, y, dy;  ///< pixel (col, row) is at x + col dx, y - row dy
};

Affine affine(const GeoTags& tags, const std::string& file)
{
    const std::vector<double>& m = tags.transformation;
    if (m.size() >= 16) {
        if (m[1] != 0 || m[4] != 0)
            throw FileError(file,
                            "is rotated against its coordinates (ModelTransformation), needs rows from west to east; "
                            "gdalwarp turns it");
        return {m[3], m[0], m[7], -m[5]};
    }
    const std::vector<double>&scale = tags.pixel_scale, &tie = tags.tiepoints;
    if (scale.size() < 2 || tie.size() < 6)
        throw FileError(
            file,
            "has " + std::to_string(tie.size() / 6) + " tie points and " + (scale.size() < 2 ? "no" : "a") +
                " pixel scale (ModelPixelScale), needs one of each, or a ModelTransformation; gdalwarp writes them");
    return {tie[3] - tie[0] * scale[0], scale[0], tie[4] + tie[1] * scale[1], scale[1]};
}

void check(const Affine& a, const std::string& file)
{
    if (!std::isfinite(a.x) || !std::isfinite(a.y) || !std::isfinite(a.dx) || !std::isfinite(a.dy))
        throw FileError(file, "has a position or pixel scale that is not finite");
    if (!(a.dx > 0) || !(a.dy > 0))
        throw FileError(file, "has a pixel scale of " + number(a.dx) + ", " + number(a.dy) +
                                  ", needs > 0: rows from west to east, the northern one first; gdalwarp turns it");
}

void refuse_degrees(const GeoKeys& keys, const std::string& file)
{
    const unsigned type = keys.number(model_type).value_or(1);
    if (type != 2 && type != 3) return;
    refuse_unprojected(file, type == 3, epsg_code(keys, geodetic_crs));
}

/// Returns metres per unit for a file without ProjLinearUnitsGeoKey.
double unit_by_system(const GeoKeys& keys, const std::string& file, std::vector<std::string>& notices)
{
    using Kind = CoordinateSystem::Kind;
    const std::string code = epsg_code(keys, projected_crs);
    if (code.empty()) {
        notices.push_back(file + ": does not state the unit of x and y; they are taken as metres");
        return 1;
    }
    const std::optional<CoordinateSystem> found = coordinate_system(code);
    if (found && (found->kind == Kind::Geographic || found->kind == Kind::Geocentric))
        refuse_unprojected(file, found->kind == Kind::Geocentric, code);
    if (!found || found->kind != Kind::Projected)
        throw FileError(file, "is in " + code +
                                  ", which PROJ does not know as a projection, so its unit is unknown; give it another "
                                  "with gdal_edit.py -a_srs, or give the spacing in metres with the key cell");
    return found->unit;
}

double linear_unit(const GeoKeys& keys, const std::string& file, std::vector<std::string>& notices)
{
    const auto code = keys.number(linear_units);
    const std::optional<double> size = !code                   ? unit_by_system(keys, file, notices)
                                       : *code == user_defined ? keys.real(linear_unit_size)
                                                               : metres_of(*code);
    if (!size || !std::isfinite(*size) || !(*size > 0))
        throw FileError(file, "has x and y in the unit " + std::to_string(*code) +
                                  " (ProjLinearUnitsGeoKey), needs metres (9001), kilometres (9036) or feet (9002, "
                                  "9003); reproject it with gdalwarp -t_srs");
    add_unit_notice(file, "x and y", *size, notices);
    return *size;
}

std::string crs_of(const GeoKeys& keys)
{
    if (const std::string code = epsg_code(keys, projected_crs); !code.empty()) return code;
    std::string name = keys.text(projected_citation);
    if (name.empty()) name = keys.text(citation);
    std::erase_if(name, [](unsigned char c) { return c < ' ' || c > '~'; });
    return name;
}

/// Returns the text of the <Item> with this role in GDAL's metadata, or "" if there is none.
std::string metadata_item(const std::string& metadata, const std::string& role)
{
    const std::size_t item = metadata.find("role=\"" + role + "\"");
    const std::size_t start = item == std::string::npos ? item : metadata.find('>', item);
    if (start == std::string::npos) return "";
    return metadata.substr(start + 1, metadata.find('<', start) - start - 1);
}

void refuse_scaled(const GeoTags& tags, const std::string& file)
{
    for (const auto& [role, none] : {std::pair{"scale", 1.0}, std::pair{"offset", 0.0}}) {
        const std::string text = metadata_item(tags.metadata, role);
        double value = none;
        if (text.empty() || (parse_number(text, value) && value == none)) continue;
        throw FileError(
            file, std::string("has heights with a ") + role + " of " + text +
                      ", needs heights without scale and offset; gdal_translate -unscale -ot Float32 applies them");
    }
}

/// A unit of heights that an entry of the file states.
struct StatedUnit {
    std::string place;             ///< the entry, for messages
    std::optional<double> metres;  ///< per unit, < 0 for depths; empty: the unit is unknown
};

StatedUnit unit_of_band(const std::string& type)
{
    StatedUnit stated{"\"" + type + "\"", {}};
    if (type == "m" || type == "metre" || type == "meter" || type == "metres" || type == "meters" || type == "Meter")
        stated.metres = 1;
    if (type == "ft" || type == "foot" || type == "feet" || type == "Foot") stated.metres = metres_of(9002);
    if (type == "sft" || type == "us-ft" || type == "US survey foot") stated.metres = metres_of(9003);
    return stated;
}

StatedUnit unit_of_system(const std::string& code)
{
    const std::optional<CoordinateSystem> found = coordinate_system(code);
    return {code + " (VerticalGeoKey)", found ? found->height_unit : std::nullopt};
}

/// Returns all units that the file states, in the order of precedence of GDAL 3.6. A coordinate system that PROJ does
/// not know comes last.
std::vector<StatedUnit> height_units(const GeoTags& tags, const std::string& file)
{
    const GeoKeys keys(tags, file);
    std::vector<StatedUnit> units;
    if (const std::string type = metadata_item(tags.metadata, "unittype"); !type.empty())
        units.push_back(unit_of_band(type));
    const std::string system = epsg_code(keys, vertical_crs);
    const StatedUnit by_system = system.empty() ? StatedUnit{} : unit_of_system(system);
    if (by_system.metres) units.push_back(by_system);
    if (const auto code = keys.number(vertical_units))
        units.push_back({std::to_string(*code) + " (VerticalUnitsGeoKey)", metres_of(*code)});
    if (!system.empty() && !by_system.metres) units.push_back(by_system);
    return units;
}

/// Adds a notice for each stated unit that differs from the first one, which is used.
void add_other_unit_notices(const std::vector<StatedUnit>& units, const std::string& file,
                            std::vector<std::string>& notices)
{
    constexpr double feet_apart = 1e-5;  // relative; US survey feet and feet differ by 2e-6 and are often confused
    const double unit = std::abs(*units[0].metres);
    for (const StatedUnit& stated : units)
        if (stated.metres && std::abs(std::abs(*stated.metres) - unit) > feet_apart * unit)
            notices.push_back(file + ": heights are in units of " + number(unit) + " m by " + units[0].place +
                              ", but of " + number(std::abs(*stated.metres)) + " m by " + stated.place +
                              "; the first is used");
}

}  // namespace

GeoTags read_geo_tags(const std::filesystem::path& file)
{
    const Tiff tiff = open_tiff(file, "r");
    if (!tiff) throw FileError(file.string(), "is cut short or a damaged TIFF image");
    GeoTags tags;
    tags.pixel_scale = array_of<double>(tiff.get(), model_pixel_scale);
    tags.tiepoints = array_of<double>(tiff.get(), model_tiepoint);
    tags.transformation = array_of<double>(tiff.get(), model_transformation);
    tags.doubles = array_of<double>(tiff.get(), geo_double_params);
    tags.keys = array_of<std::uint16_t>(tiff.get(), geo_key_directory);
    tags.ascii = text_of(tiff.get(), geo_ascii_params);
    tags.metadata = text_of(tiff.get(), gdal_metadata);
    tags.no_data = text_of(tiff.get(), gdal_no_data);
    tags.has_mask = second_page_is_mask(tiff.get());
    return tags;
}

bool is_georeferenced(const GeoTags& tags)
{
    return !tags.pixel_scale.empty() || !tags.tiepoints.empty() || !tags.transformation.empty();
}

GeoFrame geo_frame(const GeoTags& tags, const std::string& file, std::vector<std::string>& notices)
{
    const GeoKeys keys(tags, file);
    refuse_degrees(keys, file);
    const Affine a = affine(tags, file);
    check(a, file);
    const unsigned type = keys.number(raster_type).value_or(1);
    if (type != 1 && type != 2 && type != user_defined)
        throw FileError(
            file, "has GTRasterTypeGeoKey " + std::to_string(type) + ", needs 1 (pixels are areas) or 2 (points)");
    const double half = type == 2 ? 0 : 0.5;
    return {a.x + half * a.dx,
            a.y - half * a.dy,
            a.dx,
            a.dy,
            linear_unit(keys, file, notices),
            keys.number(model_type) == 1u,
            crs_of(keys)};
}

std::optional<double> no_data_value(const GeoTags& tags, const std::string& file)
{
    const std::size_t start = tags.no_data.find_first_not_of(' ');
    if (start == std::string::npos) return std::nullopt;
    double value = 0;
    if (!parse_number(std::string_view(tags.no_data).substr(start, tags.no_data.find_last_not_of(' ') + 1 - start),
                      value))
        throw FileError(file, "has a GDAL_NODATA of \"" + tags.no_data + "\", needs a number");
    return value;
}

double height_unit(const GeoTags& tags, const std::string& file, std::vector<std::string>& notices)
{
    refuse_scaled(tags, file);
    const std::vector<StatedUnit> units = height_units(tags, file);
    if (units.empty()) return 1;
    if (!units[0].metres)
        throw FileError(file, "has heights in the unit " + units[0].place +
                                  ", needs metres (9001), kilometres (9036) or feet (9002, 9003); set the unit with "
                                  "gdal_edit.py -units m or ft");
    add_other_unit_notices(units, file, notices);
    const auto depths = std::find_if(units.begin(), units.end(),
                                     [](const StatedUnit& stated) { return stated.metres.value_or(1) < 0; });
    const bool is_depth = depths != units.end();
    const double unit = std::abs(*units[0].metres) * (is_depth ? -1 : 1);
    add_height_unit_notice(file, unit, is_depth ? depths->place : units[0].place, notices);
    return unit;
}

}  // namespace spawnfield
