#include "base/checksum.h"
#include "geometry/geometry_impl.h"
#include "map/bounds_file.h"
#include "map/geometry_file.h"
#include "map/map_yaml.h"
#include "map/occupancy_towers.h"
#include "map/terrain_file.h"
#include "reach/reach_graph.h"
#include "reader.h"

#include <spawnfield/error.h>
#include <spawnfield/free_space.h>
#include <spawnfield/input_file.h>
#include <spawnfield/path.h>

#include <cstring>
#include <limits>

// Readers of the files of a map folder. All files have checksums, which a fuzzer would not guess: they are corrected
// before a file is read, as if another program had written it.
namespace fuzz {
namespace {

namespace fs = std::filesystem;
using namespace spawnfield;

template <class T>
T value_at(const std::string& bytes, std::size_t at)
{
    T value{};
    if (at <= bytes.size() && sizeof(T) <= bytes.size() - at) std::memcpy(&value, bytes.data() + at, sizeof value);
    return value;
}

constexpr std::size_t head_prefix = 24;  ///< bytes of a head before its content; the last 8 are the size of the head

std::size_t head_size(const std::string& bytes) { return value_at<std::uint64_t>(bytes, 16); }

/// Corrects the checksums of tiles in the head of geometry.bin or bounds.bin. `levels` is where the levels begin.
void correct_checksums(std::string& bytes, std::size_t levels)
{
    const std::size_t head = head_size(bytes);
    if (head > bytes.size()) return;
    std::size_t at = levels + 4;
    for (auto count = value_at<std::uint32_t>(bytes, levels); count > 0 && at < head; --count) {
        at += 16;  // the side of a cell, and the numbers of columns and rows
        auto tiles = value_at<std::uint64_t>(bytes, at);
        at += 8;
        for (; tiles > 0 && at + sizeof(TileEntry) <= head; --tiles, at += sizeof(TileEntry)) {
            auto entry = value_at<TileEntry>(bytes, at);
            const std::size_t size = bytes.size() - head;
            if (entry.offset > size || entry.size > size - entry.offset) continue;
            entry.checksum = XXH64(bytes.data() + head + entry.offset, entry.size, 0);
            std::memcpy(bytes.data() + at, &entry, sizeof entry);
        }
    }
}

/// Writes a file again with correct checksums. Returns that of its head.
std::string corrected(const fs::path& file, std::size_t levels)
{
    std::string bytes = read_file(file);
    correct_checksums(bytes, levels);
    std::ofstream(file, std::ios::binary) << bytes;
    return checksum(std::string_view(bytes).substr(0, head_size(bytes)));
}

void use(const Geometry& geometry)
{
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const Rect everywhere{-infinity, -infinity, infinity, infinity};
    geometry.impl().visit_tiles(everywhere, [](const Tile& tile, const ElementBox&) {
        for (std::uint32_t element = 0; element < tile.elements(); ++element) {
            tile.bounds(element);
            tile.part(element);
        }
    });
    for (const double x : {-6.0, -1.0, 1.0, 2.1, 6.0})
        for (const double y : {-0.2, 0.0, 1.0}) column_at(geometry, x, y);
    parts_that_match(geometry, "*");
}

void use(const SolidBounds& bounds, const Robot& robot)
{
    const FreeSpace space(bounds, robot);
    for (double x = -9; x <= 9; x += 1.5)
        for (const double y : {-2.0, 0.0, 1.0}) {
            space.proof_of({x, y, 0.5}, 0.3);
            space.proof_at_every_yaw({x, y, 0.5});
        }
    space.proof_of({Vec3(0, 0, 1), Mat3::Identity()});
}

void read_tiled(const fs::path& file, const Robot& robot)
{
    const std::size_t coordinates = 8;  // bytes of each
    if (file.extension() == ".bounds") {
        use(open_bounds(file, corrected(file, head_prefix + 2 * coordinates + 4)), robot);
        return;
    }
    const bool is_old = value_at<std::uint32_t>(read_file(file), 8) == 2;
    use(open_geometry(file, corrected(file, head_prefix + (is_old ? 9 : 7) * coordinates + 4)));
}

/// Reads map.yaml with the hash that it should have in its last line, and the whole map if it lists the right files.
void read_map_folder(const fs::path& file, const fs::path& folder)
{
    std::string text = read_file(file);
    const std::size_t hash = text.rfind("hash: ");
    text = text.substr(0, hash);
    std::ofstream(folder / "map.yaml", std::ios::binary) << text << "hash: \"" << checksum(text) << "\"\n";
    const Map map = read_map(folder);
    require(!map.bounds.is_empty(), "the bounds of a map are empty");
    verify_map(folder);
    floors_of(map);
    read_terrain(map);
}

void use(const TerrainMap& terrain, const fs::path& file)
{
    try {
        for (const TerrainMap::Page& page : terrain.pages) page_image(terrain, page.name);
        highest_within(terrain, {0, 1});
        terrain.layers();
    } catch (const FileError&) {
        throw;
    } catch (const std::runtime_error& error) {  // page_image() does not know the file
        throw FileError(file.string(), error.what());
    }
}

/// A map folder, copied from the stored maps, for all further readers.
struct StoredMap {
    explicit StoredMap(const fs::path& source)
    {
        constexpr auto overwrite = fs::copy_options::recursive | fs::copy_options::overwrite_existing;
        for (const int version : {3, 4, 5, 6, 7, 9})  // version 8 has only a key of map.yaml more than 7
            fs::copy(source / "tests/data/maps" / ("format-" + std::to_string(version)), folder / "map", overwrite);
    }

    fs::path path() const { return folder / "map"; }

    TempFolder folder;
    Robot robot = load_robot("box:0.4,0.3,0.2@0,0,0.1");
};

void read_map_file(const fs::path& file, const StoredMap& stored)
{
    if (file.extension() == ".yaml") {
        const fs::path folder = file.parent_path() / "map";
        fs::copy(stored.path(), folder);
        try {
            read_map_folder(file, folder);
        } catch (...) {
            fs::remove_all(folder);
            throw;
        }
        fs::remove_all(folder);
    } else if (file.extension() == ".tiff") {
        use(read_terrain_file(file, read_map_yaml(stored.path()).frame), file);
    } else {
        read_towers(file, {252, 252, 8, 8});
    }
}

/// What kept graphs are for: the stored map, a robot and its limits. Made when it is first needed.
struct GraphPlace {
    explicit GraphPlace(const StoredMap& stored) : judge(read_map(stored.path()), stored.robot) {}

    Judge judge;
    ReachOptions options{.step = 0.5, .keep_ways = true, .threads = 1};
    SettledPose start = judge.settle({-1, 0, 0.1}, 0), goal = judge.settle({1, 1, 0.1}, 1);
};

using Graph = ReachGraph::Impl;

/// Reads a kept graph after its checksum was checked and it was inflated. kept_graph() builds a graph again if it gets
/// any exception, so any is right.
void read_graph(const fs::path& file, const GraphPlace& place)
{
    try {
        const ReachGraph graph(
            std::make_shared<const Graph>(place.judge, place.options, Graph::Keep::Ways, read_file(file)));
        graph.places();
        graph.islands();
        PathSearch(graph).path(place.start, place.goal);
    } catch (const std::exception& error) {
        throw FileError(file.string(), error.what());
    }
}

}  // namespace

std::vector<Reader> map_readers(const fs::path& source)
{
    const auto stored = std::make_shared<const StoredMap>(source);
    return {{"tiles", {".geometry", ".bounds"}, [=](const fs::path& file) { read_tiled(file, stored->robot); }},
            {"maps", {".yaml", ".tiff", ".bt"}, [=](const fs::path& file) { read_map_file(file, *stored); }},
            {"graphs", {".bin"}, [=](const fs::path& file) {
                 static const GraphPlace place(*stored);
                 read_graph(file, place);
             }}};
}

std::string graph_bytes(const fs::path& source)
{
    const StoredMap stored(source);
    const GraphPlace place(stored);
    return Graph(place.judge, place.options, Graph::Keep::Ways).bytes();
}

}  // namespace fuzz
