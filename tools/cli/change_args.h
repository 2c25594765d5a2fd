#pragma once

#include "common_args.h"
#include "model_path.h"

#include <spawnfield/changes.h>

#include <string>
#include <vector>

namespace spawnfield::cli {

/// Changes of the map for one query: parts that are removed, then scenes and robots that are added.
struct ChangeArgs {
    std::vector<std::string> with, without;
    std::string time;  ///< --time: LOW:HIGH in s; empty: all time

    bool has_changes() const { return !with.empty() || !without.empty() || !time.empty(); }
};

/// Adds --with, --without and --time below the heading "Changed world".
void add_changes(CLI::App& command, ChangeArgs& args);
inline const std::vector<std::string> change_option_names{"--with", "--without", "--time"};

/// Returns the map with all changes. Prints the notices of the files, and those about parts off the map and about a map
/// without terrain. Throws ArgumentError, FileError.
Map changed_map(const CommonArgs& common, const ChangeArgs& args, const ModelPathArgs& models, Map map);

}  // namespace spawnfield::cli
