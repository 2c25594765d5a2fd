#pragma once

#include "session.h"

#include <spawnfield/output_folder.h>
#include <spawnfield/thesis.h>

namespace spawnfield::cli {

/// Names and values for Stats.txt.
using Settings = std::vector<std::pair<std::string, std::string>>;

/// Returns the settings that every query has.
Settings query_settings(const std::string& command, const QueryArgs& args, const Session& session);

/// Opens the folder of `--format thesis`, before all work, so that a wrong one is refused at once. Throws ArgumentError
/// without -o, OutputError if something else is there.
std::unique_ptr<OutputFolder> thesis_folder(const std::string& out);

/// Writes all files of the folder. The folder gets its name when they and `then` succeed. `write_locations` writes the
/// files of locations into the given folder.
void write_thesis(
    const CommonArgs& args, OutputFolder& folder, const Settings& settings, const VerdictCounts& counts,
    const Summary& summary, const std::function<ThesisCounts(const std::filesystem::path&)>& write_locations,
    const std::function<void()>& then = [] {});

}  // namespace spawnfield::cli
