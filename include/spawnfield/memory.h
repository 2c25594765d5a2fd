#pragma once

#include <spawnfield/export.h>

#include <stdexcept>
#include <string>

namespace spawnfield {

/// Some work needs more memory than it may have. what() has the need, the limit, and what would fit.
class SPAWNFIELD_API MemoryError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// Returns how many bytes this process can still get without swapping: what the system has available, or less if its
/// control group, or one above that, has a limit. Infinite if nothing is known. Sources: proc(5), MemAvailable;
/// Linux kernel, Control Group v2, memory.max and memory.current; v1, memory.limit_in_bytes and memory.usage_in_bytes.
SPAWNFIELD_API double available_memory();

/// From now on this process gets about so many bytes at most: allocations beyond that throw std::bad_alloc. Source:
/// setrlimit(2), RLIMIT_DATA. Does nothing in builds with a sanitizer, whose own memory is much larger.
SPAWNFIELD_API void limit_memory(double bytes);

/// Returns bytes as "12.4 GB", "350 MB" (powers of ten).
SPAWNFIELD_API std::string memory_text(double bytes);

/// About how much memory some work needs.
struct MemoryNeed {
    double fixed = 0;     ///< bytes
    double per_item = 0;  ///< bytes for each cell of a grid
};

/// Throws MemoryError if cells of this size (m) that cover an area (m2) need more than `limit` bytes; it says which
/// size would fit. `name`: of the option for the size, for messages.
SPAWNFIELD_API void require_cell_memory(const MemoryNeed& need, const std::string& name, double cell, double area,
                                        double limit);

}  // namespace spawnfield
