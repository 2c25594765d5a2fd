#pragma once

#include "workbench.h"

namespace bench {

/// A line of the table "Speed and memory to reach".
struct TargetRow {
    std::string scene = {}, work = {};
    int threads = 0;                             ///< 0: does not matter
    std::string target = {};                     ///< in words; empty for rows that only inform
    double measured = 0;                         ///< median
    std::string unit = {};                       ///< of `measured`: "s", "ms", "ms per 1,000", "MB", "times"
    std::optional<double> over_exhaustive = {};  ///< times that (a) takes for an item
    std::optional<double> over_fcl = {};         ///< times that (b) takes for an item
    std::optional<bool> reached = {};
    double memory = 0;  ///< bytes: of the whole process, or what a query took on top of scene and map
    std::optional<double> exact_share = {};  ///< of the items that FCL decided
};

struct TargetOptions {
    bool quick = false;  ///< small scenes: whether all of it works; nothing is judged
    bool most = false;   ///< with the landscape of 10 million triangles
    int rounds = 5;
    std::vector<int> threads = {1, 2};               ///< the last is all cores
    std::function<void(const TargetRow&)> tell;      ///< hears of each row as soon as it is known
    std::function<void(const std::string&)> remark;  ///< and of how far the alternatives' verdicts agree
};

/// Measures every row. Whole programs come first, as long as this process is small (process.h,
/// ProcessRun::peak_memory).
std::vector<TargetRow> measure_targets(const TargetOptions& options);

/// What `--write-maps` prints of each map, and the measurement of whole programs reads.
struct BakedMap {
    std::filesystem::path folder = {};
    double seconds = 0;       ///< of the bake alone
    std::uint64_t bytes = 0;  ///< on disk
};
std::string to_line(const BakedMap& map);
BakedMap bake_setting(const Setting& setting, const std::filesystem::path& parent, int threads);

std::string target_head();
std::string target_line(const TargetRow& row);
std::string target_csv(const std::vector<TargetRow>& rows);

}  // namespace bench
