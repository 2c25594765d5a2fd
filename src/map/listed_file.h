#pragma once

#include <spawnfield/error.h>

#include <filesystem>
#include <string>

namespace spawnfield {

/// An entry of map.yaml: a file of the map.
struct ListedFile {
    std::string name;
    std::string checksum;       ///< XXH64 of the whole file, 16 hexadecimal digits
    std::string head_checksum;  ///< the same of its head, for files that are read tile by tile; otherwise empty
    std::uintmax_t bytes = 0;   ///< size of the file
};

/// Returns the entry of a file that is not read tile by tile. Reads the whole file. Throws FileError if it cannot be
/// read.
ListedFile entry_of(const std::filesystem::path& file);

/// Throws FileError if the file is missing, is not a regular file, or has another size than its entry.
void check_size(const std::filesystem::path& folder, const ListedFile& entry);

/// Returns the error for a file with another checksum than its entry.
FileError altered(const std::filesystem::path& file);

/// Throws FileError if the file has another checksum than its entry. Reads the whole file.
void check_checksum(const std::filesystem::path& folder, const ListedFile& entry);

}  // namespace spawnfield
