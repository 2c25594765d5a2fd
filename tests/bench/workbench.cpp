#include "workbench.h"

#include "../random_scene.h"
#include "digest.h"
#include "query/raster_grid.h"
#include "timed.h"
#include "world.h"

#include <spawnfield/headings.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

using namespace spawnfield;

namespace bench {
namespace {

std::uint64_t elements(const Scene& scene) { return scene.triangles.size() + scene.primitives.size(); }

std::uint64_t cells(const GridFrame& frame) { return std::uint64_t(frame.rows) * std::uint64_t(frame.cols); }

template <class Options>
Options with_threads(Options options, int threads)
{
    options.threads = threads;
    return options;
}

/// Returns poses that are up to 1 m above a random layer of a random column.
std::vector<Pose> poses_near_ground(const Map& map, std::size_t count)
{
    Random random(17);
    std::vector<Pose> poses;
    while (poses.size() < count) {
        const double x = random.between(map.bounds.min.x(), map.bounds.max.x()),
                     y = random.between(map.bounds.min.y(), map.bounds.max.y());
        const std::vector<double> layers = column_at(map.geometry, x, y).layers;
        if (layers.empty()) continue;
        const double z = layers[random.below(int(layers.size()))] + random.between(0, 1);
        poses.push_back({{x, y, z}, rotation_from_rpy(0, 0, random.between(-std::numbers::pi, std::numbers::pi))});
    }
    return poses;
}

/// Returns an agent with the circle around the robot. Its climb and slope are as large as its level underside can stay
/// clear of the ground.
Walker walker_of(const Robot& robot, double offset)
{
    const Bounds bounds = robot.bounds();
    Walker out;
    out.radius = bounds.min.head<2>().cwiseAbs().cwiseMax(bounds.max.head<2>().cwiseAbs()).norm();
    out.height = bounds.max.z() + offset;
    out.climb = offset;
    out.slope = std::atan(offset / out.radius);
    return out;
}

}  // namespace

bool has_top_raster(const Setting& setting)
{
    return std::any_of(setting.rasters.begin(), setting.rasters.end(),
                       [&](const RasterWork& work) { return is_top_raster(setting, work); });
}

Workbench::Workbench(const Setting& setting) : setting_(setting) {}

// ---- Stages ----

std::vector<Workbench::Stage> Workbench::stages()
{
    std::vector<Stage> out;
    if (elements(scene()) > 0) out.push_back({"make", false, [this](int) { return make(); }});
    if (setting_.has_ground) add_bakes(out);
    add_rasters(out);
    if (setting_.has_ground) add_spawns(out);
    add_set_ups(out);
    return out;
}

void Workbench::add_bakes(std::vector<Stage>& out)
{
    out.push_back({"geometry", true, [this](int threads) { return geometry(threads); }});
    out.push_back({"terrain", true, [this](int threads) { return terrain(threads); }});
    out.push_back({"occupancy", true, [this](int threads) { return occupancy(threads); }});
    out.push_back({"bake", true, [this](int threads) { return bake(threads); }});
    out.push_back({"read_map", false, [this](int) { return read_map(); }});
}

template <class Make>
Measurement Workbench::rival_raster_2d(const RasterWork& work, const Make& make)
{
    const RasterGrid grid = raster_grid(map().bounds, options_2d(work));
    const auto judged = timed([&] { return make(grid); });
    Digest digest;
    std::uint64_t count = 0;
    for (const auto& pose : judged.result) {
        if (!pose) continue;
        ++count;
        digest.add(pose->z).add(pose->verdict);
    }
    return {count, judged.seconds, digest.value(), count};
}

/// Adds the alternatives that answer a raster of top layers.
void Workbench::add_top_rivals(const RasterWork& work, Stage& stage)
{
    const auto add = [&](const char* name, const auto& peer, auto... how) {
        stage.rivals.push_back({name, [this, work, peer, how...](int threads) {
                                    const auto& ready = peer();  // is built before the clock starts
                                    return rival_raster_2d(work, [&](const RasterGrid& grid) {
                                        return ready.raster_top(grid, work.offset, threads, how...);
                                    });
                                }});
    };
    if (has_plain_fcl()) add("fcl", [this]() -> const PlainFcl& { return plain_fcl(); });
    if (!has_embree_only()) return;
    const auto embree = [this]() -> const EmbreeOnly& { return embree_only(); };
    add("embree", embree, EmbreeOnly::Search::OurOwn);
    add("embree-query", embree, EmbreeOnly::Search::PointQuery);
}

/// Adds a raster at several headings, and beside it the same raster at one heading.
void Workbench::add_headings(const RasterWork& work, std::vector<Stage>& out)
{
    const auto run = [&](int headings) {
        return [this, options = options_2d(work), headings](int threads) {
            return raster_headings(with_threads(options, threads), headings);
        };
    };
    out.push_back({work.name, true, run(work.headings)});
    out.back().rivals.push_back({"one-heading", run(1)});
}

void Workbench::add_rasters(std::vector<Stage>& out)
{
    const auto stage = [this](const std::string& name, const RasterOptions& options) {
        Stage made{name, true,
                   [this, options](int threads) { return raster(judge(), with_threads(options, threads)); }};
        made.rivals.push_back(
            {"exhaustive",
             [this, options](int threads) { return raster(exhaustive_judge(), with_threads(options, threads)); },
             true});
        return made;
    };
    for (const RasterWork& work : setting_.rasters) {
        if (work.headings > 1) {
            add_headings(work, out);
            continue;
        }
        out.push_back(stage(work.name, options_2d(work)));
        if (is_top_raster(work)) add_top_rivals(work, out.back());
    }
    out.push_back(stage("raster3d", options_3d()));
    if (has_plain_fcl()) out.back().rivals.push_back({"fcl", [this](int threads) { return fcl_raster_3d(threads); }});
}

void Workbench::add_spawns(std::vector<Stage>& out)
{
    out.push_back({"check", true, [this](int threads) { return check(judge(), threads); }});
    out.back().rivals.push_back(
        {"exhaustive", [this](int threads) { return check(exhaustive_judge(), threads); }, true});
    if (has_plain_fcl()) out.back().rivals.push_back({"fcl", [this](int threads) { return fcl_check(threads); }});
    out.push_back(
        {"sample", true, [this](int threads) { return sample(judge(), with_threads(sample_options(), threads)); }});
    out.back().rivals.push_back({"exhaustive", [this](int threads) {
                                     return sample(exhaustive_judge(), with_threads(sample_options(), threads));
                                 }});
    if (has_nav_mesh()) out.back().rivals.push_back({"recast", [this](int) { return nav_draw(); }});
    out.push_back(
        {"search", true, [this](int threads) { return search(judge(), with_threads(search_options(), threads)); }});
    out.back().rivals.push_back(
        {"exhaustive",
         [this](int threads) { return search(exhaustive_judge(), with_threads(search_options(), threads)); }, true});
}

/// Adds stages for the time that the alternatives need before their first answer.
void Workbench::add_set_ups(std::vector<Stage>& out)
{
    if (has_plain_fcl() && elements(scene()) > 0)
        out.push_back({"fcl set-up", false, [this](int) {
                           const auto made = timed(
                               [&] { return std::make_unique<PlainFcl>(scene(), setting_.robot()); });
                           return Measurement{elements(scene()), made.seconds, 0};
                       }});
    if (has_embree_only())
        out.push_back({"embree set-up", false, [this](int) {
                           TriangleScene triangles = triangle_scene_of(scene(), map().bounds);
                           const auto made = timed([&] {
                               return std::make_unique<EmbreeOnly>(std::move(triangles), setting_.robot(),
                                                                   EmbreeOnly::Use::Often);
                           });
                           return Measurement{elements(scene()), made.seconds, 0};
                       }});
    if (has_nav_mesh())
        out.push_back(
            {"recast set-up", false, [this](int) {
                 const auto made = timed(
                     [&] { return std::make_unique<NavMesh>(scene(), walker_of(setting_.robot(), 0.1)); });
                 return Measurement{elements(scene()), made.seconds, Digest().add(made.result->polygons()).value()};
             }});
}

namespace {

/// Returns the bytes that a run needs in addition to what this process used before.
std::uint64_t memory_of(const std::function<void()>& run)
{
    reset_peak_memory();
    const std::uint64_t before = peak_memory_bytes();
    run();
    return peak_memory_bytes() - std::min(before, peak_memory_bytes());
}

}  // namespace

std::vector<Row> run_in_turns(const std::string& scene, const Workbench::Stage& stage, int threads, Rounds rounds)
{
    constexpr double long_run = 10, short_rounds = 5;  // s
    std::vector<Workbench::Rival> contestants = {{stage.name, stage.run, true}};
    for (const Workbench::Rival& rival : stage.rivals)
        contestants.push_back({stage.name + " " + rival.name, rival.run, rival.has_same_result});
    std::vector<Measurement> untimed(contestants.size());
    const std::uint64_t memory = memory_of([&] { untimed[0] = contestants[0].run(threads); });
    for (std::size_t i = 1; i < contestants.size(); ++i) untimed[i] = contestants[i].run(threads);
    reset_peak_memory();
    std::vector<std::vector<Measurement>> measured(contestants.size());
    double taken = 0;  // s
    Stopwatch watch;
    for (int round = 0; round < rounds.least || (round < rounds.most && taken < short_rounds); ++round) {
        for (std::size_t i = 0; i < contestants.size(); ++i)
            if (untimed[i].seconds < long_run) measured[i].push_back(contestants[i].run(threads));
        taken += watch.lap();
    }
    std::vector<Row> rows;
    for (std::size_t i = 0; i < contestants.size(); ++i) {
        if (measured[i].empty()) measured[i] = {untimed[i]};
        rows.push_back(row_of(scene, contestants[i].name, threads, measured[i]));
        if (contestants[i].has_same_result && rows[i].hash != rows[0].hash)
            throw std::runtime_error(scene + " " + rows[i].stage + " gave another result than " + rows[0].stage);
    }
    rows[0].own_memory = memory;
    return rows;
}

// ---- Data of the stages ----

BakeReport Workbench::bake_into(const std::filesystem::path& folder, Scene made, int threads) const
{
    const std::filesystem::path source = folder_.write("scene.txt", setting_.name + " of spawnfield_bench\n");
    return spawnfield::bake(std::move(made), source, folder,
                            {.resolution = setting_.cell,
                             .bounds = setting_.bounds,
                             .allow_no_terrain = !setting_.has_ground,
                             .threads = threads});
}

const Scene& Workbench::scene()
{
    if (!scene_) scene_ = setting_.make();
    return *scene_;
}

const Map& Workbench::map()
{
    if (!map_) map_ = map_of(scene(), setting_.bounds, setting_.cell);
    return *map_;
}

const Judge& Workbench::judge()
{
    if (!judge_) judge_.emplace(map(), setting_.robot());
    return *judge_;
}

const Judge& Workbench::exhaustive_judge()
{
    if (!exhaustive_judge_) exhaustive_judge_.emplace(map(), setting_.robot(), JudgeOptions{.exhaustive = true});
    return *exhaustive_judge_;
}

const PlainFcl& Workbench::plain_fcl()
{
    if (!plain_fcl_) plain_fcl_ = std::make_unique<PlainFcl>(scene(), setting_.robot());
    return *plain_fcl_;
}

const NavMesh& Workbench::nav_mesh()
{
    if (!nav_mesh_) nav_mesh_ = std::make_unique<NavMesh>(scene(), walker_of(setting_.robot(), 0.1));
    return *nav_mesh_;
}

bool Workbench::has_embree_only() const
{
    return setting_.has_rivals && has_top_raster(setting_) && EmbreeOnly::is_available();
}

const EmbreeOnly& Workbench::embree_only()
{
    if (!embree_only_)
        embree_only_ = std::make_unique<EmbreeOnly>(triangle_scene_of(scene(), map().bounds), setting_.robot(),
                                                    EmbreeOnly::Use::Often);
    return *embree_only_;
}

const std::vector<Pose>& Workbench::poses()
{
    if (poses_.empty()) poses_ = poses_near_ground(map(), setting_.poses);
    return poses_;
}

// ---- spawnfield ----

Measurement Workbench::make() const
{
    const auto made = timed(setting_.make);
    return {elements(made.result), made.seconds, digest_of(made.result)};
}

Measurement Workbench::geometry(int threads)
{
    const auto built = timed([&, &from = scene()] { return Geometry(from, threads); });
    return {elements(scene()), built.seconds, digest_of(built.result)};
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
    const auto tree = timed(
        [&, &ready = map()] { return build_occupancy(ready.geometry, ready.bounds, voxel, threads); });
    tree.result.write(folder_ / "occupancy.bt");
    return {cells(frame_around(map().bounds, voxel)), tree.seconds,
            Digest().add(bytes_of(folder_ / "occupancy.bt")).value()};
}

Measurement Workbench::bake(int threads)
{
    Scene copy = scene();
    const auto report = timed([&] { return bake_into(folder_ / "map", std::move(copy), threads); });
    return {cells(frame_around(map().bounds, setting_.cell)), report.seconds, Digest().add(report.result.hash).value()};
}

Measurement Workbench::read_map()
{
    if (!std::filesystem::exists(folder_ / "map")) bake(0);
    const auto read = timed([&] { return spawnfield::read_map(folder_ / "map"); });
    return {elements(scene()), read.seconds, digest_of(read.result.geometry)};
}

RasterOptions Workbench::options_2d(const RasterWork& work) const
{
    RasterOptions out{.step = work.step, .stance = work.stance, .layers = work.layers};
    if (work.stance == Stance::Level) out.offset = work.offset;
    return out;
}

RasterOptions Workbench::options_3d() const
{
    return {.dims = 3, .step = setting_.step_3d, .height_check = setting_.height_check};
}

RasterOptions Workbench::thinned_options_3d() const
{
    RasterOptions options = options_3d();
    options.step_z = options.step;
    options.step *= setting_.thinning;
    return options;
}

SampleOptions Workbench::sample_options() const
{
    return {.count = setting_.samples,
            .min_distance = setting_.sample_distance,
            .random_yaw = true,
            .stance = Stance::Level};
}

SearchOptions Workbench::search_options() const
{
    return {.count = setting_.finds, .min_distance = setting_.search_distance, .random_yaw = true};
}

Measurement Workbench::raster(const Judge& judge, const RasterOptions& options)
{
    const auto result = timed([&] { return spawnfield::raster(judge, options); });
    return {result.result.counts.total(), result.seconds, digest_of(result.result), result.result.exact_checks};
}

Measurement Workbench::raster_headings(const RasterOptions& options, int headings)
{
    const Judge& ready = judge();
    if (headings == 1) return raster(ready, options);
    const auto result = timed([&] { return raster_at_headings(ready, options, headings); });
    const HeadingRaster& made = result.result;
    return {made.raster.poses.size() * std::uint64_t(headings), result.seconds,
            Digest().add(digest_of(made.raster)).add_all(made.valid_headings).value(), made.raster.exact_checks};
}

Measurement Workbench::check(const Judge& judge, int threads)
{
    const std::vector<Pose>& asked = poses();
    const auto judged = timed([&] { return judge.check(asked, {.threads = threads}); });
    const auto exact = std::count_if(judged.result.begin(), judged.result.end(),
                                     [](const Judgement& j) { return j.exact_check; });
    return {asked.size(), judged.seconds, digest_of(judged.result), std::uint64_t(exact)};
}

Measurement Workbench::sample(const Judge& judge, const SampleOptions& options)
{
    const auto list = timed([&] { return spawnfield::sample(judge, options); });
    return {list.result.draws, list.seconds, digest_of(list.result), list.result.exact_checks};
}

Measurement Workbench::search(const Judge& judge, const SearchOptions& options)
{
    const auto list = timed([&] { return spawnfield::search(judge, options); });
    return {list.result.draws, list.seconds, digest_of(list.result), list.result.exact_checks};
}

// ---- The alternatives ----

Measurement Workbench::fcl_raster_3d(int threads)
{
    const RasterGrid grid = raster_grid(map().bounds, thinned_options_3d());
    const PlainFcl& ready = plain_fcl();
    const auto counts = timed([&] { return ready.raster_3d(grid, 1.0, setting_.height_check, threads); });
    Digest digest;
    for (const Verdict verdict : all_verdicts) digest.add(counts.result[verdict]);
    return {counts.result.total(), counts.seconds, digest.value()};
}

Measurement Workbench::fcl_check(int threads)
{
    const std::vector<Pose>& asked = poses();
    const PlainFcl& ready = plain_fcl();
    const auto verdicts = timed([&] { return ready.check(asked, 1.0, threads); });
    return {asked.size(), verdicts.seconds, Digest().add_all(verdicts.result).value()};
}

Measurement Workbench::nav_draw()
{
    const NavMesh& ready = nav_mesh();
    const auto points = timed([&] { return ready.draw(setting_.nav_points, 0); });
    return {points.result.size(), points.seconds, Digest().add_all(points.result).value()};
}

}  // namespace bench
