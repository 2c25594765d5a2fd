#pragma once

#include "command.h"
#include "pair_args.h"
#include "reach_args.h"

#include <spawnfield/pair_files.h>

namespace spawnfield::cli {

/// Options of `check --pairs`.
struct CheckPairsArgs {
    std::string file;
    PairArgs limits;
    ReachArgs reach;
};

/// Reads a file of pairs, and prints notices about it.
PairTable open_pairs(const CommonArgs& common, const std::string& file);

/// Adds --pairs and the options that belong to it.
void add_check_pairs(CLI::App& command, CheckPairsArgs& args);

/// Throws ArgumentError if one of these options was given without --pairs.
void refuse_check_pairs_options(const CLI::App& command);

/// How `check` writes its result.
struct PairOutput {
    std::string file, format;  ///< format: csv, json or junit
    bool require_valid = false;
};

/// Judges the pairs of a file, and writes them. The robot is let down, so `query` must be for settled robots.
Ending run_check_pairs(const QueryArgs& query, const CheckPairsArgs& args, const CLI::App& command,
                       const PairOutput& output, Summary& summary);

}  // namespace spawnfield::cli
