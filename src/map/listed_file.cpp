#include "map/listed_file.h"

#include "base/bytes.h"
#include "base/checksum.h"

#include <spawnfield/input_file.h>

namespace spawnfield {

namespace fs = std::filesystem;

ListedFile entry_of(const fs::path& file)
{
    const Bytes bytes = map_file(file);
    return {file.filename().string(), checksum(bytes.view), {}, bytes.view.size()};
}

void check_size(const fs::path& folder, const ListedFile& entry)
{
    const fs::path file = folder / entry.name;
    std::error_code error;
    if (does_exist(file)) require_file(file);
    const auto size = fs::file_size(file, error);
    if (error == std::errc::no_such_file_or_directory) throw FileError(file.string(), "is missing; bake the map again");
    if (error) throw FileError(file.string(), "cannot be read: " + error.message());
    if (size != entry.bytes)
        throw FileError(file.string(), "has " + std::to_string(size) + " bytes, but map.yaml lists " +
                                           std::to_string(entry.bytes) +
                                           ": the file was cut short or altered; bake the map again");
}

FileError altered(const fs::path& file)
{
    return {file.string(), "was altered: its checksum differs from the one in map.yaml; bake the map again"};
}

void check_checksum(const fs::path& folder, const ListedFile& entry)
{
    if (entry_of(folder / entry.name).checksum != entry.checksum) throw altered(folder / entry.name);
}

}  // namespace spawnfield
