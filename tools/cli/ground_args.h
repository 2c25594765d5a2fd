#pragma once

#include "cli.h"

namespace spawnfield::cli {

/// Which ground poses stand on, and how high above it: options of `sample`, `raster`, `heatmap`, `export` and
/// `experiment`.
struct GroundArgs {
    std::string offset = "auto", layers = "all", z;
    int floor = -1;  ///< -1: not given
};

/// --offset, --layers, --z and --floor. `layers_help` says what the default layers are.
void add_ground(CLI::App& command, GroundArgs& args, const std::string& layers_help);

/// "LOW:HIGH" in m; one of them may be missing: "5:", ":8". Throws ArgumentError.
ZRange parse_z(const std::string& option, const std::string& text);

/// As parse_z() reads it.
std::string z_text(const ZRange& z);

/// "auto", which gives nothing, or metres. Throws ArgumentError.
std::optional<double> parse_offset(const std::string& text);

/// Heights of --z, or of six numbers in `bounds` (an option named `bounds_option`), not of both: throws ArgumentError.
ZRange heights_of(const GroundArgs& args, const Bounds& bounds, const std::string& bounds_option);

/// These heights, or those of --floor. Throws ArgumentError for a floor that the map does not have, or both given.
ZRange with_floor(const ZRange& heights, const GroundArgs& args, const Map& map);

/// The bounds with finite limits in z: those of `heights` where it has some, else the bounds' own, else the map's.
/// Empty bounds stay empty if the heights are unlimited.
Bounds with_heights(const Bounds& bounds, const ZRange& heights, const Map& map);

/// "floor 1 at 5.2 m" or "heights 2:4 m", for people; empty if the heights are unlimited.
std::string height_words(const GroundArgs& args, const ZRange& heights, const Map& map);

/// The offset that a robot gets, m; nothing wanted: auto. The summary contains it, as a number and in words. Throws
/// ArgumentError if it is above --max-height, because `check` would call such poses aerial.
double choose_offset(const QueryArgs& args, const std::optional<double>& wanted, const Robot& robot, Summary& summary);

/// Why no pose on flat ground can be valid: the robot reaches down to its layer or below. Empty if it does not.
std::string flat_ground_complaint(const Robot& robot, double offset);

/// Throws NothingFits with that complaint, if there is one.
void require_above_ground(const Robot& robot, double offset);

}  // namespace spawnfield::cli
