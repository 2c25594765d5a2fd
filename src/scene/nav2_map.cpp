#include "scene/nav2_map.h"

#include "base/cell_blocks.h"
#include "base/number.h"
#include "base/pgm.h"
#include "base/png.h"
#include "base/yaml_map.h"
#include "scene/height_file.h"
#include "scene/pieces.h"

#include <spawnfield/error.h>
#include <spawnfield/input_file.h>

#include <Eigen/Geometry>

#include <cmath>
#include <map>

namespace spawnfield {
namespace {

/// How pixels are converted to cells.
struct PixelRule {
    std::string mode = "trinary";
    bool negate = false;
    double occupied_thresh = 0.65, free_thresh = 0.196;
};

/// Brightness and opacity of the pixels.
struct Pixels {
    int rows = 0, cols = 0;
    double largest = 255;
    std::vector<float> mean;   ///< mean of the colours, 0 .. largest
    std::vector<float> alpha;  ///< 0 .. largest; empty: all are opaque
};

Pixels pixels_of(const ColourImage& image)
{
    const bool has_alpha = image.channels % 2 == 0;
    const std::size_t colours = std::size_t(image.channels) - has_alpha,
                      count = std::size_t(image.rows) * std::size_t(image.cols);
    Pixels out{image.rows, image.cols, double(image.largest), {}, {}};
    out.mean.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint16_t* const sample = image.samples.data() + i * std::size_t(image.channels);
        float sum = 0;
        for (std::size_t c = 0; c < colours; ++c) sum += sample[c];
        out.mean.push_back(sum / float(colours));
        if (has_alpha) out.alpha.push_back(sample[colours]);
    }
    return out;
}

Pixels read_pixels(const std::filesystem::path& file)
{
    const std::string start = read_start(file, 8);
    if (is_png(start)) return pixels_of(read_colour_png(file, max_heights));
    if (!is_pgm(start))
        throw FileError(file.string(), "is not PGM (P2, P5) or PNG; convert the map's image to one of them");
    const GreyImage image = read_pgm(file, max_heights);
    return {image.rows, image.cols, image.largest, {image.pixels.begin(), image.pixels.end()}, {}};
}

Nav2Map::Cell cell_of(double occupancy, const PixelRule& rule)
{
    if (occupancy > rule.occupied_thresh) return Nav2Map::Cell::Occupied;
    return occupancy < rule.free_thresh ? Nav2Map::Cell::Free : Nav2Map::Cell::Unknown;
}

Nav2Map::Cell cell_of(const Pixels& pixels, std::size_t i, const PixelRule& rule)
{
    double value = pixels.mean[i];
    if (rule.mode == "raw") {
        const double percent = std::round(value / pixels.largest * 255);
        return percent <= 100 ? cell_of(percent / 100, rule) : Nav2Map::Cell::Unknown;
    }
    if (!pixels.alpha.empty()) {
        const double alpha = pixels.alpha[i];
        if (rule.mode == "scale" && alpha < pixels.largest) return Nav2Map::Cell::Unknown;
        if (rule.mode == "trinary")
            value = (3 * value + alpha) / 4;  // as nav2: alpha is a fourth colour, and grey counts as three
    }
    return cell_of((rule.negate ? value : pixels.largest - value) / pixels.largest, rule);
}

bool read_negate(const YamlMap& map)
{
    const std::string text = map.text("negate");
    if (text == "0" || text == "false" || text == "False") return false;
    if (text == "1" || text == "true" || text == "True") return true;
    map.fail("negate", "is \"" + text + "\", needs 0 or 1");
}

double read_threshold(const YamlMap& map, const std::string& key, double fallback, std::vector<std::string>& notices)
{
    if (!map.has(key)) {
        notices.push_back(map.file() + ": " + key + " is missing; the default " + number(fallback) + " is used");
        return fallback;
    }
    const double value = map.finite(key);
    if (!(value >= 0 && value <= 1)) map.fail(key, "is " + number(value) + ", needs 0 .. 1");
    return value;
}

PixelRule read_pixel_rule(const YamlMap& map, std::vector<std::string>& notices)
{
    PixelRule out;
    out.mode = map.one_of("mode", {"trinary", "scale", "raw"}, "trinary");
    if (map.has("negate")) out.negate = read_negate(map);
    out.occupied_thresh = read_threshold(map, "occupied_thresh", out.occupied_thresh, notices);
    out.free_thresh = read_threshold(map, "free_thresh", out.free_thresh, notices);
    if (out.free_thresh > out.occupied_thresh)
        map.fail("free_thresh", "is " + number(out.free_thresh) + ", needs at most occupied_thresh (" +
                                    number(out.occupied_thresh) + ")");
    if (out.mode == "raw" && out.negate)
        notices.push_back(map.file() + ": negate has no effect in mode raw, as in nav2");
    return out;
}

void note_unknown_keys(const YamlMap& map, std::vector<std::string>& notices)
{
    const std::vector<std::string> known = {"image",           "resolution",  "origin", "negate",
                                            "occupied_thresh", "free_thresh", "mode"};
    for (const std::string& key : map.keys())
        if (std::find(known.begin(), known.end(), key) == known.end())
            notices.push_back(map.file() + ": the key " + key + " is unknown and ignored");
}

/// Adds a notice if pixels of 205, which map savers write for unknown, are read as free. This happens with free_thresh
/// 0.25, which nav2 writes too, and if alpha counts as a colour.
void note_grey_pixels(const Pixels& pixels, const PixelRule& rule, Nav2Map& map, const std::string& file)
{
    if (rule.mode != "trinary" || pixels.largest != 255) return;
    constexpr double unknown = 205;
    std::size_t grey = 0;
    for (std::size_t i = 0; i < map.cells.size(); ++i)
        grey += pixels.mean[i] == unknown && map.cells[i] == Nav2Map::Cell::Free;
    if (grey == 0) return;
    const double occupancy = (rule.negate ? unknown : pixels.largest - unknown) / pixels.largest;
    const bool by_threshold = cell_of(occupancy, rule) == Nav2Map::Cell::Free;
    map.notices.push_back(
        file + ": " + std::to_string(grey) + " pixels of 205, which map savers write for unknown, are free" +
        (by_threshold
             ? " by free_thresh " + number(rule.free_thresh) + " (with free_thresh 0.196 or less they are unknown)"
             : ", because mode trinary counts alpha as a fourth colour, as in nav2 (without the alpha channel they are "
               "not free)"));
}

}  // namespace

Vec3 Nav2Map::corner(int row_line, int col_line) const
{
    const double u = col_line * resolution, v = (rows - row_line) * resolution;
    if (yaw == 0) return {x + u, y + v, 0};
    return {x + std::cos(yaw) * u - std::sin(yaw) * v, y + std::sin(yaw) * u + std::cos(yaw) * v, 0};
}

bool is_nav2_map(const std::filesystem::path& file)
{
    constexpr std::uintmax_t most = 65536;  // bytes; so a large scene is not parsed twice
    std::error_code error;
    if (const std::uintmax_t size = std::filesystem::file_size(file, error); error || size > most) return false;
    try {
        const YAML::Node root = YAML::LoadFile(file.string());
        return root.IsMap() && root["image"] && !root["format"];
    } catch (const YAML::Exception&) {
        return false;
    }
}

Nav2Map read_nav2_map(const std::filesystem::path& file)
{
    const YamlMap map = read_yaml(file);
    Nav2Map out;
    note_unknown_keys(map, out.notices);
    out.resolution = map.positive("resolution");
    if (out.resolution > 1000) map.fail("resolution", "is " + number(out.resolution) + ", needs at most 1000 m");
    const Vec3 origin = map.vector("origin");
    out.x = origin.x();
    out.y = origin.y();
    out.yaw = origin.z();
    const PixelRule rule = read_pixel_rule(map, out.notices);
    const std::filesystem::path image = file.parent_path() / map.text("image");
    Pixels pixels;
    try {
        pixels = read_pixels(image);
    } catch (const FileError& error) {
        map.fail("image", std::string("cannot be used: ") + error.what());
    }
    out.rows = pixels.rows;
    out.cols = pixels.cols;
    out.cells.resize(pixels.mean.size());
    for (std::size_t i = 0; i < out.cells.size(); ++i) out.cells[i] = cell_of(pixels, i, rule);
    note_grey_pixels(pixels, rule, out, file.string());
    return out;
}

namespace {

void append_floor(Scene& scene, std::uint32_t part, const Nav2Map& map)
{
    std::vector<Vec3> vertices;
    std::vector<Triangle> triangles;
    std::map<std::pair<int, int>, std::uint32_t> index;
    const auto vertex = [&](int row, int col) {
        const auto [found, is_new] = index.try_emplace({row, col}, std::uint32_t(vertices.size()));
        if (is_new) vertices.push_back(map.corner(row, col));
        return found->second;
    };
    for (const CellRectangle& b : blocks_of(
             map.rows, map.cols, [&](int row, int col) { return map.cell(row, col) != Nav2Map::Cell::Unknown; })) {
        const std::uint32_t low = vertex(b.end_row, b.first_col), right = vertex(b.end_row, b.end_col);
        const std::uint32_t high = vertex(b.first_row, b.end_col), left = vertex(b.first_row, b.first_col);
        triangles.push_back({low, right, high});
        triangles.push_back({low, high, left});
    }
    append_sheet(scene, part, vertices, triangles, false);
}

void append_walls(Scene& scene, std::uint32_t part, const Nav2Map& map, double height)
{
    for (const CellRectangle& b : blocks_of(
             map.rows, map.cols, [&](int row, int col) { return map.cell(row, col) == Nav2Map::Cell::Occupied; })) {
        Primitive wall;
        wall.shape.kind = ShapeKind::Box;
        wall.shape.size = Vec3((b.end_col - b.first_col) * map.resolution, (b.end_row - b.first_row) * map.resolution,
                               height);
        wall.shape.pose.position = (map.corner(b.first_row, b.first_col) + map.corner(b.end_row, b.end_col)) / 2 +
                                   Vec3(0, 0, height / 2);
        wall.shape.pose.rotation = rotation_from_rpy(0, 0, map.yaw);
        wall.part = part;
        wall.label = scene.parts[part].label;
        scene.primitives.push_back(wall);
        ++scene.parts[part].solid_pieces;
    }
}

}  // namespace

void append_nav2_map(Scene& scene, const Nav2Map& map, Label floor, Label walls, double wall_height)
{
    const std::uint32_t floor_part = add_part(scene, "floor", "map", floor),
                        wall_part = add_part(scene, "walls", "map", walls);
    if (floor != Label::Ignore) append_floor(scene, floor_part, map);
    if (walls != Label::Ignore) append_walls(scene, wall_part, map, wall_height);
}

}  // namespace spawnfield
