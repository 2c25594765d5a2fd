#pragma once

#include "base/input_watch.h"
#include "base/sanitized.h"

#include <limits>
#include <set>
#include <vector>

namespace spawnfield {

/// The state of a reader process, in memory that it shares with its parent. After a crash, the parent can still read
/// it.
struct ReaderStatus {
    std::uint64_t answer_bytes = 0;
    double seconds = 0;            ///< limit of processor time, s
    double gigabytes = 0;          ///< limit of memory, GB
    std::uint64_t is_given = 0;    ///< 1: that limit is ReaderProcess::max_memory, 0: that for files of this size
    char reader[32] = {};          ///< the foreign library that reads, or that failed; empty: none
    char file[4096 - 4 * 8 - 32];  ///< the file that it reads; ends in 0
};
static_assert(sizeof(ReaderStatus) == 4096);

/// Limits the memory and the stack of this process, and the processor time of each reading by a foreign library; own
/// code, for example splitting the meshes of a robot, may take as long as it needs. The limits grow with the size of
/// the files that are opened; each file counts once. Builds with a sanitizer have no limit of memory, because the
/// sanitizer's own is much larger.
class ReaderLimits : public InputWatch {
public:
    /// Sets the limits that hold while small files are read. `status` must live as long as this.
    explicit ReaderLimits(ReaderStatus& status);

    /// From now on opens() throws FileError for files outside of these folders, after links are resolved.
    void confine(const std::vector<std::filesystem::path>& folders);
    /// From now on, the process gets at most so much memory, bytes.
    void limit_memory_to(double bytes);
    /// Returns all files that were opened, without links.
    const std::set<std::filesystem::path>& files() const { return files_; }

    void opens(const std::filesystem::path& file, std::uint64_t bytes) override;
    void begins(const char* reader, const std::filesystem::path& file) override;
    void ends(bool has_failed) override;

private:
    void limit_memory();
    void limit_time();

    ReaderStatus& status_;
    std::set<std::filesystem::path> files_;        ///< without links
    std::vector<std::filesystem::path> confined_;  ///< folders without links; empty: all files are allowed
    std::uint64_t bytes_ = 0;                      ///< of all files
    double most_memory_ = std::numeric_limits<double>::infinity();  ///< bytes
    bool is_reading_ = false;                                       ///< a foreign library reads
    /// What it has opened since it began.
    std::set<std::filesystem::path> its_files_;
    std::uint64_t its_bytes_ = 0;
    double began_at_ = 0;    ///< processor time of this process, s
    const double at_start_;  ///< memory of this process when it began, bytes
};

}  // namespace spawnfield
