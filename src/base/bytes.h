#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace spawnfield {

/// Bytes that somebody keeps alive: a string in memory, or a file that is mapped.
struct Bytes {
    std::shared_ptr<const void> owner;
    std::string_view view;

    Bytes part(std::size_t offset, std::size_t size) const { return {owner, view.substr(offset, size)}; }
};

Bytes bytes_of(std::string bytes);

/// A whole file, read-only, page by page as it is touched (mmap). Throws FileError.
Bytes map_file(const std::filesystem::path& file);

}  // namespace spawnfield
