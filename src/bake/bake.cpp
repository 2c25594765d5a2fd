#include "bake/earlier_map.h"
#include "base/checksum.h"
#include "base/chosen_bounds.h"
#include "base/input_file.h"
#include "base/number.h"
#include "base/parallel.h"
#include "base/png.h"
#include "base/stopwatch.h"
#include "free_space/changed_bounds.h"
#include "map/bounds_file.h"
#include "map/changed_occupancy.h"
#include "map/changed_terrain.h"
#include "map/geometry_file.h"
#include "map/map_yaml.h"
#include "map/terrain_file.h"

#include <spawnfield/bake.h>
#include <spawnfield/error.h>
#include <spawnfield/heatmap.h>
#include <spawnfield/input_file.h>
#include <spawnfield/memory.h>
#include <spawnfield/output_folder.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <regex>

namespace spawnfield {
namespace {

namespace fs = std::filesystem;

/// Returns why a folder cannot be replaced by a map; an empty text if it is a map. The content of map.yaml decides,
/// because nav2's map server uses that name too.
std::string objection_to(const fs::path& folder)
{
    const fs::path file = folder / "map.yaml";
    const bool is_map = is_file(file) && read_file(file).starts_with("format: spawnfield-map/");
    return is_map ? "" : "exists and is not a map";
}

/// Returns whether a file of an old map's folder goes to the new one: files that do not belong to the map, which users
/// put there. Drivable graphs of maps with another hash than the new one are left out.
bool is_kept(const fs::path& name, const std::string& hash)
{
    static const std::regex graph_file("reach-([0-9a-f]{16})-[0-9a-f]{16}\\.bin");  // as kept_graph_file() names it
    if (name == "map.yaml" || std::find(map_files.begin(), map_files.end(), name) != map_files.end()) return false;
    std::smatch found;
    return !std::regex_match(name.native(), found, graph_file) || found[1] == hash;
}

double default_resolution(const Bounds& bounds, BakeReport& report)
{
    constexpr double usual_extent = 20000;  // m; a larger world is most likely in wrong units: not worth much memory
    const double extent = (bounds.max - bounds.min).head<2>().maxCoeff();
    const double most = extent > usual_extent ? max_columns / 4 : max_columns;
    double resolution = 0.1;
    const auto side = [&](int axis) { return std::ceil((bounds.max[axis] - bounds.min[axis]) / resolution); };
    while (side(0) * side(1) > most || std::max(side(0), side(1)) > max_side) resolution *= 2;
    if (resolution > 0.1)
        report.notices.push_back("resolution is " + number(resolution) + " m, because 0.1 m would give more than " +
                                 std::to_string(std::int64_t(most / 1e6)) +
                                 " million columns, or more than a million along one side; "
                                 "--resolution sets it");
    return resolution;
}

double default_occupancy_resolution(const Bounds& bounds, double resolution, BakeReport& report)
{
    const double wanted = 2.5 * resolution;
    double voxel = wanted;
    const double size = (bounds.max - bounds.min).maxCoeff();
    while (size / voxel > 65000) voxel *= 2;
    if (voxel > wanted)
        report.notices.push_back("occupancy resolution is " + number(voxel) +
                                 " m, because OctoMap has 65536 voxels along each axis and the map is " +
                                 rounded(size) + " m long; --occupancy-resolution sets it");
    return voxel;
}

/// Writes a 16-bit image of the top layer. Pixel 0 means no layer; pixels 1 .. 65535 are the heights from the lowest to
/// the highest, in equal steps. Returns the heights of pixels 0 (one step below the lowest) and 65535, m: the two
/// limits that a scene file needs as `heightmap: {z: [LOW, HIGH]}` to read the image.
std::pair<double, double> write_heightmap_png(const HeightImage& top, const fs::path& file)
{
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const float z : top.values)
        if (!std::isnan(z)) {
            low = std::min(low, double(z));
            high = std::max(high, double(z));
        }
    if (!(low <= high)) low = high = 0;
    const double step = high > low ? (high - low) / 65534 : 1e-3;
    std::vector<std::uint16_t> pixels(top.values.size());
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        const float z = top.values[i];
        pixels[i] = std::isnan(z) ? std::uint16_t(0) : std::uint16_t((z - low) / step + 1.5);
    }
    write_grey_png(file, top.rows, top.cols, pixels.data());
    return {low - step, low + 65534 * step};
}

/// Returns the progress function of one stage, during which the progress of the whole grows from `from` to `to`.
Progress part_of(const Progress& progress, double from, double to)
{
    if (!progress) return {};
    return [=](double share) { progress(from + share * (to - from)); };
}

/// What the files of a map contain that map.yaml lists, and the numbers for the report.
struct WrittenFiles {
    ListedFile bounds, geometry;
    int layers = 0;
    std::pair<double, double> heightmap_z;  ///< see write_heightmap_png
    std::size_t occupancy_leaves = 0;
    std::vector<std::pair<std::string, double>> seconds;  ///< of each stage; they overlap, so their sum is longer
};

std::size_t write_occupancy_of(const Map& map, const EarlierMap* earlier, const fs::path& file, int threads,
                               const Progress& progress)
{
    if (earlier == nullptr)
        return write_occupancy(file, map.geometry, map.bounds, map.occupancy_resolution, threads, progress);
    check_listed(earlier->map.folder, "occupancy.bt");
    return write_changed_occupancy(file, earlier->map.folder / "occupancy.bt", map.geometry, map.bounds,
                                   map.occupancy_resolution, earlier->boxes, threads);
}

/// Writes all files but map.yaml, several at the same time: most of them occupy only one core. `earlier` is nullptr for
/// a full bake.
WrittenFiles write_files(const Map& map, const TerrainMap& terrain, const EarlierMap* earlier, const fs::path& folder,
                         int threads, const Progress& progress)
{
    WrittenFiles out;
    const auto occupancy = [&] {
        out.occupancy_leaves = write_occupancy_of(map, earlier, folder / "occupancy.bt", threads, progress);
    };
    const auto heightmap = [&] {
        out.layers = count_layers(terrain);
        if (earlier != nullptr && has_same_tiles(terrain, earlier->terrain, "height.0")) {
            copy_heightmap(earlier->map, folder / "heightmap.png");
            out.heightmap_z = earlier->heightmap_z;
            return;
        }
        const HeightImage top = page_image(terrain, "height.0");
        out.heightmap_z = write_heightmap_png(top, folder / "heightmap.png");
    };
    const std::array<std::pair<const char*, std::function<void()>>, 6> stages{{
        {"write", [&] { out.bounds = write_bounds(folder / "bounds.bin", map.solid_bounds); }},
        {"occupancy", occupancy},
        {"images", [&] { write_terrain(folder / "terrain.tiff", terrain); }},
        {"images", [&] { write_preview(map, terrain, folder / "preview.png"); }},
        {"images", heightmap},
        {"write", [&] { out.geometry = write_geometry(folder / "geometry.bin", map.geometry); }},
    }};
    out.seconds.resize(stages.size());
    parallel_for(stages.size(), threads, {}, [&](std::size_t i) {
        Stopwatch watch;
        stages[i].second();
        out.seconds[i] = {stages[i].first, watch.lap()};
    });
    return out;
}

/// Throws MemoryError if a bake most likely needs more memory than it may have.
void check_memory(const Scene& scene, const Map& map, double limit)
{
    // Measured: the largest resident memory of bakes of boxes, elevation models, buildings and a city.
    constexpr double program = 80e6, per_triangle = 300, per_column = 20;  // bytes
    const Vec3 size = map.bounds.max - map.bounds.min;
    frame_around(map.bounds, map.resolution);  // refuses too many cells, whatever the limit is
    require_cell_memory({program + per_triangle * double(scene.triangles.size()), per_column}, "--resolution",
                        map.resolution, size.x() * size.y(), limit);
}

/// Checks the options. Returns a map with its names, bounds and resolutions, but without geometry, layers and floors.
/// `function` is the name in error messages. For a scene that cannot become a map, it calls refuse(reason), which must
/// throw.
Map plan_map(const char* function, const Scene& scene, const BakeOptions& options, BakeReport& report,
             const std::function<void(const std::string&)>& refuse)
{
    if (!options.allow_no_terrain && !scene.has_terrain())
        refuse(
            "has no terrain, so no robot can stand anywhere; label a part `terrain` (--label 'GLOB=terrain') "
            "or pass --allow-no-terrain");
    if (!(options.resolution >= 0))
        throw ArgumentError(function, "resolution", options.resolution, "> 0 m (0: chosen)");
    if (!(options.z.low <= options.z.high)) throw ArgumentError(function, "z.high", options.z.high, "at least z.low");
    if (!(options.occupancy_resolution >= 0))
        throw ArgumentError(function, "occupancy_resolution", options.occupancy_resolution, "> 0 m (0: chosen)");
    Map map;
    map.name = scene.name;
    const Bounds extent = scene.map_bounds.is_empty() ? scene.bounds() : scene.map_bounds;
    map.bounds = chosen_bounds(function, options.bounds, extent);
    map.z_limits = !options.z.is_unlimited() ? options.z : options.bounds.is_empty() ? ZRange{} : map.bounds.z();
    if (std::isfinite(map.z_limits.low)) map.bounds.min.z() = map.z_limits.low;
    if (std::isfinite(map.z_limits.high)) map.bounds.max.z() = map.z_limits.high;
    if (!map.bounds.meets(extent))
        refuse("bounds are " + to_string(map.bounds) + ", need to meet the scene: " + to_string(extent));
    const Vec3 size = map.bounds.max - map.bounds.min;
    constexpr double tiny = 1 + 1e-9;  // m; such a small scene probably has a wrong unit or lacks parts
    if (options.bounds.is_empty() && size.x() <= tiny && size.y() <= tiny)
        report.notices.push_back("the map is only " + number(size.x()) + " x " + number(size.y()) +
                                 " m; is a part of the scene missing or in the wrong unit?");
    map.origin = scene.origin;
    map.is_unlabelled = scene.is_unlabelled;
    map.resolution = options.resolution > 0 ? options.resolution : default_resolution(map.bounds, report);
    map.occupancy_resolution = options.occupancy_resolution > 0
                                   ? options.occupancy_resolution
                                   : default_occupancy_resolution(map.bounds, map.resolution, report);
    map.occupancy_origin = occupancy_origin(map.bounds, map.occupancy_resolution);
    check_memory(scene, map, options.max_memory);
    return map;
}

}  // namespace

Map make_map(const Scene& scene, const BakeOptions& options)
{
    BakeReport report;
    Map map = plan_map("make_map", scene, options, report,
                       [](const std::string& what) { throw ArgumentError("make_map", "the scene " + what); });
    map.geometry = Geometry(scene, options.threads);
    const TerrainMap terrain = rasterize_terrain(map.geometry, frame_around(map.bounds, map.resolution),
                                                 options.threads, part_of(options.progress, 0, 0.5), map.z_limits);
    map.floors = find_floors(terrain, options.threads);
    map.layers = count_layers(terrain);
    map.solid_bounds = SolidBounds(map.geometry, map.bounds, map.resolution, options.threads,
                                   part_of(options.progress, 0.5, 1));
    return map;
}

namespace {

/// Bakes in full if `changed_parts` is nullptr.
BakeReport bake_scene(Scene scene, const fs::path& scene_file, const fs::path& folder, const BakeOptions& options,
                      const std::vector<std::string>* changed_parts)
{
    BakeReport report;
    Stopwatch watch;
    const auto lap = [&](const char* stage) { report.seconds.emplace_back(stage, watch.lap()); };
    Map map = plan_map("bake", scene, options, report, [&](const std::string& what) {
        throw FileError(scene_file.empty() ? "the scene" : scene_file.string(), what);
    });
    if (map.name.empty()) map.name = scene_file.stem().string();
    map.scene_file = scene_file.empty() ? "(memory)" : scene_file.filename().string();
    map.scene_hash = checksum(scene_file.empty() ? std::string() : read_file(scene_file));
    const GridFrame frame = frame_around(map.bounds, map.resolution);
    OutputFolder target(folder, objection_to);
    map.geometry = Geometry(scene, options.threads);
    const bool has_terrain = scene.has_terrain();
    const Bounds extent = scene.bounds();
    scene = {};
    lap("geometry");
    EarlierState state;
    if (changed_parts != nullptr) {
        state = earlier_state(folder, scene_file, map, *changed_parts, options);
        if (!state.map) report.notices.push_back("the map is baked in full, because " + state.why_not);
        lap("compare");
    }
    const EarlierMap* const earlier = state.map ? &*state.map : nullptr;
    const TerrainMap terrain = earlier ? changed_terrain(earlier->terrain, map.geometry, earlier->boxes, map.z_limits,
                                                         options.threads)
                                       : rasterize_terrain(map.geometry, frame, options.threads,
                                                           part_of(options.progress, 0, 0.3), map.z_limits);
    map.floors = find_floors(terrain, options.threads);
    lap("terrain");
    map.solid_bounds = earlier ? made_bounds(changed_bounds(earlier->map.solid_bounds, map.geometry, map.bounds,
                                                            earlier->boxes),
                                             options.threads)
                               : SolidBounds(map.geometry, map.bounds, map.resolution, options.threads,
                                             part_of(options.progress, 0.3, 0.6));
    lap("bounds");
    const WrittenFiles files = write_files(map, terrain, earlier, target.path(), options.threads,
                                           part_of(options.progress, 0.6, 0.9));
    map.layers = files.layers;
    report.occupancy_leaves = files.occupancy_leaves;
    report.seconds.insert(report.seconds.end(), files.seconds.begin(), files.seconds.end());
    if (map.layers == 0 && has_terrain)
        report.notices.push_back("no robot can stand in the bounds " + to_string(map.bounds) +
                                 ": there is no terrain at any cell's centre; the scene is " + to_string(extent));
    watch.lap();
    report.hash = write_map_yaml(target.path(), map, terrain, files.heightmap_z, {files.bounds, files.geometry});
    if (options.progress) options.progress(1);
    for (const auto& entry : fs::directory_iterator(target.path())) report.bytes += entry.file_size();
    target.commit([&](const fs::path& name) { return is_kept(name, report.hash); });
    report.notices.insert(report.notices.end(), target.notices().begin(), target.notices().end());
    report.layers = map.layers;
    lap("write");
    return report;
}

}  // namespace

BakeReport bake(Scene scene, const fs::path& scene_file, const fs::path& folder, const BakeOptions& options)
{
    return bake_scene(std::move(scene), scene_file, folder, options, nullptr);
}

BakeReport update_map(Scene scene, const fs::path& scene_file, const fs::path& folder,
                      const std::vector<std::string>& changed_parts, const BakeOptions& options)
{
    return bake_scene(std::move(scene), scene_file, folder, options, &changed_parts);
}

}  // namespace spawnfield
