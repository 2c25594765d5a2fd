#pragma once

#include "common/machine.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace bench {

using tools::formatted;
using tools::machine;

/// The result of one run of a stage.
struct Measurement {
    std::uint64_t items = 0;  ///< cells, poses, draws, …
    double seconds = 0;
    std::uint64_t hash = 0;          ///< of the bytes of the result
    std::uint64_t exact_checks = 0;  ///< items that FCL decided
};

/// All rounds of a stage of a scene with one number of threads.
struct Row {
    std::string scene, stage;
    int threads = 1;
    std::uint64_t items = 0, hash = 0, exact_checks = 0;
    double least = 0, median = 0;   ///< s
    std::uint64_t peak_memory = 0;  ///< bytes of the whole process during these rounds
    std::uint64_t own_memory = 0;   ///< bytes that the first run needed beyond those in use before; 0 if unknown

    double per_second() const { return double(items) / least; }
    double seconds_per_item() const { return median / double(items); }
};

/// Returns the row of all rounds. Throws std::runtime_error if a round processed no items or had another result than
/// the others.
Row row_of(const std::string& scene, const std::string& stage, int threads, const std::vector<Measurement>& rounds);

double median(std::vector<double> values);  ///< of at least one value

/// Returns how many times as long as `row` the other row takes for an item (medians).
inline double times_slower(const Row& other, const Row& row)
{
    return other.seconds_per_item() / row.seconds_per_item();
}

/// Throws std::runtime_error if the results of a stage differ between numbers of threads.
void check_same(const std::vector<Row>& rows);

std::string table_head();
std::string table_line(const Row& row);
std::string csv(const std::vector<Row>& rows);

/// Starts a new peak of memory if the kernel allows it. If not, the peak is that of the whole run.
void reset_peak_memory();
std::uint64_t peak_memory_bytes();

}  // namespace bench
