#include "base/csv.h"
#include "base/number.h"
#include "poses/pose_json.h"

#include <spawnfield/fleet.h>

namespace spawnfield {
namespace {

Json kind_json(const FleetKind& kind, const FleetKindResult& result)
{
    Json out;
    out["name"] = kind.name;
    out["robot"] = kind.judge.robot().name;
    if (kind.count) out["wanted"] = *kind.count;
    out["found"] = result.found;
    Json settings = sample_settings_json(kind.spawns, kind.judge);
    for (const char* const key : {"count", "seed"}) settings.erase(key);  // those of the fleet
    out["settings"] = std::move(settings);
    out["draws"] = result.draws;
    out["overlapping"] = result.overlapping;
    out["too_close"] = result.too_close;
    if (result.proof)
        out["proof"] = {{"step", result.proof->step},
                        {"headings", result.proof->headings},
                        {"poses", result.proof->poses},
                        {"valid", result.proof->valid}};
    if (!result.why.empty()) out["why"] = result.why;
    return out;
}

}  // namespace

std::string fleet_csv(const Fleet& fleet, std::span<const FleetKind> kinds)
{
    std::string text = "name,kind,x,y,z,roll,pitch,yaw\n";
    for (const FleetRobot& robot : fleet.robots) {
        text += csv_quoted(robot.name) + ',' + csv_quoted(kinds[robot.kind].name);
        const Spawn& spawn = robot.spawn;
        for (const double value :
             {spawn.position.x(), spawn.position.y(), spawn.position.z(), spawn.roll, spawn.pitch, spawn.yaw}) {
            text += ',';
            append_number(text, value);
        }
        text += '\n';
    }
    return text;
}

std::string fleet_json(const Fleet& fleet, std::span<const FleetKind> kinds, const FleetOptions& options,
                       std::span<const RobotStart> robots)
{
    Json settings;
    settings["seed"] = options.seed;
    settings["min_distance"] = options.min_distance;
    for (const KindDistance& pair : options.between)
        settings["between"].push_back(
            {{"kinds", {kinds[pair.first].name, kinds[pair.second].name}}, {"distance", pair.distance}});
    Json out = json_head("sample", kinds[0].judge.map(), {}, std::move(settings), "spawnfield-fleet-poses/1");
    if (fleet.is_stopped) out["interrupted"] = true;
    out["kinds"] = Json::array();
    for (std::size_t kind = 0; kind < kinds.size(); ++kind)
        out["kinds"].push_back(kind_json(kinds[kind], fleet.kinds[kind]));
    out["robots"] = Json::array();
    for (std::size_t i = 0; i < robots.size(); ++i) {
        Json row = pose_json(robots[i]);
        row["kind"] = kinds[fleet.robots[i].kind].name;
        out["robots"].push_back(std::move(row));
    }
    return json_text(out, 2) + "\n";
}

std::vector<RobotStart> robot_starts(const Fleet& fleet)
{
    std::vector<RobotStart> out;
    for (const FleetRobot& robot : fleet.robots) {
        const Spawn& spawn = robot.spawn;
        out.push_back({robot.name, robot.name, spawn.position, {spawn.roll, spawn.pitch, spawn.yaw}});
    }
    return out;
}

}  // namespace spawnfield
