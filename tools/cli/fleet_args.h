#pragma once

#include "area_args.h"
#include "avoid_args.h"
#include "command.h"
#include "ground_args.h"
#include "reach_args.h"
#include "simulator_output.h"
#include "spawn_args.h"

#include <spawnfield/fleet_file.h>

#include <optional>
#include <string>

namespace spawnfield::cli {

/// Options of `sample` on fleets, and on as many robots as fit.
struct FleetArgs {
    std::string file;
    bool fill = false;
    std::optional<double> fill_step;  ///< m
};

/// Adds --fleet, --fill and --fill-step.
void add_fleet(CLI::App& command, FleetArgs& args);

/// Returns whether --fleet or --fill was given. Throws ArgumentError if --fill-step was given without them.
bool asks_for_fleet(const CLI::App& command);

/// The options of `sample` that a fleet uses. Those that a kind of the fleet file has, too, are for the other kinds.
struct FleetInputs {
    const FleetArgs& fleet;
    const QueryArgs& query;
    const DrawArgs& draws;
    const SimulatorArgs& simulator;
    const AreaArgs& area;
    const AvoidArgs& avoid;
    const GroundArgs& ground;
    const IslandArgs& islands;
    const std::string &yaw, &format, &out;
};

/// Runs `sample --fleet` or `sample --fill`.
Ending run_fleet(const FleetInputs& inputs, const CLI::App& command, Summary& summary);

/// The options of one kind of robot: those of the command line, with those of the fleet file in their place.
struct KindArgs {
    KindArgs(const FleetInputs& inputs, const FleetFileKind& kind);

    QueryArgs query;
    GroundArgs ground;
    AreaArgs area;
    IslandArgs islands;
    SimulatorArgs simulator;
    std::string yaw;
    double min_distance = 0;          ///< m
    std::optional<double> fill_step;  ///< m
};

/// Returns how many robots were found, what is missing, and what is proven.
std::string fleet_words(const Fleet& fleet, std::span<const FleetKind> kinds);

}  // namespace spawnfield::cli
