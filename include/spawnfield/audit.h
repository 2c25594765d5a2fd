#pragma once

#include <spawnfield/export.h>
#include <spawnfield/part_findings.h>
#include <spawnfield/query.h>
#include <spawnfield/reach.h>
#include <spawnfield/repair.h>

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// Worlds as a test suite: what a robot can do in a world, what is wrong with the world, and whether it complies with
/// rules. See docs/audit.md.
namespace spawnfield {

/// A start pose with its name.
struct NamedPose {
    std::string name;
    Pose pose;
};

/// Rules that a world must comply with. A rule without a value does not count. See docs/audit.md for the file.
struct AuditRules {
    std::optional<double> min_free_area = {};                            ///< m2, of each robot
    std::optional<std::size_t> max_islands = {}, max_closed_rooms = {};  ///< of each robot
    std::optional<std::size_t> max_overlaps = {}, max_floating = {}, max_sunken = {}, max_missing = {};
    std::vector<NamedPose> poses = {};       ///< `require`: poses that are given by their numbers
    std::vector<std::string> required = {};  ///< `require`: names of further poses
    bool requires_all = false;               ///< `require: all`: all poses that are given
    std::vector<std::string> allow = {};     ///< globs of parts that are in no finding
};

/// Reads a file of rules. Throws FileError, which names the key, the value and what is allowed.
SPAWNFIELD_API AuditRules read_audit_rules(const std::filesystem::path& file);

struct AuditOptions {
    /// m between the columns of the raster of free area, > 0. No value: auto_audit_step().
    std::optional<double> step = {};
    ReachOptions reach = {};            ///< of islands
    double min_room = 1;                ///< m2, >= 0: smallest area of a closed room
    std::vector<NamedPose> poses = {};  ///< start poses, which each robot is let down at
    double repair = 1;                  ///< m, > 0: radius in which the nearest valid pose is searched
    int threads = 0;                    ///< 0: all cores; results are the same for any number
    Progress progress = {};
};

/// Returns the step with which the longer side of the map has 150 columns, but at least the map's resolution, m.
SPAWNFIELD_API double auto_audit_step(const Map& map);

/// A start pose at which a robot cannot start.
struct BadPose {
    std::size_t pose = 0;  ///< index in AuditOptions::poses
    Verdict verdict = Verdict::Outside;
    std::string reason;   ///< the verdict and its cause in words
    std::string culprit;  ///< name of the part that the robot meets; empty: none, or it is not known
    Repair repair;        ///< the nearest valid pose
};

/// Ground on which a robot can stand, but that it cannot leave.
struct ClosedRoom {
    std::size_t island = 0;     ///< index in ReachGraph::islands()
    double area = 0;            ///< m2, of the places that belong to no larger island
    Vec3 place = Vec3::Zero();  ///< Island::place
};

/// What one robot can do in a world.
struct RobotAudit {
    Judge judge;
    RasterResult raster;  ///< settled, at yaw 0
    /// Horizontal area of the valid poses of the raster: their number, multiplied by step * step, m2.
    double free_area = 0;
    double free_share = 0;  ///< of all poses of the raster, 0 .. 1; 0 without poses
    ReachGraph graph;
    std::vector<ClosedRoom> closed_rooms = {};
    std::vector<BadPose> bad_poses = {};  ///< in the order of the poses
    std::string notice = {};              ///< of the kept graph; may be empty
};

/// Returns the islands, except the largest one, on which the robot has room to turn: at one place or more, it can stand
/// at all 16 headings of the graph, and all of these states are on the island. (Otherwise, strips along walls would be
/// rooms.) `min_area`: m2 of places that belong to no larger island. The largest first.
SPAWNFIELD_API std::vector<ClosedRoom> closed_rooms(const ReachGraph& graph, double min_area);

/// Returns what the robot of a judge can do in its map. Throws ArgumentError for options beyond their limits, and
/// FileError for a damaged map.
SPAWNFIELD_API RobotAudit audit_robot(const Judge& judge, const AuditOptions& options = {});

/// A rule, and whether the world complies with it.
struct RuleResult {
    std::string rule;     ///< its key in the file: "min_free_area", …
    std::string subject;  ///< the robot, or "POSE, ROBOT"; empty: the rule is about the world
    bool is_kept = false;
    std::string words;  ///< "free area of husky is 12.3 m2, at least 20 m2 are needed"
};

/// The report about a world.
struct AuditReport {
    Map map = {};
    std::vector<RobotAudit> robots = {};
    std::vector<NamedPose> poses = {};  ///< AuditOptions::poses of all robots
    PartFindings parts = {};
    PartLimits part_limits = {};
    double min_room = 1;
    /// Scene::missing. No value: the map was read from a folder, which does not say what was missing.
    std::optional<std::vector<std::string>> missing = {};
    std::vector<RuleResult> rules = {};
};

/// Returns the poses that the rules and a list name, without duplicates: those of the list, then those of the rules,
/// with names like "require 1". Throws ArgumentError if the rules name a pose that is not in the list.
SPAWNFIELD_API std::vector<NamedPose> audited_poses(const AuditRules& rules, const std::vector<NamedPose>& listed);

/// Returns the results of all rules that have a value, in the order of AuditRules. Poses of the report must be
/// audited_poses(). max_missing is broken if the report does not know what is missing.
SPAWNFIELD_API std::vector<RuleResult> results_of(const AuditRules& rules, const AuditReport& report);

/// Returns the report for people: a few lines for each robot, then the findings and the rules.
SPAWNFIELD_API std::string audit_text(const AuditReport& report);

// The following functions pass their text to `sink` in pieces. Names are escaped. The same report gives the same bytes.

/// Writes JSON in the format spawnfield-audit/1.
SPAWNFIELD_API void write_audit_json(const AuditReport& report, const std::function<void(std::string_view)>& sink);

/// Writes JUnit XML: a test case for each rule, for each pose and robot, and for each kind of finding. Cases of rules
/// fail if the rule is broken. Cases of poses and findings fail if there is something to report and no rule is about
/// it.
SPAWNFIELD_API void write_audit_junit(const AuditReport& report, const std::function<void(std::string_view)>& sink);

/// Writes one HTML file that contains its pictures, a heat map and the islands of each robot, and the review page of
/// each robot, if the library has it. It loads nothing from elsewhere. Throws OutputError if the temporary folder
/// cannot be written.
SPAWNFIELD_API void write_audit_html(const AuditReport& report, const std::function<void(std::string_view)>& sink,
                                     int threads = 0);

}  // namespace spawnfield
