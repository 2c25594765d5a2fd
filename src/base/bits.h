#pragma once

#ifdef __SSE2__
#include <emmintrin.h>
#endif

#include <bit>
#include <cstdint>
#include <cstring>

namespace spawnfield {

/// Calls visit(k) for each bit k that is set, ascending.
template <class Visit>
void for_each_bit(std::uint64_t bits, const Visit& visit)
{
    for (; bits != 0; bits &= bits - 1) visit(std::uint32_t(std::countr_zero(bits)));
}

/// Returns the number of the first bit that is set; 63 if none is. Other than std::countr_zero, it has no branch.
inline std::uint32_t first_bit(std::uint64_t bits)
{
    constexpr std::uint64_t last = std::uint64_t{1} << 63;
    return std::uint32_t(std::countr_zero(bits | last));
}

/// Returns a number whose bits first .. last are set; none if last < first. Both are 0 .. 63.
inline std::uint64_t bits_between(int first, int last)
{
    return first <= last ? ~std::uint64_t{0} >> (63 - last) & ~std::uint64_t{0} << first : 0;
}

/// Sixteen bytes in one register. The type is an extension of GCC and clang.
using SixteenBytes = std::uint8_t __attribute__((vector_size(16)));

/// Reads sixteen bytes.
inline SixteenBytes sixteen_at(const void* from)
{
    SixteenBytes out;
    std::memcpy(&out, from, sizeof out);
    return out;
}

/// Returns by how much each byte of `a` exceeds that of `b`; 0 where it does not.
inline SixteenBytes excess(const SixteenBytes& a, const SixteenBytes& b)
{
#ifdef __SSE2__
    return SixteenBytes(_mm_subs_epu8(__m128i(a), __m128i(b)));
#else
    return SixteenBytes(a > b) & (a - b);
#endif
}

/// Returns a bit for each byte, the first one for byte 0. Each byte is 0 or 255.
inline std::uint32_t bits_of(const SixteenBytes& bytes)
{
#ifdef __SSE2__
    return std::uint32_t(_mm_movemask_epi8(__m128i(bytes)));
#else
    std::uint64_t halves[2];
    std::memcpy(halves, &bytes, sizeof bytes);
    const auto bits = [](std::uint64_t half) {  // the product moves bit 0 of byte k to bit 56 + k
        return std::uint32_t((half & 0x0101010101010101) * 0x0102040810204080 >> 56);
    };
    return bits(halves[0]) | bits(halves[1]) << 8;
#endif
}

}  // namespace spawnfield
