#pragma once

#include <sys/mman.h>

#include <cstddef>
#include <cstdint>
#include <iterator>
#include <utility>

namespace spawnfield {

/// Makes room for `size` items. If that is several megabytes, asks the system for pages of 2 MB, where it gives them
/// only to those who ask: it then clears and maps 512 times fewer pages. Memory that is never used is still not taken
/// from the system, except for the rest of the last page.
template <class List>  // std::vector or std::string
void reserve_large(List& list, std::size_t size)
{
    if (size <= list.capacity()) return;
    List larger;
    larger.reserve(size);
#ifdef MADV_HUGEPAGE
    constexpr std::uintptr_t page = std::uintptr_t{1} << 21;  // bytes; that of x86-64
    const auto begin = (reinterpret_cast<std::uintptr_t>(larger.data()) + page - 1) / page * page,
               end = reinterpret_cast<std::uintptr_t>(larger.data() + larger.capacity()) / page * page;
    // Only a wish, so its result does not matter. It comes before the first use of the memory.
    if (end > begin) madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);
#endif
    larger.insert(larger.end(), std::make_move_iterator(list.begin()), std::make_move_iterator(list.end()));
    list = std::move(larger);
}

}  // namespace spawnfield
