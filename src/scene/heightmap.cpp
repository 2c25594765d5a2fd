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
    raw.rows = int(map.whole("rows", 1, double(max_heights)));
    raw.cols = int(map.whole("cols", 1, double(max_heights)));
    return raw;
}

/// Returns a key as the user writes it: "heightmap.z" in a scene.yaml, or "--heightmap 'z: [LOW, HIGH]'" for an
/// elevation model by itself.
std::string key(const HeightmapOptions& options, const std::string& name, const std::string& value)
{
    return options.place.starts_with("--") ? options.place + "'" + name + ": " + value + "'" : options.place + name;
}

bool gives_spacing(const HeightmapOptions& options) { return options.size || options.cell; }

/// Throws FileError for a size, heights or place that neither the file nor the options give, and for options that
/// contradict the file.
void check_complete(const HeightFile& found, const HeightmapOptions& options, const std::string& file)
{
    const bool is_metres = found.image.largest == 0, has_place = found.frame.has_value();
    if (is_metres && options.z)
        throw FileError(file, "has heights in metres already; remove " + key(options, "z", "[LOW, HIGH]"));
    const bool needs_size = !has_place && !gives_spacing(options), needs_z = !is_metres && !options.z && !has_place;
    if (needs_size && needs_z && options.place.starts_with("--"))
        throw FileError(file,
                        "states neither its size nor its heights; give --heightmap 'size: [X, Y], z: [LOW, HIGH]' (m "
                        "from first to last pixel centre, and m of the values 0 and " +
                            number(found.image.largest) + ")");
    if (needs_size)
        throw FileError(file, "does not state its size; give " + key(options, "size", "[X, Y]") +
                                  " (m from first to last pixel centre), or cell (m between two pixels)");
    if (needs_z)
        throw FileError(file, "is an integer image; give " + key(options, "z", "[LOW, HIGH]") +
                                  " (heights in m of the value 0 and of the largest value)");
    if (options.origin && !has_place)
        throw FileError(file, key(options, "origin", "[X, Y]") +
                                  " is only for a file that states its place, without the keys size and cell");
}

/// Returns whether a pixel of the file is the no-data value.
bool is_no_data(double pixel, double none, bool is_float32)
{
    if (pixel == none) return true;
    // A no-data value beyond the range of float is stored as infinity.
    if (std::isinf(pixel))
        return is_float32 && std::abs(none) > double(std::numeric_limits<float>::max()) &&
               std::signbit(pixel) == std::signbit(none);
    return float(pixel) == float(none);  // the text of the no-data value may have fewer digits than the pixels
}

/// Returns the heights in metres; NaN if a pixel has no height.
std::vector<double> metres(HeightFile& found, const HeightmapOptions& options)
{
    std::vector<double> heights = std::move(found.image.pixels);
    const std::optional<double> none = options.no_data ? options.no_data : found.no_data;
    const double largest = found.image.largest;
    for (double& z : heights) {
        if (none && is_no_data(found.is_inverted ? largest - z : z, *none, found.image.is_float32))
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

/// Returns the lowest value of the file if it most likely means no data; empty if it does not. `unit` is that of the
/// heights, < 0 for depths.
std::optional<double> likely_no_data(const std::vector<double>& heights, double unit)
{
    std::optional<double> lowest;  // height of the pixel with the lowest value, m
    for (const double z : heights)
        if (!std::isnan(z) && (!lowest || (unit < 0 ? z > *lowest : z < *lowest))) lowest = z;
    for (const double usual : {-9999.0, -32768.0, -32767.0})
        if (lowest == usual * unit) return usual;
    return lowest && *lowest / unit < -1e30 ? std::optional(*lowest / unit) : std::nullopt;
}

/// Adds a notice about pixels without height, and one about a value that may mean no data. Throws FileError if there is
/// no height at all.
void note_holes(Heightmap& map, double unit, const HeightmapOptions& options, const std::string& file)
{
    const std::size_t all = map.heights.size();
    const auto holes = std::size_t(
        std::count_if(map.heights.begin(), map.heights.end(), [](double z) { return std::isnan(z); }));
    if (holes == all) throw FileError(file, "has no heights: every pixel is NaN or no-data");
    if (holes > 0)
        map.notices.push_back(file + ": " + std::to_string(holes) + " of " + std::to_string(all) +
                              " heights are missing (no data); there is no terrain at these places");
    if (options.z) return;
    if (const auto lowest = likely_no_data(map.heights, unit))
        map.notices.push_back(file + ": the lowest " +
                              (unit == 1 ? "height is " + number(*lowest) + " m" : "value is " + number(*lowest)) +
                              ", which often means no data; if it does here, give " +
                              key(options, "nodata", number(*lowest)));
}

std::string place_words(const GeoOrigin& origin)
{
    return "x " + number(origin.x) + ", y " + number(origin.y) + (origin.crs.empty() ? "" : " (" + origin.crs + ")");
}

/// Sets size and place from the coordinates of the file.
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
        if (map.has("file")) map.fail("file", "is not allowed here, because the scene itself is the file");
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
    HeightFile found = read_height_file(file, options.raw, !gives_spacing(options), map.notices);
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
                              " GB of memory (make it coarser with gdalwarp -tr)");
    if (options.size)
        map.size = *options.size;
    else if (options.cell)
        map.size = {(map.cols - 1) * (*options.cell)[0], (map.rows - 1) * (*options.cell)[1]};
    else
        use_frame(map, *found.frame, options);
    map.heights = metres(found, options);
    check_heights(map, file.string());
    note_holes(map, found.height_unit, options, file.string());
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
    constexpr double tolerance = 1e-3;  // m
    constexpr double digits = 1e-12;    // relative, because units are written with different numbers of digits
    const double distance = std::hypot(origin.x - scene.origin->x, origin.y - scene.origin->y) * origin.unit;
    if (distance > tolerance || std::abs(origin.unit - scene.origin->unit) > digits * origin.unit ||
        origin.crs != scene.origin->crs)
        scene.notices.push_back(file + ": " + place_words(origin) +
                                " is at 0, 0 of the scene, but an earlier part has " + place_words(*scene.origin) +
                                " there, so they are not placed relative to each other as in their files (to do so, "
                                "give all the same key origin)");
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
