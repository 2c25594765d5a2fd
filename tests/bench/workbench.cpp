#include "workbench.h"

#include "../random_scene.h"
#include "digest.h"
#include "hills.h"
#include "base/stopwatch.h"

#include <numbers>
#include <numeric>
#include <tuple>

using namespace spawnfield;

namespace bench {
namespace {

template <class Result>
struct Timed {
    double seconds;
    Result result;
};

template <class Work>
auto timed(const Work& work)
{
    Stopwatch watch;
    auto result = work();
    const double seconds = watch.lap();
    return Timed<decltype(result)>{seconds, std::move(result)};
}

Robot husky_box() { return load_robot("box:0.99,0.67,0.39"); }

Scene training_scene() { return load_scene(SPAWNFIELD_SOURCE "/maps/training/scene.yaml"); }

std::uint64_t elements(const Scene& scene) { return scene.triangles.size() + scene.primitives.size(); }

std::uint64_t cells(const GridFrame& frame) { return std::uint64_t(frame.rows) * std::uint64_t(frame.cols); }

std::uint64_t total(const VerdictCounts& counts) { return std::accumulate(counts.begin(), counts.end(), std::uint64_t{0}); }

/// Up to 1 m above a random layer of a random column.
std::vector<Pose> poses_near_ground(const Map& map, std::size_t count)
{
    Random random(17);
    std::vector<Pose> poses;
    while (poses.size() < count) {
        const double x = random.between(map.bounds.min.x(), map.bounds.max.x()), y = random.between(map.bounds.min.y(), map.bounds.max.y());
        const std::vector<double> layers = column_at(map.geometry, x, y).layers;
        if (layers.empty()) continue;
        const double z = layers[random.below(int(layers.size()))] + random.between(0, 1);
        poses.push_back({{x, y, z}, rotation_from_rpy(0, 0, random.between(-std::numbers::pi, std::numbers::pi))});
    }
    return poses;
}

Setting training_setting(Extent extent)
{
    Setting out{.name = "training", .make = training_scene, .cell = 0.05, .step = 0.1, .step_3d = 0.2, .poses = 20000};
    out.sample_distance = 0.1;
    out.search_distance = 0.1;
    if (extent == Extent::Quick) {
        out.cell = 0.25;
        out.step = 0.5;
        out.step_3d = 1;
        out.poses = 1000;
        out.samples = out.finds = 50;
    }
    return out;
}

Setting hills_setting(Extent extent)
{
    Setting out{.name = "hills", .make = [] { return hills_scene(); }};
    if (extent == Extent::Full) {
        out.cell = 0.1;
        out.step = out.step_3d = 0.5;
    }
    if (extent == Extent::Quick) {
        out.make = [] { return small_hills_scene(); };
        out.cell = 2;
        out.step = out.step_3d = 4;
        out.poses = 1000;
        out.samples = out.finds = 20;
    }
    return out;
}

}  // namespace

std::vector<Setting> settings(Extent extent) { return {training_setting(extent), hills_setting(extent)}; }

Workbench::Workbench(const Setting& setting) : setting_(setting) {}

std::vector<Workbench::Stage> Workbench::stages()
{
    std::vector<Stage> out = {
        {"make", false, [this](int) { return make(); }},
        {"geometry", true, [this](int threads) { return geometry(threads); }},
        {"terrain", true, [this](int threads) { return terrain(threads); }},
        {"occupancy", true, [this](int threads) { return occupancy(threads); }},
        {"bake", true, [this](int threads) { return bake(threads); }},
        {"read_map", false, [this](int) { return read_map(); }},
    };
    for (const auto& [name, offset] : {std::pair{"raster2d@0.1", 0.1}, std::pair{"raster2d@0.3", 0.3}, std::pair{"raster2d@1.0", 1.0}})
        out.push_back({name, true, [this, above = offset](int threads) { return raster_2d(above, threads); }});
    out.push_back({"raster3d", true, [this](int threads) { return raster_3d(threads); }});
    out.push_back({"check", true, [this](int threads) { return check(threads); }});
    out.push_back({"sample", true, [this](int threads) { return sample(threads); }});
    out.push_back({"search", true, [this](int threads) { return search(threads); }});
    return out;
}

BakeReport Workbench::bake_into(const std::filesystem::path& folder, Scene scene, int threads) const
{
    const std::filesystem::path source = folder_.write("scene.txt", setting_.name + " of spawnfield_bench\n");
    BakeOptions options;
    options.resolution = setting_.cell;
    options.threads = threads;
    return spawnfield::bake(std::move(scene), source, folder, options);
}

const Map& Workbench::map()
{
    if (!map_) {
        map_.emplace();
        map_->name = setting_.name;
        scene_ = setting_.make();
        map_->bounds = scene_.bounds();
        map_->geometry = Geometry(scene_);
        map_->resolution = setting_.cell;
        const double size = (map_->bounds.max - map_->bounds.min).head<2>().maxCoeff();
        map_->layers = rasterize_terrain(map_->geometry, frame_around(map_->bounds, size / 256)).layers();
    }
    return *map_;
}

const CollisionChecker& Workbench::checker()
{
    if (!checker_) checker_.emplace(map().geometry, husky_box());
    return *checker_;
}

const std::vector<Pose>& Workbench::poses()
{
    if (poses_.empty()) poses_ = poses_near_ground(map(), setting_.poses);
    return poses_;
}

Measurement Workbench::make() const
{
    const auto made = timed(setting_.make);
    return {elements(made.result), made.seconds, digest_of(made.result)};
}

Measurement Workbench::geometry(int threads)
{
    map();
    const auto built = timed([&] { return Geometry(scene_, threads); });
    return {elements(scene_), built.seconds, digest_of(built.result)};
}

Measurement Workbench::terrain(int threads)
{
    const GridFrame frame = frame_around(map().bounds, setting_.cell);
    const auto terrain = timed([&] { return rasterize_terrain(map().geometry, frame, threads); });
    return {cells(frame), terrain.seconds, digest_of(terrain.result)};
}

Measurement Workbench::occupancy(int threads)
{
    const double voxel = 2.5 * setting_.cell;
    const Bounds& bounds = map().bounds;
    const auto tree = timed([&] { return build_occupancy(map().geometry, bounds, voxel, threads); });
    tree.result.write(folder_ / "occupancy.bt");
    return {cells(frame_around(bounds, voxel)), tree.seconds, Digest().add(bytes_of(folder_ / "occupancy.bt")).value()};
}

Measurement Workbench::bake(int threads)
{
    map();
    Scene scene = scene_;
    const auto report = timed([&] { return bake_into(folder_ / "map", std::move(scene), threads); });
    return {cells(frame_around(map().bounds, setting_.cell)), report.seconds, Digest().add(report.result.hash).value()};
}

Measurement Workbench::read_map()
{
    if (!std::filesystem::exists(folder_ / "map")) bake(0);
    const auto read = timed([&] { return spawnfield::read_map(folder_ / "map"); });
    return {read.result.geometry.element_count(), read.seconds, digest_of(read.result.geometry)};
}

Measurement Workbench::raster(const RasterOptions& options)
{
    const CollisionChecker& ready = checker();
    const auto result = timed([&] { return spawnfield::raster(map(), ready, options); });
    return {total(result.result.counts), result.seconds, digest_of(result.result)};
}

Measurement Workbench::raster_2d(double offset, int threads)
{
    RasterOptions options;
    options.step = setting_.step;
    options.offset = offset;
    options.threads = threads;
    return raster(options);
}

Measurement Workbench::raster_3d(int threads)
{
    RasterOptions options;
    options.dims = 3;
    options.step = setting_.step_3d;
    options.threads = threads;
    return raster(options);
}

Measurement Workbench::check(int threads)
{
    QueryOptions options;
    options.threads = threads;
    const CollisionChecker& ready = checker();
    const std::vector<Pose>& asked = poses();
    const auto judged = timed([&] { return check_poses(map(), ready, asked, options); });
    return {asked.size(), judged.seconds, digest_of(judged.result)};
}

Measurement Workbench::sample(int threads)
{
    SampleOptions options;
    options.count = setting_.samples;
    options.min_distance = setting_.sample_distance;
    options.random_yaw = true;
    options.threads = threads;
    const CollisionChecker& ready = checker();
    const auto list = timed([&] { return spawnfield::sample(map(), ready, options); });
    return {list.result.draws, list.seconds, digest_of(list.result)};
}

Measurement Workbench::search(int threads)
{
    SearchOptions options;
    options.count = setting_.finds;
    options.min_distance = setting_.search_distance;
    options.random_yaw = true;
    options.threads = threads;
    const CollisionChecker& ready = checker();
    const auto list = timed([&] { return spawnfield::search(map(), ready, options); });
    return {list.result.draws, list.seconds, digest_of(list.result)};
}

}  // namespace bench
