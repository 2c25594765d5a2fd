#include "compare.h"
#include "slow.h"

#include <cmath>

using namespace spawnfield;

// The queries of a hard case: small rasters on and off the lattice of the raster, poses near the ground, and spawns.

namespace compare {
namespace {

RasterOptions raster_options(const HardCase& hard, Random& random)
{
    RasterOptions options{
        .offset = hard.offset, .yaw = hard.yaws[std::size_t(random.below(int(hard.yaws.size())))], .threads = 1};
    constexpr std::array kinds = {LayerChoice::Kind::Top, LayerChoice::Kind::Bottom, LayerChoice::Kind::Index};
    if (random.chance(0.2)) options.layers = {kinds[std::size_t(random.below(3))], 1};
    return options;
}

/// Returns a step with which about `cols` columns cover the width of the map. It is not a multiple of the resolution.
double wide_step(const TestMap& map, int cols)
{
    return std::max(1e-3, (map.bounds.max - map.bounds.min).head<2>().maxCoeff() / (cols - 0.29));
}

void shift_columns(Bounds& bounds, double by)
{
    bounds.min.head<2>().array() += by;
    bounds.max.head<2>().array() += by;
}

/// Compares rasters across the whole map, at corners of cells, at centres of cells, and with steps of several cells.
Tally rasters_2d(const TestMap& map, const TwoJudges& judges, const HardCase& hard, Random& random)
{
    Tally tally;
    RasterOptions options = raster_options(hard, random);
    options.step = wide_step(map, 26);
    tally.add(of_raster(judges, options));
    for (const double shift : {0.0, 0.5}) {
        options = raster_options(hard, random);
        options.step = hard.resolution * (random.chance(0.6) ? 1 : 1 + random.below(5));
        options.bounds = crop_near(map, random, options.step, 22);
        shift_columns(options.bounds, shift * hard.resolution);
        tally.add(of_raster(judges, options));
    }
    return tally;
}

/// Limits the raster to about `heights` heights.
void limit_heights(RasterOptions& options, const HardCase& hard, Random& random, int heights)
{
    options.dims = 3;
    options.step_z = random.chance(0.5) ? hard.resolution : 0.0731 + hard.resolution / 7;
    const double low = options.bounds.min.z(), high = options.bounds.max.z(), tall = options.step_z * heights;
    const double slack = std::max(0.0, high - low - tall);
    options.bounds.min.z() = low + std::round(random.between(0, slack) / options.step_z) * options.step_z;
    options.bounds.max.z() = options.bounds.min.z() + tall;
}

Tally rasters_3d(const TestMap& map, const TwoJudges& judges, const HardCase& hard, Random& random, bool height_check)
{
    RasterOptions options = raster_options(hard, random);
    options.step = random.chance(0.5) ? hard.resolution : wide_step(map, 31);
    const int cols = height_check ? 16 : 9;
    options.bounds = crop_near(map, random, options.step, cols);
    options.height_check = height_check;
    if (!height_check) options.layers = {};
    limit_heights(options, hard, random, height_check ? 40 : 8);
    return of_raster(judges, options);
}

/// Compares snapped rasters with fine steps, and with steps so wide that most layers have no step near them.
Tally rasters_snapped(const TestMap& map, const HardCase& hard, Random& random)
{
    Tally tally;
    for (const bool wide : {false, true}) {
        RasterOptions options = raster_options(hard, random);
        options.step = random.chance(0.5) ? hard.resolution : wide_step(map, 31);
        options.bounds = crop_near(map, random, options.step, 14);
        options.snap = true;
        options.offset = std::max(0.0, *options.offset);
        limit_heights(options, hard, random, 40);
        if (wide) options.step_z = random.between(0.5, 3);
        const JudgeOptions limits{.max_height = std::max(hard.max_height, *options.offset),
                                  .max_slope = hard.max_slope};
        tally.add(of_raster({map, hard.robot, limits}, options));
    }
    return tally;
}

Tally checks(const TestMap& map, const HardCase& hard, Random& random)
{
    const JudgeOptions limits{
        .max_height = std::max(hard.max_height, hard.offset),
        .max_water_depth = random.chance(0.8) ? std::numeric_limits<double>::infinity() : random.between(0, 0.5),
        .max_slope = hard.max_slope};
    const TwoJudges judges(map, hard.robot, limits);
    Tally tally = of_check(judges, random_poses(hard.scene, random.next(), 250));
    const Bounds crop = crop_near(map, random, wide_step(map, 25), 9);
    tally.add(of_check(judges, standing_poses(map, hard, crop, 500)));
    return tally;
}

template <class Options>
Options spawn_options(const HardCase& hard, Random& random)
{
    Options options;
    options.count = 40;
    options.min_distance = random.chance(0.5) ? 0 : random.between(0, 0.05) * hard.resolution;
    options.random_yaw = random.chance(0.5);
    options.yaw = hard.yaws[0];
    options.seed = hard.seed;
    options.threads = 1;
    return options;
}

/// Returns points to avoid, anywhere in the map.
std::vector<AvoidedPoints> some_points(const TestMap& map, Random& random)
{
    AvoidedPoints out;
    const Vec3 size = map.bounds.max - map.bounds.min;
    out.distance = random.between(0, 0.2) * size.head<2>().minCoeff();
    for (int n = random.below(20); n > 0; --n)
        out.points.push_back(map.bounds.min +
                             size.cwiseProduct(Vec3{random.between(0, 1), random.between(0, 1), random.between(0, 1)}));
    return {out};
}

Tally samples(const TestMap& map, const HardCase& hard, Random& random)
{
    SampleOptions options = spawn_options<SampleOptions>(hard, random);
    options.stance = Stance::Level;
    options.offset = hard.offset;
    if (Random more{hard.seed + 991}; more.chance(0.3)) options.avoid = some_points(map, more);
    const JudgeOptions limits{.max_height = std::max(1.0, hard.offset), .max_slope = hard.max_slope};
    return of_sample({map, hard.robot, limits}, options);
}

/// Compares searches in the lowest 2.5 m of the map. Otherwise nearly all draws would be aerial.
Tally searches(const TestMap& map, const TwoJudges& judges, const HardCase& hard, Random& random)
{
    SearchOptions options = spawn_options<SearchOptions>(hard, random);
    options.max_failures = 150;
    options.bounds = map.bounds;
    options.bounds.max.z() = std::min(map.bounds.max.z(), map.bounds.min.z() + 2) + 0.5;
    return of_search(judges, options);
}

/// Returns whether a few hundred draws are likely to give a spawn. A sampler that finds none tries for a long time.
bool has_room(const Tally& rasters) { return 20 * rasters.verdicts[Verdict::Valid] > rasters.poses; }

}  // namespace

std::vector<Pose> standing_poses(const TestMap& map, const HardCase& hard, const Bounds& crop, std::size_t count)
{
    Random random{hard.seed + 77};
    RasterOptions options = raster_options(hard, random);
    options.layers = {};
    options.bounds = crop;
    options.step = std::max(1e-3, (crop.max.x() - crop.min.x()) / 9);
    const std::vector<RasterPose> raster_poses = raster(Judge(map, hard.robot), options).poses;
    std::vector<Pose> poses;
    for (std::size_t i = 0; i < count && !raster_poses.empty(); ++i) {
        const RasterPose& pose = raster_poses[std::size_t(random.below(int(raster_poses.size())))];
        const double x = pose.x + (random.chance(0.5) ? random.between(-0.1, 0.1) : 0),
                     y = pose.y + (random.chance(0.3) ? random.between(-1e-5, 1e-5) : 0);
        const double z = pose.z + (random.chance(0.3) ? random.between(-1e-4, 1e-4) : 0);
        const double lean = random.chance(0.3) ? random.between(0, 0.3) : 0, roll = random.between(-lean, lean),
                     pitch = random.between(-lean, lean);
        const double yaw = random.chance(0.3) ? hard.yaws[0] : random.between(-M_PI, M_PI);
        poses.push_back({{x, y, z}, rotation_from_rpy(roll, pitch, yaw)});
    }
    return poses;
}

CaseTally of_case(const HardCase& hard)
{
    const TestMap map = map_of_case(hard);
    const TwoJudges judges(map, hard.robot, {.max_height = hard.max_height, .max_slope = hard.max_slope});
    Random random{hard.seed + 13};
    CaseTally tally;
    tally.raster_2d = rasters_2d(map, judges, hard, random);
    tally.raster_3d = rasters_3d(map, judges, hard, random, true);
    tally.collisions = rasters_3d(map, judges, hard, random, false);
    tally.check = checks(map, hard, random);
    if (has_room(tally.raster_2d)) tally.sample = samples(map, hard, random);
    tally.search = searches(map, judges, hard, random);
    tally.snap = rasters_snapped(map, hard, random);
    return tally;
}

namespace {

bool is_filled_open(const Scene& scene)
{
    return std::any_of(scene.pieces.begin(), scene.pieces.end(),
                       [&](const Piece& piece) { return piece.solid && scene.parts[piece.part].open_edges > 0; });
}

/// Returns poses at random distances from the lattice, because on borders of faces the independent decision may take
/// either side.
std::vector<Pose> unaligned_poses(const TestMap& map, const HardCase& hard)
{
    Random random{hard.seed + 31};
    std::vector<Pose> poses = random_poses(hard.scene, hard.seed, 60);
    const Bounds crop = crop_near(map, random, 3 * map.resolution, 20);
    for (Pose pose : standing_poses(map, hard, crop, 100)) {
        for (int axis = 0; axis < 2; ++axis) pose.position[axis] += random.between(-0.003, 0.003);
        poses.push_back(pose);
    }
    return poses;
}

}  // namespace

Tally independently(const HardCase& hard)
{
    Tally tally;
    if (is_filled_open(hard.scene)) return tally;
    const TestMap map = map_of_case(hard);
    const Judge judge(map, hard.robot, {.exhaustive = true});
    const std::vector<Pose> poses = unaligned_poses(map, hard);
    const std::vector<Judgement> judged = judge.check(poses);
    for (std::size_t i = 0; i < poses.size(); ++i) {
        const slow::Decision slow = slow::decide(hard.scene, map.bounds, hard.robot, poses[i],
                                                 judge.options().max_height, 1e9);
        if (!slow.verdict) continue;
        ++tally.poses;
        ++tally.verdicts[*slow.verdict];
        if (*slow.verdict == judged[i].verdict || tally.differences++ > 0) continue;
        tally.first = "check " + described(poses[i]) + "\n  by FCL " + to_string(judged[i].verdict) + "\n  slowly " +
                      to_string(*slow.verdict);
    }
    return tally;
}

}  // namespace compare
