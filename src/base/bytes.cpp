#include "base/bytes.h"

#include <spawnfield/error.h>
#include <spawnfield/input_file.h>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

namespace spawnfield {

Bytes bytes_of(std::string bytes)
{
    const auto owner = std::make_shared<const std::string>(std::move(bytes));
    return {owner, *owner};
}

Bytes map_file(const std::filesystem::path& file)
{
    require_file(file);
    const int descriptor = open(file.c_str(), O_RDONLY | O_CLOEXEC);
    struct stat status {};
    if (descriptor < 0 || fstat(descriptor, &status) != 0 || !S_ISREG(status.st_mode)) {
        if (descriptor >= 0) close(descriptor);
        throw FileError(file.string(), "cannot be read");
    }
    const auto size = std::size_t(status.st_size);
    void* const start = size == 0 ? nullptr : mmap(nullptr, size, PROT_READ, MAP_PRIVATE, descriptor, 0);
    close(descriptor);
    if (size == 0) return {};
    if (start == MAP_FAILED) throw FileError(file.string(), "cannot be mapped into memory");
    const std::shared_ptr<const void> owner(start,
                                            [size](const void* mapped) { munmap(const_cast<void*>(mapped), size); });
    return {owner, {static_cast<const char*>(start), size}};
}

}  // namespace spawnfield
