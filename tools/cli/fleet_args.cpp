#include "fleet_args.h"

#include "angle.h"
#include "messages.h"
#include "numbers.h"

#include <spawnfield/error.h>

namespace spawnfield::cli {
namespace {

/// Replaces a value of the command line by that of the fleet file, if it has one.
template <class Value, class Given>
void override_by(const std::optional<Given>& given, Value& value)
{
    if (given) value = *given;
}

/// Returns "no robot can be added at 512 valid poses: …".
std::string proof_words(const FleetProof& proof)
{
    return "none can be added at the " + counted(proof.valid, "valid pose") + " of a raster with steps of " +
           rounded(proof.step) + " m and " + counted(proof.headings, "heading") +
           ": there, it would overlap a robot, or be too near to one or to an avoided pose";
}

}  // namespace

void add_fleet(CLI::App& command, FleetArgs& args)
{
    start_group(command, "Fleet");
    command
        .add_option("--fleet", args.file,
                    "Place several kinds of robots that do not overlap, in place of --robot and -n: a YAML file with "
                    "their names, counts, distances and formations (docs/fleets.md). Options of the command line are "
                    "for kinds that do not have them in the file")
        ->check(not_empty());
    command.add_flag("--fill", args.fill,
                     "In place of -n: place as many robots as fit, at least --min-distance apart and without overlaps. "
                     "Then no robot can be added at the poses of a raster");
    command.add_option("--fill-step", args.fill_step,
                       "m between the columns of that raster, and of those of a fleet (default: a quarter of the "
                       "robot's smallest width, or more for large maps)");
}

bool asks_for_fleet(const CLI::App& command)
{
    if (command.count("--fleet") > 0 && command.count("--fill") > 0)
        throw ArgumentError("--fleet and --fill are both given; write `count: fill` for a kind in the fleet file");
    const bool asks = command.count("--fleet") > 0 || command.count("--fill") > 0;
    if (!asks) refuse(command, {"--fill-step"}, "is only for --fill and --fleet; give one of them, too");
    return asks;
}

KindArgs::KindArgs(const FleetInputs& inputs, const FleetFileKind& kind)
    : query(inputs.query), ground(inputs.ground), area(inputs.area), islands(inputs.islands),
      simulator(inputs.simulator), yaw(inputs.yaw), fill_step(inputs.fleet.fill_step)
{
    query.robot = kind.robot;
    override_by(kind.yaw, yaw);
    override_by(kind.min_distance, min_distance);
    override_by(kind.fill_step, fill_step);
    override_by(kind.layers, ground.layers);
    override_by(kind.island, islands.island);
    override_by(kind.drive, islands.drive);
    override_by(kind.max_step, islands.max_step);
    override_by(kind.reach_step, islands.reach_step);
    if (kind.max_slope) query.max_slope = kind.max_slope;
    if (kind.floor || kind.z) {
        ground.floor = kind.floor.value_or(-1);
        ground.z = kind.z.value_or("");
    }
    if (!kind.region.empty()) area.regions = kind.region;
    area.keep_outs.insert(area.keep_outs.end(), kind.keep_out.begin(), kind.keep_out.end());
    if (kind.model.empty()) return;
    const bool is_uri = kind.model.find("://") != std::string::npos;
    (is_uri ? simulator.robot_uri : simulator.robot_file) = kind.model;
}

std::string fleet_words(const Fleet& fleet, std::span<const FleetKind> kinds)
{
    std::string out;
    for (std::size_t k = 0; k < kinds.size(); ++k) {
        const FleetKindResult& result = fleet.kinds[k];
        const bool is_full = !kinds[k].count, is_missing = !is_full && result.found < *kinds[k].count;
        if (!is_full && !is_missing) continue;
        out += (out.empty() ? "" : "; ") + kinds[k].name + ": ";
        out += is_full ? counted(result.found, "robot")
                       : "only " + std::to_string(result.found) + " of " + counted(*kinds[k].count, "robot") + " found";
        if (!result.why.empty())
            out += ", because " + result.why;
        else if (result.proof)
            out += ", and " + proof_words(*result.proof);
    }
    return out;
}

}  // namespace spawnfield::cli
