#pragma once

#include <spawnfield/export.h>

#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <system_error>
#include <vector>

namespace spawnfield {

class Descriptor;

/// A folder that appears complete or not at all. It is filled beside its final name, and commit() puts it there.
/// Without commit(), it is removed; if the process was killed, the next OutputFolder of this name removes it, and puts
/// back an old folder that has lost its name. If the name is a link to a folder, the target of the link is replaced.
/// Only one thread at a time may use it.
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

    /// Entries of the old folder for which `keeps` returns true are in the new one, too. At no time is one of them
    /// lost. Throws OutputError.
    void commit(const std::function<bool(const Path& name)>& keeps = {});

    /// For the user, complete after commit(): what was put back, and what could not be removed.
    const std::vector<std::string>& notices() const { return notices_; }

private:
    std::error_code put_in_place();
    void clear_old(const std::function<bool(const Path& name)>& keeps);

    std::function<std::string(const Path&)> objection_;
    Path target_, folder_;
    std::vector<Path> old_;  ///< former folders, under their temporary names
    std::vector<std::string> notices_;
    std::unique_ptr<Descriptor> lock_, old_lock_;
};

/// Returns an objection to folders that contain anything except files of these names. So a command replaces only
/// folders that the same command wrote. `kind` is in the message, for example "thesis result".
SPAWNFIELD_API std::function<std::string(const std::filesystem::path&)> holds_only(std::span<const char* const> names,
                                                                                   const std::string& kind);

}  // namespace spawnfield
