#pragma once

#include <spawnfield/export.h>

#include <filesystem>
#include <functional>
#include <span>
#include <string>

namespace spawnfield {

/// A folder that appears whole or not at all: filled beside its name, takes its place by commit(), removed if that
/// never comes. Of a link to a folder, what it leads to is replaced. One thread at a time may use it.
class SPAWNFIELD_API OutputFolder {
public:
    using Path = std::filesystem::path;

    /// An empty folder may be replaced; one that holds something only if `objection` to it is empty, else the error
    /// names it. Throws OutputError, before anything is made.
    OutputFolder(const Path& target, const std::function<std::string(const Path&)>& objection);
    OutputFolder(const OutputFolder&) = delete;
    OutputFolder& operator=(const OutputFolder&) = delete;
    ~OutputFolder();

    const Path& path() const { return folder_; }  ///< where to write meanwhile

    /// `keep` may take out of the old folder, if there was one, what it wants before the rest of it goes. Throws
    /// OutputError.
    void commit(const std::function<void(const Path& old, const Path& now)>& keep = {});

private:
    Path target_, folder_, old_;
};

/// Objection to a folder that holds anything but files of these names: so that only what was written by the same
/// command is replaced. `kind` as "thesis result".
SPAWNFIELD_API std::function<std::string(const std::filesystem::path&)> holds_only(std::span<const char* const> names,
                                                                                   const std::string& kind);

}  // namespace spawnfield
