#include "base/input_file.h"

#include <spawnfield/error.h>

#include <fstream>

namespace spawnfield {

std::string read_file(const std::filesystem::path& file)
{
    std::ifstream stream(file, std::ios::binary);
    if (!stream || !std::filesystem::is_regular_file(file)) throw FileError(file.string(), "is missing or cannot be read");
    std::string bytes(std::size_t(std::filesystem::file_size(file)), '\0');
    stream.read(bytes.data(), std::streamsize(bytes.size()));
    if (std::size_t(stream.gcount()) != bytes.size()) throw FileError(file.string(), "cannot be read to its end");
    return bytes;
}

}  // namespace spawnfield
