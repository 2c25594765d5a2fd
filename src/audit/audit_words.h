#pragma once

#include <spawnfield/audit.h>

namespace spawnfield {

/// Returns "1 island", "2 islands".
std::string counted_things(std::size_t count, const std::string& thing);

/// A finding of an audit, in words.
struct AuditFinding {
    std::string name;   ///< what it is about: names of parts
    std::string words;  ///< a sentence without a period at its end, and without the name
};

/// All findings of one kind.
struct FindingClass {
    std::string title;  ///< "floating props"
    std::string key;    ///< in JSON: "floating"
    std::string rule;   ///< key of the rule that limits them
    std::vector<AuditFinding> findings;
};

/// Returns the kinds of findings about the world's parts and files. Those about robots are closed rooms and bad poses.
std::vector<FindingClass> finding_classes(const AuditReport& report);

std::string words_of(const ClosedRoom& room);
std::string words_of(const BadPose& pose);  ///< the verdict, its cause and the repair

/// Returns what is wrong with a start pose for a robot, or nullptr if it is valid. `pose`: its index.
const BadPose* bad_pose_at(const RobotAudit& robot, std::size_t pose);

/// Returns "12.3 m2 (45 %)".
std::string area_words(double area, double share);

/// Returns how many pairs of meshes may overlap, but were not decided; empty if there is none.
std::string undecided_words(const AuditReport& report);

/// Returns whether a result is about this rule.
bool has_rule(const AuditReport& report, const std::string& rule);

}  // namespace spawnfield
