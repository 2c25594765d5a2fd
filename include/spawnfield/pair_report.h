#pragma once

#include <spawnfield/export.h>
#include <spawnfield/pair_files.h>

#include <functional>

namespace spawnfield {

/// The pairs of a file, and what judge_pairs() says about them. Refers to all of them.
struct PairReport {
    const PairTable& table;
    const std::vector<JudgedPair>& pairs;  ///< one for each row of the table
    const Judge& judge;
    const PairOptions& options;  ///< those of judge_pairs()
};

/// Returns the verdict on a pair of the report and its cause in words.
SPAWNFIELD_API std::string reason(const PairReport& report, std::size_t index);

/// Returns the table with pair_verdict, start_verdict, goal_verdict (Verdict, by name), path_length, straight, detour,
/// island (empty unless both are on it), and start_hit, goal_hit, start_reason, goal_reason, pair_reason, in the place
/// of columns with these names. `start_hit` and `goal_hit` are names of parts; reasons are empty for what is valid.
SPAWNFIELD_API std::string judged_pairs_csv(const PairReport& report);

/// Writes JSON in the format spawnfield-pair-verdicts/1: the map, robot and settings, and the counts. For each pair, it
/// has one line with the row, name, verdict and reason, `start` and `goal` as the poses of write_verdicts_json(), the
/// lengths and the islands, and the fields of the row as text. Passes the text to `sink` in pieces.
SPAWNFIELD_API void write_judged_pairs_json(const PairReport& report,
                                            const std::function<void(std::string_view)>& sink);

/// Writes JUnit XML as write_verdicts_junit() does, with one test case for each pair.
SPAWNFIELD_API void write_judged_pairs_junit(const PairReport& report,
                                             const std::function<void(std::string_view)>& sink);

}  // namespace spawnfield
