#include "map/listed_file.h"

#include "base/bytes.h"
#include "base/checksum.h"

#include <spawnfield/error.h>
#include <spawnfield/input_file.h>

namespace spawnfield {

namespace fs = std::filesystem;

ListedFile list_file(const fs::path& file)
{
    const Bytes bytes = map_file(file);
    return {file.filename().string(), checksum(bytes.view), {}, bytes.view.size()};
}

void check_size(const fs::path& folder, const ListedFile& file)
{
    std::error_code error;
    if (fs::exists(folder / file.name, error)) require_file(folder / file.name);
    const auto bytes = fs::file_size(folder / file.name, error);
    if (error) throw FileError((folder / file.name).string(), "is missing; bake the map again");
    if (bytes != file.bytes)
        throw FileError((folder / file.name).string(), "has " + std::to_string(bytes) + " bytes, map.yaml lists " +
                                                           std::to_string(file.bytes) +
                                                           ": it was cut short or altered; bake the map again");
}

void check_checksum(const fs::path& folder, const ListedFile& file)
{
    if (list_file(folder / file.name).checksum != file.checksum)
        throw FileError((folder / file.name).string(),
                        "differs from its checksum in map.yaml: it was altered; bake the map again");
}

}  // namespace spawnfield
