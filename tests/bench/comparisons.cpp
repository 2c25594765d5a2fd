#include "workbench.h"

#include "../random_scene.h"
#include "timed.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

using namespace spawnfield;

// Compares the verdicts of the alternatives with those of spawnfield.
namespace bench {
namespace {

/// The differences between two lists of verdicts.
struct Differences {
    std::size_t poses = 0, wrong = 0;
    std::size_t inside = 0;  ///< the alternative does not see that the robot is inside a closed mesh
    std::size_t missed = 0;  ///< a ray misses an edge of the ground

    void add(const PlainFcl& fcl, const Vec3& centre, Verdict ours, Verdict theirs)
    {
        ++poses;
        if (ours == theirs) return;
        const bool hidden = ours == Verdict::Collision && theirs == Verdict::Valid && fcl.is_inside(centre);
        ++(hidden ? inside : wrong);
        if (!hidden) ++pairs[std::string(to_string(ours)) + " but " + to_string(theirs)];
    }
    std::string text(const std::string& rival) const
    {
        std::string out = formatted("%zu poses, %zu verdicts of %s differ", poses, wrong, rival.c_str());
        for (const auto& [pair, count] : pairs) out += formatted(", %zu %s", count, pair.c_str());
        return out +
               formatted(
                   "; %zu more where the robot is completely inside closed meshes, %zu where the ray of Embree misses "
                   "an edge of the ground",
                   inside, missed);
    }
    std::map<std::string, std::size_t> pairs;  ///< "<ours> but <theirs>", and how often
};

/// Returns where an alternative differs from our raster of top layers. `centre` is a point inside the robot.
Differences differences_of(const RasterResult& ours, const TopRaster& theirs, const PlainFcl& fcl, const Vec3& centre)
{
    Differences out;
    std::size_t extra = theirs.size() - std::size_t(std::count(theirs.begin(), theirs.end(), std::nullopt));
    for (const RasterPose& pose : ours.poses) {
        const int row = int(std::lround((pose.y - ours.grid.y0) / ours.grid.step)),
                  col = int(std::lround((pose.x - ours.grid.x0) / ours.grid.step));
        const auto& other = theirs[std::size_t(row) * std::size_t(ours.grid.cols) + std::size_t(col)];
        if (other) --extra;
        if (!other || std::abs(other->z - pose.z) > 1e-3) {
            ++out.poses, ++out.missed;
            continue;
        }
        out.add(fcl, Vec3(pose.x, pose.y, pose.z) + centre, pose.verdict, other->verdict);
    }
    out.wrong += extra;
    return out;
}

}  // namespace

std::vector<std::string> Workbench::comparisons(const std::string& only)
{
    std::vector<std::string> out;
    const auto wanted = [&](const std::string& stage) {
        return (setting_.name + " " + stage).find(only) != std::string::npos;
    };
    if (has_plain_fcl()) {
        for (const RasterWork& work : setting_.rasters)
            if (is_top_raster(work) && wanted(work.name)) compare_2d(work, out);
        if (wanted("raster3d")) out.push_back(compare_3d());
        if (setting_.has_ground && wanted("check")) out.push_back(compare_checks());
    }
    if (has_nav_mesh() && wanted("sample")) out.push_back(compare_nav_mesh());
    return out;
}

void Workbench::compare_2d(const RasterWork& work, std::vector<std::string>& out)
{
    RasterOptions options = options_2d(work);
    options.layers = {.kind = LayerChoice::Kind::Top};
    const RasterResult ours = spawnfield::raster(judge(), options);
    const Vec3 centre = setting_.robot().parts.front().centre();
    const auto add = [&](const char* rival, const TopRaster& theirs) {
        const Differences differences = differences_of(ours, theirs, plain_fcl(), centre);
        out.push_back(setting_.name + " " + work.name + ": " + differences.text(rival));
    };
    add("plain FCL", plain_fcl().raster_top(ours.grid, work.offset, 0));
    if (has_embree_only())
        add("Embree alone", embree_only().raster_top(ours.grid, work.offset, 0, EmbreeOnly::Search::OurOwn));
}

std::string Workbench::compare_3d()
{
    const RasterResult ours = spawnfield::raster(judge(), thinned_options_3d());
    const VerdictCounts theirs = plain_fcl().raster_3d(ours.grid, 1.0, setting_.height_check, 0);
    std::string text = setting_.name +
                       formatted(" raster3d: of %llu poses", static_cast<unsigned long long>(ours.counts.total()));
    for (const Verdict verdict : all_verdicts)
        if (ours.counts[verdict] + theirs[verdict] > 0)
            text += formatted(", %s %llu (plain FCL %llu)", to_string(verdict),
                              static_cast<unsigned long long>(ours.counts[verdict]),
                              static_cast<unsigned long long>(theirs[verdict]));
    return text;
}

std::string Workbench::compare_checks()
{
    const std::vector<Judgement> ours = judge().check(poses());
    const std::vector<Verdict> theirs = plain_fcl().check(poses(), 1.0, 0);
    const Vec3 centre = setting_.robot().parts.front().centre();
    Differences differences;
    for (std::size_t i = 0; i < ours.size(); ++i)
        differences.add(plain_fcl(), poses()[i].rotation * centre + poses()[i].position, ours[i].verdict, theirs[i]);
    return setting_.name + " check: " + differences.text("plain FCL");
}

/// Returns the share of collisions among the points of Recast, first as they are drawn and then on the nearest layer
/// above or below.
std::string Workbench::compare_nav_mesh()
{
    Random random(23);
    std::vector<Pose> drawn, snapped;
    const NavMesh& mesh = nav_mesh();
    const auto points = timed([&] { return mesh.draw(setting_.nav_points, 0); });
    for (const Vec3& point : points.result) {
        const Mat3 rotation = rotation_from_rpy(0, 0, random.between(-std::numbers::pi, std::numbers::pi));
        drawn.push_back({point + Vec3(0, 0, 0.1), rotation});
        const std::vector<double> layers = column_at(map().geometry, point.x(), point.y()).layers;
        const auto nearer = [&](double a, double b) { return std::abs(a - point.z()) < std::abs(b - point.z()); };
        const double ground = layers.empty() ? point.z() : *std::min_element(layers.begin(), layers.end(), nearer);
        snapped.push_back({{point.x(), point.y(), ground + 0.1}, rotation});
    }
    return setting_.name +
           formatted(" recast: %d tiles, %d polygons, %zu points, %.3g/s: ", mesh.tiles(), mesh.polygons(),
                     drawn.size(), double(drawn.size()) / points.seconds) +
           shares(drawn) + " as drawn; " + shares(snapped) + " at 0.1 m above the true ground; " + coverage();
}

/// Returns how many of our samples lie on ground that the mesh of Recast covers.
std::string Workbench::coverage()
{
    const SpawnList ours = spawnfield::sample(judge(), sample_options());
    const auto covered = std::count_if(ours.spawns.begin(), ours.spawns.end(),
                                       [&](const Spawn& s) { return nav_mesh().covers(s.position); });
    return formatted("its mesh covers %.1f %% of our %zu samples", 100.0 * double(covered) / double(ours.spawns.size()),
                     ours.spawns.size());
}

/// Returns text such as "4.7 % collide (4.0 % with their centre inside closed meshes), 94.8 % valid".
std::string Workbench::shares(const std::vector<Pose>& asked)
{
    const std::vector<Judgement> judged = judge().check(asked);
    const Vec3 centre = setting_.robot().parts.front().centre();
    std::size_t collide = 0, inside = 0, valid = 0;
    for (std::size_t i = 0; i < asked.size(); ++i) {
        valid += judged[i].verdict == Verdict::Valid;
        if (judged[i].verdict != Verdict::Collision) continue;
        ++collide;
        if (has_plain_fcl()) inside += plain_fcl().is_inside(asked[i].rotation * centre + asked[i].position);
    }
    const double percent = 100.0 / double(asked.size());
    const std::string hidden = has_plain_fcl() ? formatted(" (%.2f %% with their centre inside closed meshes)",
                                                           percent * double(inside))
                                               : "";
    return formatted("%.2f %% collide", percent * double(collide)) + hidden +
           formatted(", %.2f %% valid", percent * double(valid));
}

}  // namespace bench
