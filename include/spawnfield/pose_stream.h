#pragma once

#include <spawnfield/export.h>
#include <spawnfield/poses.h>

#include <cstddef>
#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <string>

namespace spawnfield {

/// Reads the poses of a file (see read_poses()) part by part, so that the memory does not grow with the number of
/// poses. Files of JSON are read as a whole.
class SPAWNFIELD_API PoseStream {
public:
    static constexpr std::size_t all = std::numeric_limits<std::size_t>::max();

    /// Copies the next bytes of a text to a buffer of this size, and returns their number; 0: it has ended.
    using Source = std::function<std::size_t(char* to, std::size_t size)>;

    /// Reads the start of the file. Throws FileError.
    explicit PoseStream(const std::filesystem::path& file, bool allow_empty = false);
    /// Reads a text. Messages use `name` as the file's name. Names of columns begin with `prefix`; a text with a prefix
    /// is never JSON.
    PoseStream(Source source, std::string name, bool allow_empty = false, std::string prefix = {});
    PoseStream(PoseStream&&) noexcept;
    PoseStream& operator=(PoseStream&&) noexcept;
    ~PoseStream();

    /// Returns the next poses, at most `most`; fewer only at the end of the file. Each part has the header. The first
    /// part has the notices about columns, the last one those about values. Several threads (0: all cores) read the
    /// numbers. Throws FileError, which names line and column.
    PoseTable next(std::size_t most = all, int threads = 1);

    /// Returns whether next() has returned the last poses.
    bool has_ended() const;

    /// Returns the share of the file that was read, 0 to 1; NaN if its size is not known.
    double share() const;

private:
    class Impl;
    std::unique_ptr<Impl> impl_;
    double size_ = std::numeric_limits<double>::quiet_NaN();  ///< bytes of the file
};

}  // namespace spawnfield
