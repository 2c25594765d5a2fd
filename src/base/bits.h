#pragma once

#include <bit>
#include <cstdint>

namespace spawnfield {

/// Calls visit(k) for each bit k that is set, ascending.
template <class Visit>
void for_each_bit(std::uint64_t bits, const Visit& visit)
{
    for (; bits != 0; bits &= bits - 1) visit(std::uint32_t(std::countr_zero(bits)));
}

}  // namespace spawnfield
