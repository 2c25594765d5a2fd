#include "base/input_file.h"

#include "base/input_watch.h"

#include <spawnfield/error.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace spawnfield {

namespace fs = std::filesystem;

namespace {

std::string complaint_about(fs::file_type type, const std::error_code& error)
{
    switch (type) {
    case fs::file_type::not_found: return "does not exist; is the path right?";
    case fs::file_type::directory: return "is a folder, needs a file";
    case fs::file_type::fifo:
        return "is a pipe, needs a regular file; write it to one first, or give - (standard input) if the option "
               "accepts it";
    case fs::file_type::character:
    case fs::file_type::block: return "is a device, needs a regular file";
    case fs::file_type::socket: return "is a socket, needs a regular file";
    default: return "cannot be reached: " + error.message();
    }
}

}  // namespace

bool does_exist(const fs::path& path)
{
    std::error_code unreachable;
    return fs::exists(path, unreachable);
}

bool is_file(const fs::path& path)
{
    std::error_code unreachable;
    return fs::is_regular_file(path, unreachable);
}

bool is_folder(const fs::path& path)
{
    std::error_code unreachable;
    return fs::is_directory(path, unreachable);
}

bool is_missing(const fs::path& path)
{
    std::error_code error;
    return fs::status(path, error).type() == fs::file_type::not_found || error == std::errc::filename_too_long;
}

void require_file(const fs::path& file)
{
    std::error_code error;
    const fs::file_status status = fs::status(file, error);
    if (status.type() != fs::file_type::regular) throw FileError(file.string(), complaint_about(status.type(), error));
    count_input(file);
}

bool is_in_folder(const fs::path& path, const fs::path& folder)
{
    return std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first == folder.end();
}

FileError unreachable_file(const fs::filesystem_error& error)
{
    return {error.path1().string(), "cannot be reached: " + error.code().message()};
}

std::ifstream open_file(const fs::path& file)
{
    require_file(file);
    std::ifstream stream(file, std::ios::binary);
    if (!stream) throw FileError(file.string(), std::string("cannot be read: ") + std::strerror(errno));
    return stream;
}

std::string read_file(const fs::path& file)
{
    std::ifstream stream = open_file(file);
    std::string bytes(std::size_t(fs::file_size(file)), '\0');
    stream.read(bytes.data(), std::streamsize(bytes.size()));
    if (std::size_t(stream.gcount()) != bytes.size()) throw FileError(file.string(), "cannot be read to its end");
    return bytes;
}

std::string read_start(const fs::path& file, std::size_t most)
{
    std::ifstream stream = open_file(file);
    std::string bytes(most, '\0');
    stream.read(bytes.data(), std::streamsize(most));
    bytes.resize(std::size_t(stream.gcount()));
    return bytes;
}

}  // namespace spawnfield
