#pragma once

#include <spawnfield/export.h>

#include <filesystem>
#include <string>
#include <vector>

namespace spawnfield {

/// A temporary file or folder that a killed run left: TARGET.tmp-… (a result that was not complete) or TARGET.old-…
/// (what a result was about to replace). The dots are 12 characters, of which four are a checksum of the name.
struct Leftover {
    std::filesystem::path path;
    /// It gets this name, because nothing has it: the run was killed between two renames. Empty: it is removed.
    std::filesystem::path put_back_to;
    std::string failure;  ///< why it could not be removed or put back; empty if it was
};

struct CleanOptions {
    bool recursive = false;  ///< also the folders below, except those that may not be read; links are not followed
    bool dry_run = false;    ///< only lists
};

/// Removes or puts back what killed runs left in a folder. Returns it, sorted by path. Never touches what a living run
/// holds: its lock is taken. On a file system without locks nothing is removed. Throws FileError if the folder cannot
/// be read.
SPAWNFIELD_API std::vector<Leftover> clean_folder(const std::filesystem::path& folder,
                                                  const CleanOptions& options = {});

/// Does the same only for what killed runs left of one result. Does not throw: a folder that cannot be read has
/// nothing.
SPAWNFIELD_API std::vector<Leftover> clean_target(const std::filesystem::path& target);

}  // namespace spawnfield
