#include "base/yaml_map.h"
#include "apart/scene_fields.h"
#include "reader.h"

#include <spawnfield/audit.h>
#include <spawnfield/error.h>
#include <spawnfield/fleet_file.h>
#include <spawnfield/input_file.h>
#include <spawnfield/pair_files.h>
#include <spawnfield/poses.h>
#include <spawnfield/region_file.h>

#include <algorithm>

// Readers of texts that are not worlds: poses, pairs, regions, fleets, rules and robots.
namespace fuzz {
namespace {

namespace fs = std::filesystem;
using namespace spawnfield;

void check(const PoseTable& table)
{
    require(table.rows.size() == table.poses.size(), "a table has a row without a pose");
    for (const Pose& pose : table.poses)
        require(pose.position.allFinite() && pose.rotation.allFinite(), "a pose is not finite");
    const std::vector<std::string> names = column_of(table, "name");
    require(names.empty() || names.size() == table.rows.size(), "a row has no field in the column `name`");
}

void read_pose_file(const fs::path& file)
{
    if (file.extension() == ".pairs") {
        const PairTable pairs = parse_pairs(read_file(file), file.string());
        check(pairs.starts);
        check(pairs.goals);
        require(pairs.starts.poses.size() == pairs.goals.poses.size(), "a pair has only one pose");
        return;
    }
    const PoseTable table = read_poses(file);
    check(table);
    verdicts_of(table, file);
    spawns_of(table);
}

void read_region_file(const fs::path& file)
{
    const Region region = read_region(file);
    require(!region.polygons.empty(), "a region has no polygon");
    for (const Region::Polygon& polygon : region.polygons)
        for (const Region::Ring& ring : polygon)
            require(
                ring.size() >= 3 && std::all_of(ring.begin(), ring.end(), [](const auto& c) { return c.allFinite(); }),
                "a ring has fewer than 3 corners, or one that is not finite");
    region.bounds();
}

void read_settings(const fs::path& file)
{
    if (file.extension() == ".fleet")
        read_fleet(file);
    else
        read_audit_rules(file);
}

void read_robot(const fs::path& file)
{
    const Robot robot = load_robot(file.string(), {.mesh_parts = 4});
    require(fault_of(robot).empty(), "a robot has a fault");
    require(mass_center_of(robot).allFinite(), "a mass centre is not finite");
    robot_contacts(robot);
}

}  // namespace

std::vector<Reader> text_readers()
{
    const std::string wedge = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
    return {{"poses", {".csv", ".pairs"}, read_pose_file},
            {"regions", {".geojson", ".csv"}, read_region_file},
            {"settings", {".fleet", ".rules"}, read_settings},
            {"robots", {".yaml", ".urdf"}, read_robot, {{"wedge.obj", wedge}}}};
}

}  // namespace fuzz
