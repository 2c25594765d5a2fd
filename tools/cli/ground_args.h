#pragma once

#include "query_args.h"
#include "summary.h"

namespace spawnfield::cli {

/// Options for the ground on which poses stand, and for their height above it. For `sample`, `raster`, `heatmap`,
/// `export` and `experiment`.
struct GroundArgs {
    std::string offset = "auto", layers = "all", z;
    int floor = -1;  ///< -1: not given
};

/// Adds --offset, --layers, --floor and --z. `layers_help` is the text of --layers.
void add_ground(CLI::App& command, GroundArgs& args, const std::string& layers_help);

/// Reads "LOW:HIGH" in m. LOW or HIGH may be missing: "5:", ":8". Throws ArgumentError.
ZRange parse_z(const std::string& option, const std::string& text);

/// Returns the text that parse_z() reads.
std::string z_text(const ZRange& z);

/// Reads metres. Returns nothing for "auto". Throws ArgumentError.
std::optional<double> parse_offset(const std::string& text);

/// Returns the value of --offset, m; nothing for "auto" and for settled robots. Throws ArgumentError if it was given
/// for settled robots.
std::optional<double> given_offset(const QueryArgs& args, const GroundArgs& ground, const CLI::App& command);

/// Sets the stance of RasterOptions or SampleOptions, and their offset to given_offset(). When the robot is known,
/// choose_offset() completes it.
template <class Options>
void set_stance(Options& options, const QueryArgs& args, const GroundArgs& ground, const CLI::App& command)
{
    options.stance = args.stance();
    options.offset = given_offset(args, ground, command);
}

/// Returns the heights that --z gives, or those in `bounds`, the value of `bounds_option`. Throws ArgumentError if both
/// limit the heights.
ZRange heights_of(const GroundArgs& args, const Bounds& bounds, const std::string& bounds_option);

/// Returns the heights of --floor if it was given, else `heights`. Throws ArgumentError if the map does not have this
/// floor, or if both limit the heights.
ZRange with_floor(const ZRange& heights, const GroundArgs& args, const Map& map);

/// Returns the bounds with finite limits in z: those of `heights`, or else those of the bounds, or else those of the
/// map. Empty bounds stay empty if the heights are unlimited.
Bounds with_heights(const Bounds& bounds, const ZRange& heights, const Map& map);

/// Returns "floor 1 at 5.2 m" or "heights 2:4 m", for captions; empty if the heights are unlimited.
std::string height_words(const GroundArgs& args, const ZRange& heights, const Map& map);

/// Returns the offset of level robots, m: `wanted`, or the robot's auto offset if that is empty. Returns nothing for
/// settled robots. Puts the offset, or that the robots are settled, into the summary. Throws ArgumentError if robots on
/// level ground are above --max-height, because `check` would call such poses aerial.
std::optional<double> choose_offset(const QueryArgs& args, const std::optional<double>& wanted, const Robot& robot,
                                    Summary& summary);

/// If the robot reaches down to its layer or below, returns the reason why no pose on flat ground can be valid. Else
/// returns an empty text.
std::string flat_ground_complaint(const Robot& robot, double offset);

/// Throws NothingFits with the text of flat_ground_complaint(), unless that is empty. Settled robots have no offset,
/// and are always above their ground.
void require_above_ground(const Robot& robot, const std::optional<double>& offset);

}  // namespace spawnfield::cli
