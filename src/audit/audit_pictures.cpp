#include "audit/audit_pictures.h"

#include "base/number.h"
#include "poses/judged_pose.h"

#include <spawnfield/error.h>
#include <spawnfield/frames.h>
#include <spawnfield/heatmap.h>
#include <spawnfield/input_file.h>
#include <spawnfield/raster_islands.h>

#include <unistd.h>

#include <cmath>

namespace spawnfield {
namespace {

namespace fs = std::filesystem;

/// A new folder that is removed with all its contents at the end.
class ScratchFolder {
public:
    ScratchFolder()
    {
        std::string name = (fs::temp_directory_path() / "spawnfield-audit-XXXXXX").string();
        if (mkdtemp(name.data()) == nullptr) throw OutputError(name, "cannot be made: pictures are drawn in a folder");
        path_ = name;
    }
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;
    ~ScratchFolder()
    {
        std::error_code ignored;
        fs::remove_all(path_, ignored);
    }
    const fs::path& path() const { return path_; }

private:
    fs::path path_;
};

/// Adds the start poses, in the colours of their verdicts.
void add_poses(HeatmapOptions& picture, const AuditReport& report, const RobotAudit& robot)
{
    for (const NamedPose& named : report.poses) {
        picture.spawns.push_back({named.pose.position, rpy_from(named.pose.rotation).yaw});
        picture.spawn_names.push_back(named.name);
    }
    picture.spawn_verdicts.assign(report.poses.size(), Verdict::Valid);
    for (const BadPose& bad : robot.bad_poses) picture.spawn_verdicts[bad.pose] = bad.verdict;
}

}  // namespace

AuditPictures draw_audit(const AuditReport& report, const RobotAudit& robot, int threads)
{
    const ScratchFolder folder;
    const fs::path file = folder.path() / "picture.png";
    const TerrainMap terrain = read_terrain(report.map);
    const auto drawn = [&](const HeatmapOptions& picture) {
        write_heatmap(report.map, terrain, robot.raster, picture, file);
        return read_file(file);
    };
    const double step = std::round(robot.raster.grid.step * 1e3) / 1e3;
    HeatmapOptions picture{.pixels = 900,
                           .title = report.map.name + ", " + robot_name(robot.judge.robot()),
                           .caption = "settled at yaw 0, " + rounded(step) + " m between the poses",
                           .robot = &robot.judge.robot(),
                           .threads = threads};
    add_poses(picture, report, robot);
    AuditPictures out{.heatmap = drawn(picture), .islands = {}};
    picture.quantity = HeatmapQuantity::Island;
    picture.islands = islands_of(robot.graph, robot.judge, robot.raster, {.threads = threads});
    for (const Island& island : robot.graph.islands()) picture.island_areas.push_back(island.area);
    out.islands = drawn(picture);
    return out;
}

}  // namespace spawnfield
