#pragma once

#ifdef __SSE2__
#include <emmintrin.h>
#endif

#include <array>
#include <cstdint>
#include <cstring>

namespace spawnfield {

/// Four numbers in one register. The type is an extension of GCC and clang.
using Four = float __attribute__((vector_size(16)));
using FourMasks = decltype(Four{} < Four{});  ///< all bits of a number are equal

inline Four all(float value) { return Four{value, value, value, value}; }
inline Four least(const Four& a, const Four& b) { return a < b ? a : b; }
inline Four greatest(const Four& a, const Four& b) { return a > b ? a : b; }
inline Four magnitude(const Four& a) { return greatest(a, -a); }

/// Returns x and y of the differences a - b and c - d, where each argument points to x and y.
inline Four differences(const double* a, const double* b, const double* c, const double* d)
{
    using Two = double __attribute__((vector_size(16)));
    const auto two_at = [](const double* from) {
        Two out;
        std::memcpy(&out, from, sizeof out);
        return out;
    };
    const Two first = two_at(a) - two_at(b), second = two_at(c) - two_at(d);
    return Four{float(first[0]), float(first[1]), float(second[0]), float(second[1])};
}

/// Returns bits 0 .. 3 from the first masks and bits 4 .. 7 from the second.
inline std::uint32_t bits_of(const FourMasks& first, const FourMasks& second)
{
#ifdef __SSE2__
    return std::uint32_t(_mm_movemask_ps(__m128(first)) | _mm_movemask_ps(__m128(second)) << 4);
#else
    const FourMasks marks = (first & FourMasks{1, 2, 4, 8}) | (second & FourMasks{16, 32, 64, 128});
    std::array<std::uint64_t, 2> twos;
    std::memcpy(&twos, &marks, sizeof twos);
    const std::uint64_t both = twos[0] | twos[1];
    return std::uint32_t(both | both >> 32) & 255;
#endif
}

}  // namespace spawnfield
