#pragma once

#include <spawnfield/export.h>

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace spawnfield {

/// Bytes with a shared owner that keeps them alive: a string in memory, or a file mapped into memory.
struct Bytes {
    std::shared_ptr<const void> owner;
    std::string_view view;
    int descriptor = -1;    ///< of the file, open as long as the owner lives; -1: bytes in memory
    std::size_t start = 0;  ///< where `view` begins in the file

    /// Returns the bytes from `offset` on, at most `size` of them. They share the owner.
    Bytes part(std::size_t offset, std::size_t size) const
    {
        return {owner, view.substr(offset, size), descriptor, start + offset};
    }

    /// Copies `size` bytes from `offset` on. Those of a file are read, so that no page of the mapping is used. Returns
    /// false if the file cannot be read or has become shorter.
    bool copy(std::size_t offset, std::size_t size, char* to) const;

    /// Returns the memory of a file's pages to the system, which maps them again when they are used. Other threads may
    /// read the bytes at the same time.
    void forget_pages() const;
};

/// Takes the string over.
Bytes bytes_of(std::string bytes);

/// Maps a whole file into memory, read-only (mmap): the system reads a page when it is first used. The file remains
/// open. Throws FileError.
SPAWNFIELD_MODULE_API Bytes map_file(const std::filesystem::path& file);

}  // namespace spawnfield
