#pragma once

#include "session.h"

#include <spawnfield/island_choice.h>
#include <spawnfield/query.h>

namespace spawnfield::cli {

/// Options on how the robot drives.
struct ReachArgs {
    std::string drive;                                             ///< empty: that of the robot
    std::optional<double> max_step, turning_radius, reach_step{};  ///< m
};

/// Options on the islands on which poses must be.
struct IslandArgs : ReachArgs {
    std::string island;
    double min_island = 0;  ///< m2
    std::vector<std::string> reachable_from;
};

/// Adds, below the heading "Reach", --drive, --turning-radius, --max-step and --reach-step.
void add_reach(CLI::App& command, ReachArgs& args);
inline const std::vector<std::string> reach_option_names{"--drive", "--turning-radius", "--max-step", "--reach-step"};

/// Adds, below the heading "Reach", --island, --min-island and --reachable-from, and the options of add_reach().
void add_islands(CLI::App& command, IslandArgs& args);
inline const std::vector<std::string> island_option_names{"--island", "--min-island", "--reachable-from"};

/// Returns the options of a ReachGraph, without progress.
ReachOptions reach_options(const QueryArgs& query, const ReachArgs& args);

/// Finds where the robot can drive, and puts the number of islands and the time into the summary. `command` is what the
/// progress bar shows; `keep_ways`: ReachOptions::keep_ways.
ReachGraph find_islands(const QueryArgs& query, const ReachArgs& args, const Session& session, Summary& summary,
                        const std::string& command, bool keep_ways = false);

/// Returns the choice that the options describe. Call it before all work. Throws ArgumentError for values that cannot
/// be read, and for level robots.
IslandChoice island_choice(const QueryArgs& query, const IslandArgs& args, const CLI::App& command);

/// Returns the choice for a map: if no option about islands was given, and the map is of a scene without labels, only
/// the largest island, because robots would also stand on desks and wall tops. Throws ArgumentError for options about
/// the graph without effect: those of a command that needs no graph if all islands are selected.
IslandChoice choice_for(const Map& map, const QueryArgs& query, const IslandArgs& args, const CLI::App& command,
                        const IslandChoice& choice, bool needs_graph = false);

/// Returns the islands that are selected, in words: "island largest, reachable from 1,2". Empty: all islands.
std::string words_of(const IslandChoice& choice);

/// Returns whether islands are found in about a second: the graph is kept in the map's folder, or small.
bool are_islands_quick(const QueryArgs& query, const ReachArgs& args, const Session& session);

/// Prints a notice if spawns that were drawn from all islands stand on more than one. Does nothing if the graph is not
/// kept in the map's folder yet, and would take long.
void notice_about_islands(const QueryArgs& query, const IslandArgs& args, const Session& session,
                          const SpawnList& list);

/// The islands that a command uses.
struct ChosenIslands {
    std::optional<ReachGraph> graph = {};
    ReachFilter filter = {};    ///< empty: poses are not filtered
    std::string why_none = {};  ///< why no island was selected; empty if there is one, and without a filter
};

/// Finds the islands, selects some, and puts them into the summary. Does nothing if the choice selects all islands,
/// unless the graph is needed with its ways. Throws what chosen_islands() throws.
ChosenIslands choose_islands(const QueryArgs& query, const IslandArgs& args, const IslandChoice& choice,
                             const Session& session, Summary& summary, const std::string& command,
                             bool needs_ways = false);

/// Sets PlaceMeasures::room, if the measures ask for it. The graph must keep its ways.
void set_room(PlaceMeasures& measures, const ChosenIslands& chosen);

}  // namespace spawnfield::cli
