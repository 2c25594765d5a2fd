#include "map/map_yaml.h"

#include "base/checksum.h"
#include "base/foreign_file.h"
#include "base/input_file.h"
#include "base/number.h"
#include "base/text.h"
#include "base/yaml_map.h"
#include "mesh/mesh_file.h"

#include <spawnfield/error.h>
#include <spawnfield/input_file.h>
#include <spawnfield/output_file.h>
#include <spawnfield/terrain.h>

#include <fcl/config.h>
#include <libdeflate.h>
#include <octomap/octomap_types.h>
#include <opencv2/core/version.hpp>

#include <algorithm>
#include <cmath>

namespace spawnfield {
namespace {

namespace fs = std::filesystem;

const std::string format_prefix = "spawnfield-map/";
const std::string hash_key = "hash: ";
constexpr int oldest_format = 2;  // has no z_limits and no floors

std::string quoted(const std::string& text)
{
    YAML::Emitter out;
    out << YAML::DoubleQuoted << text;
    return out.c_str();
}

std::string list_of(std::initializer_list<double> values)
{
    std::string out;
    for (const double value : values) {
        out += out.empty() ? "[" : ", ";
        append_number(out, value);
    }
    return out + "]";
}

std::string libraries()
{
    return "{assimp: \"" + mesh_reader_version() +
           "\", fcl: \"" FCL_VERSION "\", libdeflate: \"" LIBDEFLATE_VERSION_STRING "\", opencv: \"" CV_VERSION "\"}";
}

/// Returns the lines with the versions of the program and of the libraries whose results a bake contains.
std::string program_lines() { return "program: {spawnfield: \"" + version() + "\"}\nlibraries: " + libraries() + "\n"; }

/// Returns a line with the numbers of triangles and primitives for each label.
std::string label_counts(const LabelCounts& counts)
{
    std::string out;
    for (std::size_t label = 0; label < counts.size(); ++label)
        out += std::string("  ") + to_string(Label(label)) +
               ": {triangles: " + std::to_string(counts[label].triangles) +
               ", primitives: " + std::to_string(counts[label].primitives) + "}\n";
    return out;
}

std::string file_lines(const fs::path& folder, const std::vector<ListedFile>& written)
{
    std::string out;
    for (const char* const name : map_files) {
        const auto known = std::find_if(written.begin(), written.end(),
                                        [&](const ListedFile& file) { return file.name == name; });
        const ListedFile file = known != written.end() ? *known : entry_of(folder / name);
        out += "  " + file.name + ": {bytes: " + std::to_string(file.bytes) + ", xxh64: \"" + file.checksum + "\"";
        if (!file.head_checksum.empty()) out += ", head_xxh64: \"" + file.head_checksum + "\"";
        out += "}\n";
    }
    return out;
}

Bounds read_bounds(const YamlMap& root)
{
    const YamlMap map = root.map("bounds");
    Bounds bounds;
    bounds.min = map.vector("min");
    bounds.max = map.vector("max");
    if (bounds.is_empty()) root.fail("bounds", "has min above max, needs min at most max");
    return bounds;
}

GridFrame read_frame(const YamlMap& root)
{
    const YamlMap map = root.map("frame");
    GridFrame frame;
    frame.x0 = map.finite("x0");
    frame.y0 = map.finite("y0");
    frame.cell = map.positive("cell");
    frame.rows = int(map.whole("rows", 1, max_side));
    frame.cols = int(map.whole("cols", 1, max_side));
    return frame;
}

std::string origin_text(const GeoOrigin& origin)
{
    const std::string crs = origin.crs.empty() ? "" : ", crs: " + quoted(origin.crs);
    return "{x: " + number(origin.x) + ", y: " + number(origin.y) + ", unit: " + number(origin.unit) + crs + "}";
}

GeoOrigin read_origin(const YamlMap& map)
{
    return {map.finite("x"), map.finite("y"), map.positive("unit"), map.text("crs", "")};
}

/// Returns the limits as a YAML list. Infinite limits are written as YAML 1.2 requires.
std::string z_text(const ZRange& z)
{
    const auto limit = [](double value) {
        return std::isfinite(value) ? number(value) : std::string(value < 0 ? "-.inf" : ".inf");
    };
    return "[" + limit(z.low) + ", " + limit(z.high) + "]";
}

ZRange read_z(const YamlMap& map, const std::string& key)
{
    const YAML::Node node = map.list(key);
    ZRange z;
    try {
        z = {node[0].as<double>(), node[1].as<double>()};
    } catch (const YAML::Exception&) {
        map.fail(key, "needs two heights, m: [LOW, HIGH]");
    }
    if (!(z.low <= z.high)) map.fail(key, "has its higher limit first, needs [LOW, HIGH]");
    return z;
}

std::pair<double, double> read_heightmap_z(const YamlMap& heightmap)
{
    const ZRange z = read_z(heightmap, "z");
    return {z.low, z.high};
}

std::string floor_lines(const std::vector<Floor>& floors)
{
    if (floors.empty()) return " []\n";
    std::string out = "\n";
    for (const Floor& floor : floors)
        out += "  - {height: " + number(floor.height) + ", z: " + z_text(floor.z) + ", area: " + number(floor.area) +
               ", share: " + number(floor.share) + "}\n";
    return out;
}

std::vector<Floor> read_floors(const YamlMap& root)
{
    std::vector<Floor> out;
    for (const YAML::Node& node : root.list("floors")) {
        const YamlMap entry(node, root.file(), "floor " + std::to_string(out.size()));
        out.push_back({entry.finite("height"), read_z(entry, "z"), entry.finite("area"), entry.finite("share")});
    }
    return out;
}

/// Returns the last line of map.yaml, which contains the checksum of all lines before it.
std::string hash_line(const std::string& hash) { return hash_key + "\"" + hash + "\"\n"; }

/// Returns the hash in the last line of map.yaml. Throws FileError if it differs from the checksum of the other lines.
std::string verified_hash(const fs::path& file, const std::string& text)
{
    const std::size_t size = hash_line(checksum("")).size();
    const std::size_t line = text.size() < size ? 0 : text.size() - size;
    if (text.compare(line, hash_key.size(), hash_key) != 0 || text.back() != '\n')
        throw FileError(file.string(), "is cut short: its last line, hash, is missing; bake the map again");
    const std::string hash = checksum(std::string_view(text).substr(0, line));
    if (text.substr(line) != hash_line(hash))
        throw FileError(file.string(), "differs from the hash in its last line: it was altered; bake the map again");
    return hash;
}

/// Returns the format version of a map.yaml. Throws FileError if this program cannot read that version, before anything
/// else is read.
int version_of(const fs::path& file, const std::string& text)
{
    const std::size_t prefix = text.find(format_prefix);
    if (!text.starts_with("format: ") || prefix == std::string::npos || prefix > 16)
        throw FileError(file.string(), "is not a map.yaml of spawnfield (its first line is not `format: " +
                                           format_prefix + std::to_string(map_format_version) + "`)");
    const std::string found = text.substr(prefix + format_prefix.size(),
                                          text.find('\n') - prefix - format_prefix.size());
    for (int version = oldest_format; version <= map_format_version; ++version)
        if (found == std::to_string(version)) return version;
    throw FileError(file.string(), "has format version " + found + ", this program reads " +
                                       std::to_string(oldest_format) + " to " + std::to_string(map_format_version) +
                                       "; bake the map again or use a newer spawnfield");
}

/// Throws FileError for a map argument that is not a folder. The message advises what to give instead.
[[noreturn]] void refuse_as_map(const fs::path& file)
{
    require_file(file);
    refuse_foreign_scene(file);
    const std::string name = file.string(), text = read_start(file, 4096);
    if (text.starts_with("format: " + format_prefix))
        throw FileError(name, "is a file of a map; give its folder, " +
                                  (file.parent_path().empty() ? fs::path(".") : file.parent_path()).string());
    if (text.find("spawnfield-robot/") != std::string::npos || lower_case(file.extension().string()) == ".urdf")
        throw FileError(name, "is a robot, not a map; give it as --robot " + name + ", and a map folder before it");
    throw FileError(name, "is a file, and a map is a folder; bake a scene first: spawnfield bake " + name + " -o MAP");
}

}  // namespace

std::string write_map_yaml(const fs::path& folder, const Map& map, const TerrainMap& terrain,
                           std::pair<double, double> heightmap_range, const std::vector<ListedFile>& written)
{
    const GridFrame& frame = terrain.frame;
    std::string text = "format: " + format_prefix + std::to_string(map_format_version) + "\n";
    text += "name: " + quoted(map.name) + "\n";
    text += program_lines();
    text += "scene: {file: " + quoted(map.scene_file) + ", xxh64: \"" + map.scene_hash + "\"}\n";
    text += "# metres, x forward, y left, z up\n";
    text += "bounds: {min: " + list_of({map.bounds.min.x(), map.bounds.min.y(), map.bounds.min.z()}) +
            ", max: " + list_of({map.bounds.max.x(), map.bounds.max.y(), map.bounds.max.z()}) + "}\n";
    if (!map.z_limits.is_unlimited())
        text += "# poses beyond these heights are outside, layers beyond them are no ground\nz_limits: " +
                z_text(map.z_limits) + "\n";
    text += "resolution: " + number(map.resolution) + "\n";
    text += "occupancy_resolution: " + number(map.occupancy_resolution) + "\n";
    if (const Vec3& at = map.occupancy_origin; !at.isZero(0))
        text += "# metres: where 0, 0, 0 of occupancy.bt is\noccupancy_origin: " + list_of({at.x(), at.y(), at.z()}) +
                "\n";
    text += "# of every image: row 0 is the largest y, column 0 the smallest x; x0, y0 is the lower left corner\n";
    text += "frame: {x0: " + number(frame.x0) + ", y0: " + number(frame.y0) + ", cell: " + number(frame.cell) +
            ", rows: " + std::to_string(frame.rows) + ", cols: " + std::to_string(frame.cols) + "}\n";
    if (map.origin)
        text += "# survey coordinates of 0, 0, in units of so many metres\norigin: " + origin_text(*map.origin) + "\n";
    if (map.is_unlabelled) text += "unlabelled: true  # no label was given, so everything is terrain\n";
    text += "layers: " + std::to_string(map.layers) + "\n";
    text +=
        "# from the lowest up: z has the layers that belong to it, area is m2 of ground, share is of all "
        "ground\nfloors:" +
        floor_lines(*map.floors);
    text += "terrain:  # pages of terrain.tiff, float32 metres, NaN: nothing\n";
    for (const TerrainMap::Page& page : terrain.pages) text += "  - " + page.name + "\n";
    text += "heightmap: {z: " + list_of({heightmap_range.first, heightmap_range.second}) +
            ", no_terrain: 0}  # of pixels 0 and 65535\n";
    text += "labels:\n" + label_counts(map.geometry.labels());
    text += "files:\n" + file_lines(folder, written);
    const std::string hash = checksum(text);
    write_file_atomically(folder / "map.yaml", text + hash_line(hash));
    return hash;
}

MapYaml read_map_yaml(const fs::path& folder)
{
    if (!is_folder(folder)) refuse_as_map(folder);
    const fs::path file = folder / "map.yaml";
    if (is_missing(file))
        throw FileError(folder.string(),
                        "is not a map: it has no map.yaml; make a map with `spawnfield bake SCENE -o MAP`");
    const std::string text = read_file(file);
    const int format = version_of(file, text);
    MapYaml out;
    out.map.hash = verified_hash(file, text);
    out.map.folder = folder;
    out.map.format_version = format;
    const YamlMap root = read_yaml(file, format_prefix + std::to_string(format));
    out.map.name = root.text("name");
    out.map.bounds = read_bounds(root);
    out.map.resolution = root.positive("resolution");
    out.map.occupancy_resolution = root.positive("occupancy_resolution");
    if (root.has("occupancy_origin")) out.map.occupancy_origin = root.vector("occupancy_origin");
    if (root.has("z_limits")) out.map.z_limits = read_z(root, "z_limits");
    if (format > oldest_format) out.map.floors = read_floors(root);
    if (root.has("origin")) out.map.origin = read_origin(root.map("origin"));
    out.map.is_unlabelled = root.has("unlabelled");
    out.map.layers = int(root.whole("layers", 0, 1e9));
    out.map.scene_file = root.map("scene").text("file");
    out.map.scene_hash = root.map("scene").text("xxh64");
    out.frame = read_frame(root);
    for (const YAML::Node& page : root.list("terrain")) out.pages.push_back(page.Scalar());
    out.heightmap_z = read_heightmap_z(root.map("heightmap"));
    const YamlMap files = root.map("files");
    for (const std::string& name : files.keys()) {
        const YamlMap entry = files.map(name);
        out.files.push_back(
            {name, entry.text("xxh64"), entry.text("head_xxh64", ""), std::uintmax_t(entry.whole("bytes", 0, 0x1p53))});
    }
    return out;
}

const ListedFile& listed(const MapYaml& yaml, const std::string& name)
{
    const auto file = std::find_if(yaml.files.begin(), yaml.files.end(),
                                   [&](const ListedFile& f) { return f.name == name; });
    if (file == yaml.files.end())
        throw FileError((yaml.map.folder / "map.yaml").string(),
                        "does not list " + name + " under files; bake the map again");
    return *file;
}

bool is_of_this_program(const fs::path& folder)
{
    return read_file(folder / "map.yaml").find("\n" + program_lines()) != std::string::npos;
}

}  // namespace spawnfield
