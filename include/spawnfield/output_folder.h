#pragma once

#include <spawnfield/export.h>

#include <filesystem>
#include <functional>
#include <span>
#include <string>

namespace spawnfield {

/// A folder that appears complete or not at all. It is filled beside its final name, and commit() puts it there.
/// Without commit(), it is removed. If the name is a link to a folder, the target of the link is replaced. Only one
/// thread at a time may use it.
class SPAWNFIELD_API OutputFolder {
public:
    using Path = std::filesystem::path;

    /// An empty folder may be replaced. Another folder may be replaced only if `objection` returns an empty text for
    /// it; otherwise that text is the reason in the error. Throws OutputError before anything is created.
    OutputFolder(const Path& target, const std::function<std::string(const Path&)>& objection);
    OutputFolder(const OutputFolder&) = delete;
    OutputFolder& operator=(const OutputFolder&) = delete;
    ~OutputFolder();

    const Path& path() const { return folder_; }  ///< the folder to write to before commit()

    /// If there was an old folder, `keep` may move files from it to the new one before it is removed. Throws
    /// OutputError.
    void commit(const std::function<void(const Path& old, const Path& now)>& keep = {});

private:
    Path target_, folder_, old_;
};

/// Returns an objection to folders that contain anything except files of these names. So a command replaces only
/// folders that the same command wrote. `kind` is in the message, for example "thesis result".
SPAWNFIELD_API std::function<std::string(const std::filesystem::path&)> holds_only(std::span<const char* const> names,
                                                                                   const std::string& kind);

}  // namespace spawnfield
