#pragma once

#include "query_args.h"
#include "summary.h"

namespace spawnfield::cli {

/// Which ground poses stand on, and how high above it: options of `sample`, `raster`, `heatmap`, `export` and
/// `experiment`.
struct GroundArgs {
    std::string offset = "auto", layers = "all", z;
    int floor = -1;  ///< -1: not given
};

/// Adds --offset, --layers, --floor and --z. `layers_help` is the text of --layers.
void add_ground(CLI::App& command, GroundArgs& args, const std::string& layers_help);

/// Reads "LOW:HIGH" in m; one of them may be missing: "5:", ":8". Throws ArgumentError.
ZRange parse_z(const std::string& option, const std::string& text);

/// Returns the text that parse_z() reads.
std::string z_text(const ZRange& z);

/// Reads metres, or "auto", which gives nothing. Throws ArgumentError.
std::optional<double> parse_offset(const std::string& text);

/// Returns the heights of --z, or of six numbers in `bounds` (the value of `bounds_option`). Throws ArgumentError for
/// both.
ZRange heights_of(const GroundArgs& args, const Bounds& bounds, const std::string& bounds_option);

/// Returns these heights, or those of --floor. Throws ArgumentError for a floor that the map does not have, and for
/// both.
ZRange with_floor(const ZRange& heights, const GroundArgs& args, const Map& map);

/// Returns the bounds with finite limits in z: those of `heights`, or else those of the bounds, or else those of the
/// map. Empty bounds stay empty if the heights are unlimited.
Bounds with_heights(const Bounds& bounds, const ZRange& heights, const Map& map);

/// Returns "floor 1 at 5.2 m" or "heights 2:4 m", for captions; empty if the heights are unlimited.
std::string height_words(const GroundArgs& args, const ZRange& heights, const Map& map);

/// Returns the robot's offset, m (no value wanted: auto), and puts it into the summary. Throws ArgumentError if it is
/// above --max-height, because `check` would call such poses aerial.
double choose_offset(const QueryArgs& args, const std::optional<double>& wanted, const Robot& robot, Summary& summary);

/// Returns why no pose on flat ground can be valid: the robot reaches down to its layer or below. Empty if it does not.
std::string flat_ground_complaint(const Robot& robot, double offset);

/// Throws NothingFits with that complaint, if there is one.
void require_above_ground(const Robot& robot, double offset);

}  // namespace spawnfield::cli
