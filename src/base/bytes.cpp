#include "base/bytes.h"

#include <spawnfield/error.h>
#include <spawnfield/input_file.h>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstring>

namespace spawnfield {

Bytes bytes_of(std::string bytes)
{
    const auto owner = std::make_shared<const std::string>(std::move(bytes));
    return {.owner = owner, .view = *owner};
}

bool Bytes::copy(std::size_t offset, std::size_t size, char* to) const
{
    if (descriptor < 0) {
        std::memcpy(to, view.data() + offset, size);
        return true;
    }
    while (size > 0) {
        const ssize_t count = pread(descriptor, to, size, off_t(start + offset));
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) return false;
        offset += std::size_t(count);
        size -= std::size_t(count);
        to += count;
    }
    return true;
}

void Bytes::forget_pages() const
{
    if (descriptor < 0) return;
    const auto page = std::size_t(sysconf(_SC_PAGESIZE));
    const std::size_t before = reinterpret_cast<std::uintptr_t>(view.data()) % page;  // bytes of the first page
    madvise(const_cast<char*>(view.data() - before), view.size() + before, MADV_DONTNEED);
}

Bytes map_file(const std::filesystem::path& file)
{
    require_file(file);
    const int descriptor = open(file.c_str(), O_RDONLY | O_CLOEXEC);
    struct stat status {};
    if (descriptor < 0) throw FileError(file.string(), std::string("cannot be read: ") + std::strerror(errno));
    if (fstat(descriptor, &status) != 0 || !S_ISREG(status.st_mode)) {
        close(descriptor);
        throw FileError(file.string(), "is no regular file any more");
    }
    const auto size = std::size_t(status.st_size);
    void* const start = size == 0 ? nullptr : mmap(nullptr, size, PROT_READ, MAP_PRIVATE, descriptor, 0);
    if (size == 0 || start == MAP_FAILED) close(descriptor);
    if (size == 0) return {};
    if (start == MAP_FAILED) throw FileError(file.string(), "cannot be mapped into memory");
    const std::shared_ptr<const void> owner(start, [size, descriptor](const void* mapped) {
        munmap(const_cast<void*>(mapped), size);
        close(descriptor);
    });
    return {.owner = owner, .view = {static_cast<const char*>(start), size}, .descriptor = descriptor};
}

}  // namespace spawnfield
