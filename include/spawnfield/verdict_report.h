#pragma once

#include <spawnfield/export.h>
#include <spawnfield/poses.h>

namespace spawnfield {

/// Poses of a table with their judgements, and who judged them. Refers to all of it.
struct VerdictReport {
    const PoseTable& table;
    const std::vector<Judgement>& judgements;  ///< one for each pose of the table
    const Judge& judge;
};

/// Returns a name for each pose: the table's column `name`, or "pose N" (N from 1) where it has none. " (pose N)" is
/// added to names that occur more than once.
SPAWNFIELD_API std::vector<std::string> pose_names(const PoseTable& table);

/// Writes JSON, format spawnfield-verdicts/1: what the poses were judged against, counts, and for each pose its row,
/// name, pose, verdict, ground, hit and the fields of its row as text, on one line. `sink` gets the text in pieces.
SPAWNFIELD_API void write_verdicts_json(const VerdictReport& report, const std::function<void(std::string_view)>& sink);

/// Writes JUnit XML, as Jenkins and GitLab read it: one test case for each pose, which fails if the pose is not valid.
/// Characters that XML cannot hold are replaced. All times are 0, so that the same report gives the same bytes.
SPAWNFIELD_API void write_verdicts_junit(const VerdictReport& report,
                                         const std::function<void(std::string_view)>& sink);

}  // namespace spawnfield
