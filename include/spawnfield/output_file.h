#pragma once

#include <spawnfield/export.h>

#include <filesystem>
#include <fstream>
#include <span>
#include <string_view>

namespace spawnfield {

/// A file that appears whole or not at all: written beside its name, renamed by commit(), removed if that never comes.
/// What is no regular file (a pipe, /dev/null, /dev/stdout) is written directly; of a link, what it leads to is
/// written. One thread at a time may use it. What it cannot write is an OutputError.
class SPAWNFIELD_API OutputFile {
public:
    explicit OutputFile(std::filesystem::path file);  ///< throws OutputError
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;
    ~OutputFile();

    /// For what writes by name instead of write(), before flush() or commit().
    const std::filesystem::path& path() const { return written_; }
    void write(std::string_view bytes);  ///< throws OutputError
    void flush();                        ///< so that only the renaming can still fail; throws OutputError
    void commit();                       ///< throws OutputError

    /// Gives all files their names, or none: what was there before comes back if one cannot have its own. Throws
    /// OutputError.
    static void commit_together(std::span<OutputFile* const> files);

private:
    void keep_old();  ///< under another name, beside the one that is about to be replaced
    void put_old_back() noexcept;
    void forget_old() noexcept;
    [[noreturn]] void fail(const std::string& reason) const;

    std::filesystem::path file_;     ///< as it was asked for
    std::filesystem::path written_;  ///< what the stream writes
    std::filesystem::path target_;   ///< what it becomes; empty if it is written directly
    std::filesystem::path old_;      ///< what was there, while files are committed together; empty if there was nothing
    std::ofstream stream_;
};

/// All bytes of a file at once. Throws OutputError.
SPAWNFIELD_API void write_file_atomically(const std::filesystem::path& file, std::string_view bytes);

}  // namespace spawnfield
