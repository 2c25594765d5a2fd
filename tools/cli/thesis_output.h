#pragma once

#include "cli.h"

#include <spawnfield/output_folder.h>
#include <spawnfield/thesis.h>

namespace spawnfield::cli {

/// Names and values for Stats.txt.
using Settings = std::vector<std::pair<std::string, std::string>>;

/// What every query has.
Settings query_settings(const std::string& command, const QueryArgs& args, const Session& session);

/// The folder of `--format thesis`, claimed before all work so that a wrong one is told at once. Throws ArgumentError
/// without -o, OutputError if something else is there.
std::unique_ptr<OutputFolder> thesis_folder(const std::string& out);

/// All files of the folder; it gets its name when they and `then` succeed. `write_locations` writes those of the
/// locations into the folder that it is told.
void write_thesis(
    OutputFolder& folder, const Settings& settings, const VerdictCounts& counts, const Summary& summary,
    const std::function<ThesisCounts(const std::filesystem::path&)>& write_locations,
    const std::function<void()>& then = [] {});

}  // namespace spawnfield::cli
