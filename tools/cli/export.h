#pragma once

#include "ground_args.h"
#include "place_args.h"
#include "reach_args.h"
#include "session.h"
#include "simulator_output.h"

namespace spawnfield::cli {

/// Options of `export`. The table of formats says which of them a format accepts.
struct ExportArgs : QueryArgs {
    GroundArgs ground;
    IslandArgs islands;
    PlaceArgs places;
    std::string format, out, bounds, poses, bands, yaw = "0";
    bool local = false;
    SimulatorArgs simulator;
    double resolution = 0, step = 0;
};

/// The input of a format's writer.
struct ExportJob {
    const ExportArgs& args;
    const CLI::App& command;
    const Session& session;  ///< only the map if no --robot was given
    Summary& summary;        ///< lap("load") is done; the time after the last lap is that of "write"
    IslandChoice islands;    ///< without --robot: all

    bool has_robot() const { return session.judge.has_value(); }
    bool was_given(const std::string& option) const { return command.count(option) > 0; }
};

/// Returns whether the robot is let down at each of --poses: only with --settle or --stance settled. Otherwise, prints
/// a notice about options without effect.
bool lets_down_poses(const ExportJob& job);

/// Returns how the robot rests at each pose of --poses. Prints the notices about that.
std::vector<SettledPose> settled_poses(const ExportJob& job, const PoseTable& table);

/// A row of the table of formats.
struct ExportFormat {
    const char* name;
    const char* about;               ///< one line for --help
    std::vector<std::string> needs;  ///< required options; --out if it cannot go to standard output
    std::vector<std::string> takes;  ///< further options that it accepts; others are refused
    void (*write)(const ExportJob&);
};

/// Options about where --robot can stand. They are refused without --robot.
const std::vector<std::string>& pose_options();

/// Formats that contain a whole map.
std::vector<ExportFormat> map_formats();

/// Formats that contain the poses of a CSV file.
std::vector<ExportFormat> pose_export_formats();

}  // namespace spawnfield::cli
