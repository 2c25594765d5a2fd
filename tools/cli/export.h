#pragma once

#include "ground_args.h"
#include "simulator_output.h"

namespace spawnfield::cli {

/// Options of `export`; which of them a format takes its row of the table says.
struct ExportArgs : QueryArgs {
    GroundArgs ground;
    std::string format, out, bounds, poses, yaw = "0";
    bool local = false;
    SimulatorArgs simulator;
    double resolution = 0, step = 0;
};

/// What a format's writer gets.
struct ExportJob {
    const ExportArgs& args;
    const CLI::App& command;
    const Session& session;  ///< the map alone if no --robot was given
    Summary& summary;        ///< lap("load") is done; what comes after the last lap goes to "write"

    bool has_robot() const { return session.judge.has_value(); }
    bool was_given(const std::string& option) const { return command.count(option) > 0; }
};

/// A row of the table of formats.
struct ExportFormat {
    const char* name;
    const char* about;  ///< one line for --help
    std::vector<std::string>
        needs;  ///< options that it cannot do without; --out where it does not go to standard output
    std::vector<std::string> takes;  ///< further options that say something to it; others are refused
    void (*write)(const ExportJob&);
};

/// Options of what asks where --robot can stand; without it they are refused.
const std::vector<std::string>& asking_options();

/// Formats that are made of a whole map.
std::vector<ExportFormat> map_formats();

/// Formats that are made of the poses of a CSV file.
std::vector<ExportFormat> pose_export_formats();

}  // namespace spawnfield::cli
