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

/// Returns a number whose bits first .. last are set; none if last < first. Both are 0 .. 63.
inline std::uint64_t bits_between(int first, int last)
{
    return first <= last ? ~std::uint64_t{0} >> (63 - last) & ~std::uint64_t{0} << first : 0;
}

}  // namespace spawnfield
