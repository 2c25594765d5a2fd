#pragma once

#include "query_args.h"
#include "summary.h"

#include <spawnfield/pose_stream.h>
#include <spawnfield/poses.h>
#include <spawnfield/verdict_report.h>

#include <optional>

namespace spawnfield::cli {

/// The map and the robot of a command.
struct Session {
    Map map;
    Robot robot;
    std::optional<Judge> judge;  ///< nothing if the command was given no robot
};

/// Reads the map and the robot, and puts the map's hash into the summary. The time of exact checks is added to the
/// summary, too. Without --robot, in commands that allow this, reads only the map. Throws ArgumentError for limits out
/// of range, before it reads anything.
Session open_session(const QueryArgs& args, Summary& summary);

/// Reads a robot or a scene; in a process of its own, if the host has one and --trusted was not given.
Robot read_robot(const CommonArgs& args, const std::string& file, const RobotOptions& options);
Scene read_scene(const CommonArgs& args, const std::string& file, const SceneOptions& options);

/// Reads a robot, and prints its notices. A robot in memory (Host::inputs) is used as it is.
Robot open_robot(const CommonArgs& args, const std::string& file, const RobotOptions& options);

/// Reads a scene, and prints its notices. A scene in memory is used as it is.
Scene open_scene(const CommonArgs& args, const std::string& file, const SceneOptions& options);

/// Reads poses from a CSV file, or from standard input if it is `-`. Prints the file's notices.
PoseTable open_poses(const CommonArgs& args, const std::string& file);

/// The same part by part. A table in memory is one part.
class PoseParts {
public:
    PoseParts(const CommonArgs& args, const std::string& file, std::size_t poses_of_part);

    /// Returns whether a part is left; true at first, even if it has no poses.
    bool has_next() const { return !has_ended_; }
    /// Returns the next part, and prints its notices.
    PoseTable next();
    /// Returns the share of the file that was read, 0 to 1; NaN if its size is not known.
    double share() const;

private:
    const CommonArgs& args_;
    const PoseTable* const in_memory_;
    std::optional<PoseStream> stream_;
    const std::size_t poses_of_part_;
    bool has_ended_ = false;
};

/// Returns how many poses are tilted.
std::uint64_t count_tilted(const PoseTable& table);

/// Prints a notice if poses are tilted although the robot is let down level.
void notice_about_tilted(const CommonArgs& args, const std::string& file, std::uint64_t tilted);

/// How many poses are not valid and not repaired, and why the first ones are not valid.
class NotValid {
public:
    void add(const VerdictReport& report);
    bool is_empty() const { return count_ == 0; }
    std::string words() const;

private:
    static constexpr std::size_t shown = 5;
    std::uint64_t count_ = 0, all_ = 0;
    bool with_repairs_ = false;
    std::string first_;
};

/// Prints a notice if a rule needs obstacles, and the map has none.
void notice_about_heading(const CommonArgs& args, const Map& map, const std::optional<HeadingRule>& rule);

/// Print a notice if the answer is known without a query: the region lies off the map, or no column has that layer.
void notice_if_off_map(const CommonArgs& args, const Map& map, const std::string& option, const Bounds& bounds);
void notice_if_no_layer(const CommonArgs& args, const Map& map, const LayerChoice& layers);

}  // namespace spawnfield::cli
