#include "compare.h"

#include <cmath>
#include <sstream>

using namespace spawnfield;

namespace compare {
namespace {

std::ostringstream exact_numbers()
{
    std::ostringstream out;
    out.precision(17);
    return out;
}

void note(Tally& tally, const std::string& what)
{
    if (tally.differences++ == 0) tally.first = what;
}

void count(Tally& tally, Verdict verdict)
{
    ++tally.poses;
    ++tally.verdicts[verdict];
}

std::string described(const Bounds& bounds)
{
    std::ostringstream out = exact_numbers();
    out << "[" << bounds.min.transpose() << "] to [" << bounds.max.transpose() << "]";
    return out.str();
}

std::string described(const JudgeOptions& limits)
{
    std::ostringstream out = exact_numbers();
    out << " --max-height " << limits.max_height << " max-slope " << limits.max_slope;
    return out.str();
}

std::string described(const RasterOptions& options, const JudgeOptions& limits)
{
    std::ostringstream out = exact_numbers();
    out << "raster --dims " << options.dims << (options.height_check ? "" : " --no-height-check")
        << (options.snap ? " --snap" : "") << " --step " << options.step << " --step-z " << options.step_z
        << " --offset " << options.offset.value_or(std::nan("")) << described(limits) << " yaw " << options.yaw
        << " layers " << int(options.layers.kind) << " bounds " << described(options.bounds);
    return out.str();
}

std::string described(const RasterPose& pose)
{
    std::ostringstream out = exact_numbers();
    out << pose.x << " " << pose.y << " " << pose.z << " layer " << pose.layer << ": " << to_string(pose.verdict);
    return out.str();
}

std::string described(const Judgement& judged)
{
    std::ostringstream out = exact_numbers();
    out << to_string(judged.verdict);
    if (judged.ground)
        out << ", ground " << judged.ground->height << " of part " << judged.ground->part
            << (judged.ground->terrain ? ", terrain" : "");
    if (judged.hit) out << ", hit part " << judged.hit->part;
    return out.str();
}

std::string described(const Spawn& spawn)
{
    std::ostringstream out = exact_numbers();
    out << spawn.position.transpose() << " yaw " << spawn.yaw;
    return out.str();
}

std::string two(const std::string& query, const std::string& fast, const std::string& slow)
{
    return query + "\n  with the mask " + fast + "\n  exhaustively  " + slow;
}

bool same(const RasterPose& a, const RasterPose& b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z && a.layer == b.layer && a.verdict == b.verdict &&
           a.snapped == b.snapped;
}

bool same(const Judgement& a, const Judgement& b)
{
    if (a.verdict != b.verdict || a.ground.has_value() != b.ground.has_value() ||
        a.hit.has_value() != b.hit.has_value())
        return false;
    if (a.hit && a.hit->part != b.hit->part) return false;
    return !a.ground || (a.ground->height == b.ground->height && a.ground->terrain == b.ground->terrain &&
                         a.ground->part == b.ground->part);
}

void compare_spawns(const std::string& query, const SpawnList& fast, const SpawnList& slow, Tally& tally)
{
    tally.asked += slow.exact_checks;
    tally.exact += fast.exact_checks;
    for (std::size_t i = 0; i < std::min(fast.spawns.size(), slow.spawns.size()); ++i) {
        count(tally, Verdict::Valid);
        const Spawn &a = fast.spawns[i], &b = slow.spawns[i];
        if (a.position != b.position || a.yaw != b.yaw)
            note(tally, two(query + " spawn " + std::to_string(i), described(a), described(b)));
    }
    if (fast.spawns.size() != slow.spawns.size())
        note(tally, two(query + " spawns", std::to_string(fast.spawns.size()), std::to_string(slow.spawns.size())));
}

}  // namespace

void Tally::add(const Tally& other)
{
    poses += other.poses;
    asked += other.asked;
    exact += other.exact;
    verdicts += other.verdicts;
    proven_valid += other.proven_valid;
    proven_collision += other.proven_collision;
    differences += other.differences;
    if (first.empty()) first = other.first;
}

Tally of_raster(const TwoJudges& judges, const RasterOptions& options)
{
    const RasterResult fast = raster(judges.fast, options), slow = raster(judges.exhaustive, options);
    const std::string query = described(options, judges.fast.options());
    Tally tally;
    tally.asked = slow.exact_checks;
    tally.exact = fast.exact_checks;
    for (std::size_t i = 0; i < std::min(fast.poses.size(), slow.poses.size()); ++i) {
        count(tally, slow.poses[i].verdict);
        if (!same(fast.poses[i], slow.poses[i]))
            note(tally, two(query, described(fast.poses[i]), described(slow.poses[i])));
    }
    if (fast.poses.size() != slow.poses.size())
        note(tally, two(query + " poses", std::to_string(fast.poses.size()), std::to_string(slow.poses.size())));
    else if (fast.counts != slow.counts)
        note(tally, query + ": counts differ");
    return tally;
}

Tally of_check(const TwoJudges& judges, const std::vector<Pose>& poses)
{
    const std::vector<Judgement> fast = judges.fast.check(poses, {.threads = 1}),
                                 slow = judges.exhaustive.check(poses, {.threads = 1});
    Tally tally;
    for (std::size_t i = 0; i < poses.size(); ++i) {
        count(tally, slow[i].verdict);
        tally.asked += slow[i].exact_check;
        tally.exact += fast[i].exact_check;
        tally.proven_valid += fast[i].verdict == Verdict::Valid && !fast[i].exact_check;
        tally.proven_collision += fast[i].verdict == Verdict::Collision && !fast[i].exact_check;
        const Judgement alone = judges.fast.check(poses[i]);
        const std::string query = "check" + described(judges.fast.options()) + " " + described(poses[i]);
        if (!same(fast[i], slow[i])) note(tally, two(query, described(fast[i]), described(slow[i])));
        if (!same(alone, fast[i]) || judges.fast.is_valid(poses[i]) != (alone.verdict == Verdict::Valid))
            note(tally, query + ": alone " + described(alone) + ", among others " + described(fast[i]));
    }
    return tally;
}

Tally of_sample(const TwoJudges& judges, const SampleOptions& options)
{
    Tally tally;
    std::ostringstream query = exact_numbers();
    query << "sample -n " << options.count << " --min-distance " << options.min_distance << " --offset "
          << options.offset.value_or(std::nan("")) << described(judges.fast.options()) << " --seed " << options.seed
          << " yaw " << (options.random_yaw ? "random" : std::to_string(options.yaw)) << " bounds "
          << described(options.bounds);
    compare_spawns(query.str(), sample(judges.fast, options), sample(judges.exhaustive, options), tally);
    return tally;
}

Tally of_search(const TwoJudges& judges, const SearchOptions& options)
{
    const SpawnList fast = search(judges.fast, options), slow = search(judges.exhaustive, options);
    Tally tally;
    std::ostringstream query = exact_numbers();
    query << "search -n " << options.count << " --min-distance " << options.min_distance << " --max-failures "
          << options.max_failures << described(judges.fast.options()) << " --seed " << options.seed << " bounds "
          << described(options.bounds);
    compare_spawns(query.str(), fast, slow, tally);
    if (fast.counts != slow.counts || fast.draws != slow.draws || fast.too_close != slow.too_close)
        note(tally, query.str() + ": counts differ");
    return tally;
}

void CaseTally::add(const CaseTally& other)
{
    raster_2d.add(other.raster_2d);
    raster_3d.add(other.raster_3d);
    collisions.add(other.collisions);
    check.add(other.check);
    sample.add(other.sample);
    search.add(other.search);
    snap.add(other.snap);
}

Tally CaseTally::sum() const
{
    Tally all;
    for (const Tally& tally : {raster_2d, raster_3d, collisions, check, sample, search, snap}) all.add(tally);
    return all;
}

TestMap map_of_case(const HardCase& hard) { return map_at(hard.scene, hard.resolution, hard.map_bounds); }

Bounds crop_near(const TestMap& map, Random& random, double step, int cols)
{
    const Scene& scene = map.scene;
    const int count = int(scene.triangles.size() + scene.primitives.size());
    const auto pick = std::size_t(random.below(count));
    const bool face = pick < scene.triangles.size();
    const Vec3 near = face ? scene.vertices[scene.triangles[pick][0]]
                           : scene.primitives[pick - scene.triangles.size()].shape.pose.position;
    Bounds crop;
    // The crop may extend beyond the bounds of the map; if not, it does so only where it is wider than they are.
    const bool beyond = random.chance(0.15);
    // The crop starts on the lattice of the raster, so that steps of one cell stay on the lattice.
    for (int axis = 0; axis < 2; ++axis) {
        const double low = map.bounds.min[axis], room = map.bounds.max[axis] - low - step * (cols - 1);
        double shift = near[axis] - low - step * cols * random.between(0.2, 0.8);
        if (!beyond) shift = std::clamp(shift, 0.0, std::max(0.0, room));
        crop.min[axis] = low + std::round(shift / map.resolution) * map.resolution;
        crop.max[axis] = crop.min[axis] + step * (cols - 1);
    }
    crop.min.z() = map.bounds.min.z();
    crop.max.z() = map.bounds.max.z() + 1;
    return crop;
}

std::string described(const Pose& pose)
{
    std::ostringstream out = exact_numbers();
    const Mat3& r = pose.rotation;
    out << "at " << pose.position.transpose() << " rpy " << std::atan2(r(2, 1), r(2, 2)) << " "
        << std::asin(std::clamp(-r(2, 0), -1.0, 1.0)) << " " << std::atan2(r(1, 0), r(0, 0));
    return out.str();
}

std::string described(const Robot& robot)
{
    constexpr std::array kinds = {"box", "sphere", "cylinder", "capsule", "hull"};
    std::ostringstream out = exact_numbers();
    for (const RobotPart& part : robot.parts) {
        out << "  " << kinds[std::size_t(part.shape.kind)];
        if (part.shape.kind == ShapeKind::Hull)
            out << " of " << part.hull_vertices.size() << " corners";
        else
            out << " " << part.shape.size.transpose() << " " << described(part.shape.pose);
        out << "\n";
    }
    return out.str();
}

}  // namespace compare
