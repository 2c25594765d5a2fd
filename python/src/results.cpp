#include "arrays.h"
#include "bindings.h"
#include "results.h"

#include <spawnfield/judge.h>
#include <spawnfield/verdict_report.h>

#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <cmath>
#include <limits>

namespace spawnfield::python {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

nb::bytes bytes_of(const std::string& text) { return nb::bytes(text.data(), text.size()); }

/// Returns a column: a number of each item.
template <class List, class Get>
nb::object column_of(const List& list, const Get& get)
{
    std::vector<std::decay_t<decltype(get(list[0]))>> out;
    out.reserve(list.size());
    for (const auto& item : list) out.push_back(get(item));
    return array_of(std::move(out));
}

/// Returns poses as an array of shape (n, 7).
template <class List, class Get>
nb::object poses_column(const List& list, const Get& get)
{
    std::vector<double> out;
    out.reserve(7 * list.size());
    for (const auto& item : list) append_pose(out, get(item));
    return array_of(std::move(out), {list.size(), 7});
}

Pose pose_of(const Spawn& spawn) { return {spawn.position, rotation_from_rpy(spawn.roll, spawn.pitch, spawn.yaw)}; }

nb::dict counts_of(const VerdictCounts& counts)
{
    nb::dict out;
    for (const Verdict verdict : all_verdicts) out[to_string(verdict)] = counts[verdict];
    return out;
}

/// The columns of spawns and of the robots of a fleet.
void add_spawns(nb::dict& out, const std::vector<Spawn>& spawns, const std::vector<SpawnRest>& rests)
{
    out["pose"] = poses_column(spawns, pose_of);
    out["roll"] = column_of(spawns, [](const Spawn& spawn) { return spawn.roll; });
    out["pitch"] = column_of(spawns, [](const Spawn& spawn) { return spawn.pitch; });
    out["yaw"] = column_of(spawns, [](const Spawn& spawn) { return spawn.yaw; });
    if (rests.empty() && !spawns.empty()) return;
    out["tilt"] = column_of(rests, [](const SpawnRest& rest) { return rest.tilt; });
    out["margin"] = column_of(rests, [](const SpawnRest& rest) { return rest.margin; });
}

nb::dict columns_of(const cli::FoundSpawns& found)
{
    const SpawnList& list = found.list;
    nb::dict out;
    add_spawns(out, list.spawns, list.rests);
    using Kind = HeadingRule::Kind;
    if (list.heading && (list.heading->kind == Kind::Clearest || list.heading->kind == Kind::Along))
        out[list.heading->kind == Kind::Clearest ? "clearance" : "way"] = column_of(
            list.rests, [](const SpawnRest& rest) { return rest.free_length; });
    for (const PlaceColumn& column : list.columns) out[to_string(column.quantity)] = array_of(column.values);
    return out;
}

nb::dict facts_of(const cli::FoundSpawns& found)
{
    nb::dict out;
    out["counts"] = counts_of(found.list.counts);
    out["draws"] = found.list.draws;
    out["is_full"] = found.list.is_full;
    out["undecided_area"] = found.list.undecided_area;
    return out;
}

nb::dict columns_of(const cli::FoundPairs& found)
{
    const std::vector<StartGoal>& pairs = found.list.pairs;
    nb::dict out;
    out["start"] = poses_column(pairs, [&](const StartGoal& pair) { return pair.start.lifted(found.lift); });
    out["goal"] = poses_column(pairs, [&](const StartGoal& pair) { return pair.goal.lifted(found.lift); });
    out["path_length"] = column_of(pairs, [](const StartGoal& pair) { return pair.path_length; });
    out["straight"] = column_of(pairs, [](const StartGoal& pair) { return pair.straight; });
    out["detour"] = column_of(pairs, [](const StartGoal& pair) { return pair.detour(); });
    out["island"] = column_of(pairs, [](const StartGoal& pair) { return std::int64_t(pair.island); });
    return out;
}

nb::list paths_of(const cli::FoundPairs& found)
{
    nb::list out;
    for (const StartGoal& pair : found.list.pairs)
        out.append(poses_column(pair.path, [&](const SettledPose& pose) { return pose.lifted(found.lift); }));
    return out;
}

nb::dict columns_of(const cli::FoundFleet& found)
{
    std::vector<Spawn> spawns;
    std::vector<SpawnRest> rests;
    for (const FleetRobot& robot : found.fleet.robots) {
        spawns.push_back(robot.spawn);
        rests.push_back(robot.rest);
    }
    nb::dict out;
    add_spawns(out, spawns, rests);
    out["kind"] = column_of(found.fleet.robots, [](const FleetRobot& robot) { return std::int64_t(robot.kind); });
    return out;
}

std::vector<std::string> names_of(const cli::FoundFleet& found)
{
    std::vector<std::string> out;
    for (const FleetRobot& robot : found.fleet.robots) out.push_back(robot.name);
    return out;
}

Pose pose_of(const RasterResult& raster, std::size_t index)
{
    const RasterPose& pose = raster.poses[index];
    const Vec3 position{pose.x, pose.y, pose.z};
    if (raster.rests.empty()) return {position, rotation_from_rpy(0, 0, raster.yaw)};
    const RasterRest& rest = raster.rests[index];
    return {position, rotation_from_rpy(rest.roll, rest.pitch, rest.yaw)};
}

nb::dict columns_of(const cli::FoundRaster& found)
{
    const RasterResult& raster = found.raster;
    std::vector<double> poses;
    poses.reserve(7 * raster.poses.size());
    for (std::size_t i = 0; i < raster.poses.size(); ++i) append_pose(poses, pose_of(raster, i));
    nb::dict out;
    out["pose"] = array_of(std::move(poses), {raster.poses.size(), 7});
    out["verdict"] = column_of(raster.poses, [](const RasterPose& pose) { return std::uint8_t(pose.verdict); });
    out["layer"] = column_of(raster.poses, [](const RasterPose& pose) { return pose.layer; });
    const RasterGrid& grid = raster.grid;
    const auto place_in = [](double x, double x0, double step) { return std::int32_t(std::lround((x - x0) / step)); };
    out["col"] = column_of(raster.poses, [&](const RasterPose& pose) { return place_in(pose.x, grid.x0, grid.step); });
    out["row"] = column_of(raster.poses, [&](const RasterPose& pose) { return place_in(pose.y, grid.y0, grid.step); });
    if (raster.rests.empty()) return out;
    out["layer_height"] = column_of(raster.rests, [](const RasterRest& rest) { return rest.layer_height; });
    out["roll"] = column_of(raster.rests, [](const RasterRest& rest) { return rest.roll; });
    out["pitch"] = column_of(raster.rests, [](const RasterRest& rest) { return rest.pitch; });
    out["yaw"] = column_of(raster.rests, [](const RasterRest& rest) { return rest.yaw; });
    out["tilt"] = column_of(raster.rests, [](const RasterRest& rest) { return rest.tilt; });
    out["margin"] = column_of(raster.rests, [](const RasterRest& rest) { return rest.margin; });
    out["tip_over"] = column_of(raster.rests, [](const RasterRest& rest) { return rest.tip_over; });
    out["belly"] = column_of(raster.rests, [](const RasterRest& rest) { return rest.belly; });
    return out;
}

nb::dict facts_of(const cli::FoundRaster& found)
{
    const RasterGrid& grid = found.raster.grid;
    nb::dict out;
    out["dims"] = found.raster.dims;
    for (const auto& [name, value] :
         {std::pair{"x0", grid.x0}, {"y0", grid.y0}, {"z0", grid.z0}, {"step", grid.step}, {"step_z", grid.step_z}})
        out[name] = value;
    for (const auto& [name, count] : {std::pair{"cols", grid.cols}, {"rows", grid.rows}, {"heights", grid.heights}})
        out[name] = count;
    out["counts"] = counts_of(found.raster.counts);
    return out;
}

nb::bytes csv_of(const cli::FoundRaster& found, bool aerial, int threads)
{
    std::string text;
    {
        const nb::gil_scoped_release unlocked;
        write_raster_csv(
            found.raster, aerial, [&](std::string_view piece) { text += piece; }, threads);
    }
    return bytes_of(text);
}

nb::dict columns_of(const cli::FoundVerdicts& found)
{
    constexpr std::int64_t none = -1, occupancy = -2;
    const std::vector<Judgement>& judged = found.judgements;
    nb::dict out;
    out["code"] = column_of(judged, [](const Judgement& judgement) { return std::uint8_t(judgement.verdict); });
    out["ground"] = column_of(
        judged, [](const Judgement& judgement) { return judgement.ground ? judgement.ground->height : nan; });
    out["hit_part"] = column_of(judged, [](const Judgement& judgement) -> std::int64_t {
        if (!judgement.hit) return none;
        return judgement.hit->part == CollisionHit::occupancy ? occupancy : std::int64_t(judgement.hit->part);
    });
    if (found.repairs) {
        std::vector<double> poses;
        for (const std::optional<Repair>& repair : found.repairs->repairs) {
            if (repair && repair->pose)
                append_pose(poses, pose_of(*repair->pose));
            else
                poses.insert(poses.end(), 7, nan);
        }
        out["repair"] = array_of(std::move(poses), {judged.size(), 7});
        out["repair_distance"] = column_of(found.repairs->repairs, [](const std::optional<Repair>& repair) {
            return repair && repair->pose ? repair->distance : nan;
        });
    }
    const std::vector<SettledPose>& settled = found.settled;
    if (settled.empty()) return out;
    std::vector<double> poses;
    for (const SettledPose& pose : settled) {
        if (pose.has_pose)
            append_pose(poses, pose.lifted(0));
        else
            poses.insert(poses.end(), 7, nan);
    }
    out["settled"] = array_of(std::move(poses), {settled.size(), 7});
    const auto of_rest = [&](double SettledPose::*member) {
        return column_of(settled, [&](const SettledPose& pose) { return pose.has_pose ? pose.*member : nan; });
    };
    out["tilt"] = of_rest(&SettledPose::tilt);
    out["margin"] = of_rest(&SettledPose::margin);
    out["tip_over"] = of_rest(&SettledPose::tip_over);
    out["belly"] = of_rest(&SettledPose::belly);
    return out;
}

/// Returns the places at which settled robots touch the ground: points and normals of shape (k, 3), m, and the first
/// one of each pose; then their number.
nb::dict contacts_of(const cli::FoundVerdicts& found)
{
    std::vector<double> points, normals;
    std::vector<std::int64_t> first{0};
    const auto append = [](std::vector<double>& out, const Vec3& value) {
        out.insert(out.end(), {value.x(), value.y(), value.z()});
    };
    for (const SettledPose& pose : found.settled) {
        for (const RestContact& contact : pose.contacts) {
            append(points, contact.point);
            append(normals, contact.normal);
        }
        first.push_back(std::int64_t(points.size() / 3));
    }
    first.resize(found.judgements.size() + 1, first.back());  // poses as given have none
    const std::size_t count = points.size() / 3;
    nb::dict out;
    out["point"] = array_of(std::move(points), {count, 3});
    out["normal"] = array_of(std::move(normals), {count, 3});
    out["first"] = array_of(std::move(first));
    return out;
}

std::string reason_of(const cli::FoundVerdicts& found, std::size_t index)
{
    const VerdictReport report{found.table, found.judgements, found.judge,
                               found.settled.empty() ? nullptr : &found.settled,
                               found.repairs ? &*found.repairs : nullptr};
    return reason(report, index);
}

nb::bytes csv_of(const cli::FoundVerdicts& found, const PoseTable& table)
{
    const RepairList* const repairs = found.repairs ? &*found.repairs : nullptr;
    return bytes_of(found.settled.empty() ? verdicts_csv(table, found.judgements, found.judge.map(), repairs)
                                          : settled_csv(table, found.settled, found.judge, repairs));
}

/// The same for poses in memory, whose table has no rows of text.
nb::bytes csv_of(const cli::FoundVerdicts& found, const Numbers& poses)
{
    PoseTable table = found.table;
    table.rows = rows_of(poses);
    return csv_of(found, table);
}

}  // namespace

void bind_results(nb::module_& module)
{
    nb::class_<cli::FoundSpawns>(module, "FoundSpawns")
        .def("columns", [](const cli::FoundSpawns& found) { return columns_of(found); })
        .def("facts", [](const cli::FoundSpawns& found) { return facts_of(found); })
        .def("csv", [](const cli::FoundSpawns& found) { return bytes_of(spawns_csv(found.list)); });
    nb::class_<cli::FoundPairs>(module, "FoundPairs")
        .def("columns", [](const cli::FoundPairs& found) { return columns_of(found); })
        .def("paths", &paths_of);
    nb::class_<cli::FoundFleet>(module, "FoundFleet")
        .def("columns", [](const cli::FoundFleet& found) { return columns_of(found); })
        .def("names", &names_of)
        .def("kinds", [](const cli::FoundFleet& found) { return found.kinds; });
    nb::class_<cli::FoundRaster>(module, "FoundRaster")
        .def("columns", [](const cli::FoundRaster& found) { return columns_of(found); })
        .def("facts", [](const cli::FoundRaster& found) { return facts_of(found); })
        .def("csv",
             [](const cli::FoundRaster& found, bool aerial, int threads) { return csv_of(found, aerial, threads); });
    nb::class_<cli::FoundVerdicts>(module, "FoundVerdicts")
        .def("columns", [](const cli::FoundVerdicts& found) { return columns_of(found); })
        .def("parts",
             [](const cli::FoundVerdicts& found) {
                 std::vector<std::string> names;
                 for (const Part& part : found.judge.map().geometry.parts()) names.push_back(part.name);
                 return names;
             })
        .def("contacts", &contacts_of)
        .def("reason", &reason_of)
        .def("csv", [](const cli::FoundVerdicts& found) { return csv_of(found, found.table); })
        .def("csv", [](const cli::FoundVerdicts& found, const Numbers& poses) { return csv_of(found, poses); });
}

}  // namespace spawnfield::python
