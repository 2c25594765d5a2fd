#pragma once

#include <spawnfield/export.h>

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace spawnfield {

class Descriptor;

/// Returns whether the file exists as a pipe or a device, or is a system link to standard output (/dev/stdout,
/// /proc/self/fd/1), even if that is redirected to a regular file. OutputFile writes such files directly.
SPAWNFIELD_API bool is_written_directly(const std::filesystem::path& file);

/// A file that appears complete or not at all. It is written beside its final name, and commit() renames it. Without
/// commit(), it is removed; if the process was killed, the next OutputFile of this name removes it. A pipe or device
/// (for example /dev/null, /dev/stdout) is written directly. If the name is a link, the target of the link is written.
/// Only one thread at a time may use it. Throws OutputError if writing fails.
class SPAWNFIELD_API OutputFile {
public:
    explicit OutputFile(std::filesystem::path file);  ///< throws OutputError
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;
    ~OutputFile();

    /// For code that opens the file by its name instead of calling write(). It must finish before flush() or commit().
    const std::filesystem::path& path() const { return written_; }
    void write(std::string_view bytes);  ///< throws OutputError
    void flush();                        ///< after this, only the renaming can still fail; throws OutputError
    void commit();                       ///< throws OutputError

    /// Gives all files their names, or none. If a file cannot get its name, the old files come back. Returns notices
    /// for the user: old files that could not be removed. Throws OutputError.
    static std::vector<std::string> commit_together(std::span<OutputFile* const> files);

private:
    void open_directly();
    void open_beside();
    void keep_old();  ///< gives the old file a second name beside it
    void put_old_back() noexcept;
    std::string forget_old();  ///< returns a notice; empty if there is none
    void write_through(std::string_view bytes);
    [[noreturn]] void fail(const std::string& reason) const;

    std::filesystem::path file_;     ///< the name that the caller gave
    std::filesystem::path written_;  ///< the file that is written
    std::filesystem::path target_;   ///< the name that it gets in commit(); empty if it is written directly
    /// The other name of the old file, during commit_together(); empty if there was no old file.
    std::filesystem::path old_;
    std::unique_ptr<Descriptor> descriptor_;  ///< of the file that is written, with its lock; empty after commit()
    std::unique_ptr<Descriptor> old_lock_;    ///< of the old file, during commit_together()
    std::string waiting_;                     ///< bytes that are not written yet
};

/// Writes all bytes of a file at once. Throws OutputError.
SPAWNFIELD_API void write_file_atomically(const std::filesystem::path& file, std::string_view bytes);

}  // namespace spawnfield
