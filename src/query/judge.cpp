#include "base/parallel.h"

#include <spawnfield/query.h>

#include <algorithm>

namespace spawnfield {
namespace {

bool is_submerged(const Column& column, double ground, double max_water_depth)
{
    return std::any_of(column.water.begin(), column.water.end(), [&](double water) {
        return water >= ground - touch_tolerance && water <= ground + max_water_depth + touch_tolerance;
    });
}

}  // namespace

Judgement judge(const Map& map, const CollisionChecker& checker, const Column& column, const Pose& pose,
                const QueryOptions& options)
{
    Judgement out;
    const double z = pose.position.z();
    out.ground = ground_below(column, z);
    if (!map.bounds.contains_xy(pose.position.x(), pose.position.y(), touch_tolerance)) return out;
    out.verdict = Verdict::Aerial;
    if (!out.ground || z - out.ground->height > options.max_height + touch_tolerance) return out;
    out.verdict = Verdict::OffTerrain;
    if (!out.ground->terrain) return out;
    out.verdict = Verdict::Submerged;
    if (is_submerged(column, out.ground->height, options.max_water_depth)) return out;
    out.exact_check = true;
    out.hit = checker.find_hit(pose);
    out.verdict = out.hit ? Verdict::Collision : Verdict::Valid;
    return out;
}

std::vector<Judgement> check_poses(const Map& map, const CollisionChecker& checker, const std::vector<Pose>& poses,
                                   const QueryOptions& options)
{
    std::vector<Judgement> out(poses.size());
    parallel_for(poses.size(), options.threads, options.progress, [&](std::size_t i) {
        const Vec3& p = poses[i].position;
        out[i] = judge(map, checker, column_at(map.geometry, p.x(), p.y()), poses[i], options);
    });
    return out;
}

}  // namespace spawnfield
