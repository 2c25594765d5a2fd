#include "scene/heightmap.h"

#include "base/number.h"
#include "scene/pieces.h"

#include <spawnfield/error.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace spawnfield {

RawLayout read_raw_layout(const YamlMap& map)
{
    map.only({"type", "rows", "cols"});
    RawLayout raw;
    const std::array names{"uint8", "uint16", "int16", "float32", "float64"};
    const std::string type = map.one_of("type", {"uint8", "uint16", "int16", "float32", "float64"}, "");
    raw.type = RawLayout::Type(std::find(names.begin(), names.end(), type) - names.begin());
    const auto count = [&](const char* key) {
        const double value = map.positive(key);
        if (value != std::floor(value) || value > double(max_heights))
            map.fail(key, "is " + number(value) + ", needs a whole number up to " + std::to_string(max_heights));
        return int(value);
    };
    raw.rows = count("rows");
    raw.cols = count("cols");
    return raw;
}

/// How a key is given: "heightmap.z", or for a file by itself "--heightmap 'z: [LOW, HIGH]'".
std::string key(const HeightmapOptions& options, const std::string& name, const std::string& value)
{
    return options.place.starts_with("--") ? options.place + "'" + name + ": " + value + "'" : options.place + name;
}

bool tells_spacing(const HeightmapOptions& options) { return options.size || options.cell; }

/// What neither the file nor the options say.
void check_complete(const HeightFile& found, const HeightmapOptions& options, const std::string& file)
{
    const bool is_metres = found.image.largest == 0, has_place = found.frame.has_value();
    if (is_metres && options.z)
        throw FileError(file, "has heights in metres already; " + key(options, "z", "[LOW, HIGH]") + " must go");
    const bool needs_size = !has_place && !tells_spacing(options), needs_z = !is_metres && !options.z && !has_place;
    if (needs_size && needs_z && options.place.starts_with("--"))
        throw FileError(file,
                        "tells neither its size nor its heights: --heightmap 'size: [X, Y], z: [LOW, HIGH]' is missing "
                        "(m from first to last pixel "
                        "centre, and of values 0 and " +
                            number(found.image.largest) + ")");
    if (needs_size)
        throw FileError(file, "does not tell its size; " + key(options, "size", "[X, Y]") +
                                  " is missing (m from first to last pixel centre; or cell, m between two)");
    if (needs_z)
        throw FileError(file, "is an integer image; " + key(options, "z", "[LOW, HIGH]") +
                                  " is missing (heights of 0 and of the largest value)");
    if (options.origin && !has_place)
        throw FileError(
            file, key(options, "origin", "[X, Y]") + " is for a file that tells where it lies, without size and cell");
}

/// Whether a pixel, as it is stored, is the no-data value.
bool is_none(double pixel, double none, bool is_float32)
{
    if (pixel == none) return true;
    // Beyond a float's range the value was stored as infinite.
    if (std::isinf(pixel))
        return is_float32 && std::abs(none) > double(std::numeric_limits<float>::max()) &&
               std::signbit(pixel) == std::signbit(none);
    return float(pixel) == float(none);  // its text may have fewer digits than the pixels
}

/// NaN where there is no height, metres elsewhere.
std::vector<double> metres(HeightFile& found, const HeightmapOptions& options)
{
    std::vector<double> heights = std::move(found.image.pixels);
    const std::optional<double> none = options.no_data ? options.no_data : found.no_data;
    const double largest = found.image.largest;
    for (double& z : heights) {
        if (none && is_none(found.is_turned ? largest - z : z, *none, found.image.is_float32))
            z = std::numeric_limits<double>::quiet_NaN();
        else
            z = options.z ? (*options.z)[0] + z / largest * ((*options.z)[1] - (*options.z)[0]) : z * found.height_unit;
    }
    return heights;
}

void check_heights(const Heightmap& map, const std::string& file)
{
    for (std::size_t i = 0; i < map.heights.size(); ++i)
        if (std::isinf(map.heights[i]))
            throw FileError(file, "row " + std::to_string(i / std::size_t(map.cols)) + ", column " +
                                      std::to_string(i % std::size_t(map.cols)) +
                                      " is infinite, needs a finite height or NaN (no ground)");
}

/// A value of the file, the lowest, that is likely meant as no data; nothing if there is none. `unit` is that of the
/// heights, < 0 of depths.
std::optional<double> likely_no_data(const std::vector<double>& heights, double unit)
{
    std::optional<double> lowest;  // but for its unit
    for (const double z : heights)
        if (!std::isnan(z) && (!lowest || (unit < 0 ? z > *lowest : z < *lowest))) lowest = z;
    for (const double usual : {-9999.0, -32768.0, -32767.0})
        if (lowest == usual * unit) return usual;
    return lowest && *lowest / unit < -1e30 ? std::optional(*lowest / unit) : std::nullopt;
}

/// Tells of holes, and of what may have been meant as one.
void tell_holes(Heightmap& map, double unit, const HeightmapOptions& options, const std::string& file)
{
    const std::size_t all = map.heights.size();
    const auto holes = std::size_t(
        std::count_if(map.heights.begin(), map.heights.end(), [](double z) { return std::isnan(z); }));
    if (holes == all) throw FileError(file, "has no heights: every pixel is NaN or no-data");
    if (holes > 0)
        map.notices.push_back(file + ": " + std::to_string(holes) + " of " + std::to_string(all) +
                              " heights are missing (no-data); there is no terrain");
    if (options.z) return;
    if (const auto lowest = likely_no_data(map.heights, unit))
        map.notices.push_back(file + ": the lowest " +
                              (unit == 1 ? "height is " + number(*lowest) + " m" : "value is " + number(*lowest)) +
                              ", which often means no data; if so: " + key(options, "nodata", number(*lowest)));
}

std::string place_words(const GeoOrigin& origin)
{
    return "x " + number(origin.x) + ", y " + number(origin.y) + (origin.crs.empty() ? "" : " (" + origin.crs + ")");
}

/// Size and place from the file's own coordinates.
void use_frame(Heightmap& map, const GeoFrame& frame, const HeightmapOptions& options)
{
    map.size = {(map.cols - 1) * frame.dx * frame.unit, (map.rows - 1) * frame.dy * frame.unit};
    const double x = frame.x + (map.cols - 1) * frame.dx / 2, y = frame.y - (map.rows - 1) * frame.dy / 2;
    map.origin = GeoOrigin{x, y, frame.unit, frame.crs};
    if (options.origin) {
        map.origin->x = (*options.origin)[0];
        map.origin->y = (*options.origin)[1];
        map.middle = Vec3((x - map.origin->x) * frame.unit, (y - map.origin->y) * frame.unit, 0);
    }
}

HeightmapOptions read_heightmap_options(const YamlMap& map)
{
    map.only({"file", "size", "cell", "z", "origin", "nodata", "raw"});
    HeightmapOptions options;
    if (map.has("size")) options.size = map.positive_pair("size");
    if (map.has("cell") && options.size) map.fail("cell", "is given together with size, needs only one of them");
    if (map.has("cell") && map.is_list("cell"))
        options.cell = map.positive_pair("cell");
    else if (map.has("cell"))
        options.cell = {map.positive("cell"), map.positive("cell")};
    if (map.has("z")) options.z = map.pair("z");
    if (map.has("origin")) options.origin = map.pair("origin");
    if (map.has("nodata")) options.no_data = map.finite("nodata");
    if (map.has("raw")) options.raw = read_raw_layout(map.map("raw"));
    return options;
}

HeightmapOptions parse_heightmap_options(const std::string& text)
{
    try {
        const YAML::Node node = YAML::Load("{" + text + "}");
        const YamlMap map(node, "--heightmap", "");
        if (map.has("file")) map.fail("file", "is the scene itself here");
        HeightmapOptions options = read_heightmap_options(map);
        options.place = "--heightmap ";
        return options;
    } catch (const FileError& error) {
        throw ArgumentError("load_scene", error.what());
    } catch (const YAML::Exception&) {
        throw ArgumentError("load_scene",
                            "--heightmap is \"" + text + "\", needs keys such as size: [513, 513], z: [0, 75]");
    }
}

Heightmap read_heightmap(const std::filesystem::path& file, const HeightmapOptions& options)
{
    Heightmap map;
    HeightFile found = read_height_file(file, options.raw, !tells_spacing(options), map.notices);
    map.rows = found.image.rows;
    map.cols = found.image.cols;
    if (map.rows < 2 || map.cols < 2)
        throw FileError(file.string(), "has " + std::to_string(map.cols) + " x " + std::to_string(map.rows) +
                                           " pixels, needs at least 2 x 2");
    check_complete(found, options, file.string());
    if (found.image.largest > 0 && !options.z)
        map.notices.push_back(file.string() + ": heights are whole numbers, taken as metres");
    if (const std::uint64_t count = found.image.pixels.size(); count > many_heights)
        map.notices.push_back(file.string() + ": has " + std::to_string(count) + " heights; a bake takes about " +
                              std::to_string(count * bake_bytes / 1000000000) +
                              " GB of memory (gdalwarp -tr makes it coarser)");
    if (options.size)
        map.size = *options.size;
    else if (options.cell)
        map.size = {(map.cols - 1) * (*options.cell)[0], (map.rows - 1) * (*options.cell)[1]};
    else
        use_frame(map, *found.frame, options);
    map.heights = metres(found, options);
    check_heights(map, file.string());
    tell_holes(map, found.height_unit, options, file.string());
    return map;
}

void place_scene(Scene& scene, const Heightmap& map, const Pose& pose, const std::string& file)
{
    scene.notices.insert(scene.notices.end(), map.notices.begin(), map.notices.end());
    if (!map.origin || !pose.rotation.isIdentity(0)) return;
    GeoOrigin origin = *map.origin;
    origin.x -= pose.position.x() / origin.unit;
    origin.y -= pose.position.y() / origin.unit;
    if (!scene.origin) {
        scene.origin = origin;
        scene.notices.push_back(file + ": " + place_words(origin) + " is at 0, 0 of the scene; z is not shifted");
        return;
    }
    constexpr double tolerance = 1e-3, digits = 1e-12;  // m; relative, as one unit is written with more or fewer digits
    const double apart = std::hypot(origin.x - scene.origin->x, origin.y - scene.origin->y) * origin.unit;
    if (apart > tolerance || std::abs(origin.unit - scene.origin->unit) > digits * origin.unit ||
        origin.crs != scene.origin->crs)
        scene.notices.push_back(
            file + ": " + place_words(origin) + " is at 0, 0 of the scene, but an earlier part has " +
            place_words(*scene.origin) +
            " there: they do not lie to each other as in their files (the key origin, the same for all, does that)");
}

void append_heightmap(Scene& scene, std::uint32_t part, const Heightmap& map, const Pose& pose, bool sides_up)
{
    const double dx = map.size[0] / (map.cols - 1), dy = map.size[1] / (map.rows - 1);
    constexpr std::uint32_t unused = 0xffffffff;
    std::vector<Vec3> vertices;
    std::vector<std::uint32_t> index(map.heights.size(), unused);
    const auto vertex = [&](std::size_t pixel) {
        if (index[pixel] == unused) {
            const double row = double(pixel / std::size_t(map.cols)), col = double(pixel % std::size_t(map.cols));
            const Vec3 local(col * dx - map.size[0] / 2, map.size[1] / 2 - row * dy, map.heights[pixel]);
            index[pixel] = static_cast<std::uint32_t>(vertices.size());
            vertices.push_back(pose.rotation * (local + map.middle) + pose.position);
        }
        return index[pixel];
    };
    std::vector<Triangle> triangles;
    const auto add = [&](std::size_t a, std::size_t b, std::size_t c) {
        if (!std::isnan(map.heights[a] + map.heights[b] + map.heights[c]))
            triangles.push_back({vertex(a), vertex(b), vertex(c)});
    };
    for (int row = 0; row + 1 < map.rows; ++row)
        for (int col = 0; col + 1 < map.cols; ++col) {
            const std::size_t corner = std::size_t(row) * map.cols + col;
            const std::size_t right = corner + 1, below = corner + map.cols, opposite = below + 1;
            add(corner, below, opposite);  // counterclockwise from above: rows run against y
            add(corner, opposite, right);
        }
    append_sheet(scene, part, vertices, triangles, sides_up);
}

}  // namespace spawnfield
