#pragma once

#include <cstddef>
#include <string_view>

namespace spawnfield {

/// An open file in memory (memfd_create(2)), which a child process can inherit.
class MemoryFile {
public:
    explicit MemoryFile(const char* name);  ///< throws std::system_error
    explicit MemoryFile(int descriptor) : descriptor_(descriptor) {}
    MemoryFile(const MemoryFile&) = delete;
    MemoryFile& operator=(const MemoryFile&) = delete;
    ~MemoryFile();

    int descriptor() const { return descriptor_; }
    std::size_t size() const;
    /// Makes the file longer if needed. Throws std::system_error.
    void write(std::size_t offset, std::string_view bytes);

private:
    int descriptor_;
};

/// The beginning of a memory file in memory, shared with all processes that map it.
class SharedMemory {
public:
    SharedMemory(const MemoryFile& file, std::size_t size);  ///< throws std::system_error
    SharedMemory(const SharedMemory&) = delete;
    SharedMemory& operator=(const SharedMemory&) = delete;
    ~SharedMemory();

    char* data() const { return data_; }
    std::string_view view() const { return {data_, size_}; }

private:
    char* data_;
    std::size_t size_;
};

}  // namespace spawnfield
