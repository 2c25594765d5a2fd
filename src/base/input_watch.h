#pragma once

#include <spawnfield/export.h>

#include <cstdint>
#include <filesystem>

namespace spawnfield {

/// Follows which files are read. Only a process that reads files for another one has a watch (apart/reader_limits.h).
class InputWatch {
public:
    virtual ~InputWatch() = default;
    /// A regular file of this size is about to be opened. Files may be opened several times.
    virtual void opens(const std::filesystem::path& file, std::uint64_t bytes) = 0;
    /// A foreign library, the `reader` ("mesh reader"), begins to read a file.
    virtual void begins(const char* reader, const std::filesystem::path& file) = 0;
    /// It has ended. `has_failed`: by an exception.
    virtual void ends(bool has_failed) = 0;
};

/// Sets the watch of this process. It must live until the process ends.
void set_input_watch(InputWatch& watch);

/// Calls InputWatch::opens() for a regular file that is about to be opened; does nothing without a watch.
SPAWNFIELD_MODULE_API void count_input(const std::filesystem::path& file);

/// As long as this object lives, a foreign library reads a file: calls InputWatch::begins() and ends().
class ForeignReading {
public:
    ForeignReading(const char* reader, const std::filesystem::path& file);
    ForeignReading(const ForeignReading&) = delete;
    ForeignReading& operator=(const ForeignReading&) = delete;
    ~ForeignReading();
};

}  // namespace spawnfield
