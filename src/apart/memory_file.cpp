#include "apart/memory_file.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace spawnfield {
namespace {

[[noreturn]] void fail(const char* what) { throw std::system_error(errno, std::generic_category(), what); }

}  // namespace

MemoryFile::MemoryFile(const char* name)
{
    constexpr int above_inherited = 10;  // so that dup2() to the inherited numbers cannot close it
    const int made = memfd_create(name, MFD_CLOEXEC);
    if (made < 0) fail("memfd_create");
    descriptor_ = fcntl(made, F_DUPFD_CLOEXEC, above_inherited);
    close(made);
    if (descriptor_ < 0) fail("fcntl");
}

MemoryFile::~MemoryFile() { close(descriptor_); }

std::size_t MemoryFile::size() const
{
    struct stat status {};
    if (fstat(descriptor_, &status) != 0) fail("fstat");
    return std::size_t(status.st_size);
}

void MemoryFile::write(std::size_t offset, std::string_view bytes)
{
    while (!bytes.empty()) {
        const ssize_t count = pwrite(descriptor_, bytes.data(), bytes.size(), off_t(offset));
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) fail("pwrite");
        offset += std::size_t(count);
        bytes.remove_prefix(std::size_t(count));
    }
}

SharedMemory::SharedMemory(const MemoryFile& file, std::size_t size) : size_(size)
{
    void* const mapped = mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, file.descriptor(), 0);
    if (mapped == MAP_FAILED) fail("mmap");
    data_ = static_cast<char*>(mapped);
}

SharedMemory::~SharedMemory() { munmap(data_, size_); }

}  // namespace spawnfield
