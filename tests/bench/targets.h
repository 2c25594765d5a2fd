#pragma once

#include "workbench.h"

#include <algorithm>

namespace bench {

/// A row of the table of targets for speed and memory.
struct TargetRow {
    std::string scene = {}, work = {};
    int threads = 0;                             ///< 0: not applicable
    std::string target = {};                     ///< as text; empty for rows without a target
    double measured = 0;                         ///< median
    std::string unit = {};                       ///< of `measured`: "s", "ms", "ms per 1,000", "MB", "times"
    std::optional<double> over_exhaustive = {};  ///< time per item of (a), the exhaustive query, divided by ours
    std::optional<double> over_fcl = {};         ///< time per item of (b), PlainFcl, divided by ours
    /// Time per item of (d), EmbreeOnly, divided by ours; of a raster in this process with its faster search.
    std::optional<double> over_embree = {};
    std::optional<double> over_embree_query = {};  ///< the same for the search that Embree has
    std::optional<bool> reached = {};
    double memory = 0;  ///< bytes of the whole process, or bytes that a query needed in addition to scene and map
    std::optional<double> exact_share = {};  ///< share of the items that FCL decided
};

struct TargetOptions {
    bool quick = false;    ///< small scenes, without targets: only shows that everything works
    bool largest = false;  ///< also measures the landscape of 10 million triangles
    int rounds = 5;
    std::vector<int> threads = {1, 2};             ///< the last one is the number of cores
    std::function<void(const TargetRow&)> on_row;  ///< is called with each row as soon as it is known
    /// Is called with texts that compare the verdicts of the alternatives with ours.
    std::function<void(const std::string&)> on_comparison;

    /// Returns the number of rounds of what takes some milliseconds: few of them are noise.
    int rounds_of_short_runs() const { return quick ? rounds : std::max(rounds, 20); }
};

/// Measures every row. Whole programs come first, while this process is still small (see ProcessRun::peak_memory).
std::vector<TargetRow> measure_targets(const TargetOptions& options);

/// What `spawnfield_bench --write-maps` prints for each map, in one line. measure_targets() reads these lines.
struct BakedMap {
    std::filesystem::path folder = {};
    double seconds = 0;       ///< time of the bake only
    std::uint64_t bytes = 0;  ///< on disk
};
std::string to_line(const BakedMap& map);
BakedMap bake_setting(const Setting& setting, const std::filesystem::path& parent, int threads);

std::string target_head();
std::string target_line(const TargetRow& row);
std::string target_csv(const std::vector<TargetRow>& rows);

}  // namespace bench
