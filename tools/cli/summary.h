#pragma once

#include "common_args.h"

#include <spawnfield/output_file.h>
#include <spawnfield/query.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace spawnfield::cli {

/// The summary of a run: a line on standard error and, with --summary, JSON (docs/commands.md).
class Summary {
public:
    /// Opens the JSON file before all work, so that a wrong name leaves nothing half done. Throws OutputError.
    Summary(std::string command, const CommonArgs& args);

    /// The seconds since the last lap, which are returned, belong to this stage.
    double lap(const std::string& stage);
    void set_verdicts(const VerdictCounts& counts, std::uint64_t exact_checks);
    double seconds_of(const std::string& stage) const;
    double elapsed() const;  ///< seconds since the start
    unsigned threads() const;
    /// For a query's options; nullptr if the time of exact checks is not reported, because measuring it takes time.
    ExactTime* exact_time() { return args_.summary.empty() ? nullptr : &exact_time_; }

    std::uint64_t seed = 0;
    std::string map_hash;
    std::vector<std::string> changes;                         ///< of the map
    bool is_interrupted = false;                              ///< the result is a part of what was asked for
    std::vector<std::string> extra;                           ///< further words, at the beginning of the line
    std::optional<std::uint64_t> cells;                       ///< of an adaptive raster
    std::optional<double> offset;                             ///< m, of poses on layers
    std::vector<std::pair<std::string, double>> more_stages;  ///< of a bake: name and seconds
    struct Fullness {
        bool is_full;
        double undecided_area;  // m2; NaN: nothing is proven
    };
    std::optional<Fullness> fullness;  ///< of a sample
    /// For a sample or search: the number of draws, and how many were dropped for each reason.
    std::vector<std::pair<std::string, std::uint64_t>> draws;

    /// Of a check with --repair: numbers of poses, as in RepairList.
    struct Repairs {
        std::uint64_t repaired, turned, unrepaired;
    };
    std::optional<Repairs> repairs;

    void finish();  ///< prints the line and writes the JSON

private:
    std::string line(double total) const;
    std::string json(double total) const;

    std::string command_;
    const CommonArgs& args_;
    std::optional<OutputFile> file_;
    std::optional<VerdictCounts> counts_;
    std::uint64_t exact_checks_ = 0;
    ExactTime exact_time_;
    std::vector<std::pair<std::string, double>> seconds_;
    double start_, last_;
};

}  // namespace spawnfield::cli
