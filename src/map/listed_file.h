#pragma once

#include <filesystem>
#include <string>

namespace spawnfield {

/// A file of the map as map.yaml lists it.
struct ListedFile {
    std::string name, checksum;
    std::string head_checksum;  ///< for files that are read tile by tile; otherwise empty
    std::uintmax_t bytes = 0;
};

/// Returns the entry of a file that was written whole. Throws FileError if it cannot be read.
ListedFile list_file(const std::filesystem::path& file);

/// Throws FileError if the file is missing or has another size.
void check_size(const std::filesystem::path& folder, const ListedFile& file);

/// Throws FileError if the file has another checksum. Reads the whole file.
void check_checksum(const std::filesystem::path& folder, const ListedFile& file);

}  // namespace spawnfield
