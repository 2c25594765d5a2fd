#pragma once

#include <spawnfield/export.h>
#include <spawnfield/poses.h>

namespace spawnfield {

/// The poses of a table, their judgements, and the judge that made them. Refers to all of them.
struct VerdictReport {
    const PoseTable& table;
    const std::vector<Judgement>& judgements;  ///< one for each pose of the table
    const Judge& judge;
    /// If given: how the robots rest that were let down at the poses, one for each. The judgements are of these.
    const std::vector<SettledPose>* settled = nullptr;
    const RepairList* repairs = nullptr;  ///< if given: the repairs of the poses
    /// If the table is one part of a longer one (PoseStream): the number of poses before it.
    std::size_t first = 0;
};

/// Returns a name for each pose: the text in the table's column `name`, or "pose N" if there is none; N begins with 1.
/// If several poses of the table have the same name, " (pose N)" is added to it.
/// `first`: how many poses come before the table.
SPAWNFIELD_API std::vector<std::string> pose_names(const PoseTable& table, std::size_t first = 0);

/// Returns the verdict on a pose of the report and its cause in words.
SPAWNFIELD_API std::string reason(const VerdictReport& report, std::size_t index);

/// Returns whether a pose of the report is not valid and has no repair.
SPAWNFIELD_API bool remains_invalid(const VerdictReport& report, std::size_t index);

/// Writes verdicts_csv() or, if the robots were let down, settled_csv(). Parts of a table that are written one after
/// the other make the same text as the whole table. Passes the text to `sink` in pieces. Several threads make it (0:
/// all cores); it is the same for any number of them.
SPAWNFIELD_API void write_verdicts_csv(const VerdictReport& report, const std::function<void(std::string_view)>& sink,
                                       int threads = 1);

/// Writes JSON in the format spawnfield-verdicts/1: the map, robot and settings, and the counts. For each pose, it has
/// one line with the row, name, pose, verdict, ground, hit, the settled pose and the repair if there is one, and the
/// fields of the row as text. Passes the text to `sink` in pieces.
SPAWNFIELD_API void write_verdicts_json(const VerdictReport& report, const std::function<void(std::string_view)>& sink);

/// Writes JUnit XML that Jenkins and GitLab read, with one test case for each pose; the test case fails if the pose is
/// not valid. Characters that XML cannot contain are replaced. All times are 0, so that the same report gives the same
/// bytes.
SPAWNFIELD_API void write_verdicts_junit(const VerdictReport& report,
                                         const std::function<void(std::string_view)>& sink);

}  // namespace spawnfield
