#pragma once

#include <spawnfield/export.h>
#include <spawnfield/fleet.h>

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace spawnfield {

/// A formation as a file describes it.
struct FormationPlan {
    Formation formation = {};
    std::optional<std::pair<StartPlace, StartPlace>> from_to = {};  ///< of a convoy whose path is to be found
};

/// A kind of robot as a file describes it. Texts are values of the options of `sample` with the same names; a value
/// that is missing is that of the command line.
struct FleetFileKind {
    std::string name, robot;             ///< robot: a file, or box:LX,LY,LZ[@x,y,z]
    std::string model = {};              ///< file or URI that a simulator loads; empty: that of `robot`
    std::optional<std::size_t> count{};  ///< no value: as many as fit
    std::optional<double> min_distance = {}, max_step = {}, max_slope = {}, reach_step = {},
                          fill_step = {};  ///< m, m, degrees, m, m
    std::optional<std::string> yaw = {}, z = {}, layers = {}, island = {}, drive = {};
    std::optional<int> floor = {};
    std::vector<std::string> region = {}, keep_out = {};
    std::optional<FormationPlan> formation = {};
    std::string place = {};  ///< for messages: robots "husky" (line 3)
};

/// The content of a fleet file (format spawnfield-fleet/1).
struct FleetFile {
    std::vector<FleetFileKind> kinds;
    double min_distance = 0;
    std::vector<KindDistance> between = {};
    bool one_island = false;
    std::optional<FormationPlan> formation = {};
};

/// Reads a fleet file (see docs/fleets.md). Relative paths of robots, models and regions are relative to its folder;
/// the result has them with the folder. Throws FileError for keys that are unknown or missing, and for values of a
/// wrong type or beyond their limits.
SPAWNFIELD_API FleetFile read_fleet(const std::filesystem::path& file);

}  // namespace spawnfield
