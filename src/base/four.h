#pragma once

#include "base/bits.h"

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
inline Four magnitude(const Four& a)
{
    constexpr std::int32_t without_sign = 0x7fffffff;
    return Four(FourMasks(a) & FourMasks{without_sign, without_sign, without_sign, without_sign});
}

/// Two numbers in one register.
using Two = double __attribute__((vector_size(16)));
using TwoMasks = decltype(Two{} < Two{});  ///< all bits of a number are equal

inline Two both(double value) { return Two{value, value}; }
// If one of the numbers is NaN, both return the second one.
inline Two least(const Two& a, const Two& b)
{
#ifdef __SSE2__
    return Two(_mm_min_pd(__m128d(a), __m128d(b)));
#else
    return a < b ? a : b;
#endif
}
inline Two greatest(const Two& a, const Two& b)
{
#ifdef __SSE2__
    return Two(_mm_max_pd(__m128d(a), __m128d(b)));
#else
    return a > b ? a : b;
#endif
}

/// Returns x and y of the differences a - b and c - d, where each argument points to x and y.
inline Four differences(const double* a, const double* b, const double* c, const double* d)
{
    const auto two_at = [](const double* from) {
        Two out;
        std::memcpy(&out, from, sizeof out);
        return out;
    };
    const Two first = two_at(a) - two_at(b), second = two_at(c) - two_at(d);
#ifdef __SSE2__
    return Four(_mm_movelh_ps(_mm_cvtpd_ps(__m128d(first)), _mm_cvtpd_ps(__m128d(second))));
#else
    return Four{float(first[0]), float(first[1]), float(second[0]), float(second[1])};
#endif
}

/// Returns a bit for each mask.
inline std::uint32_t bits_of(const FourMasks& masks)
{
#ifdef __SSE2__
    return std::uint32_t(_mm_movemask_ps(__m128(masks)));
#else
    const FourMasks marks = masks & FourMasks{1, 2, 4, 8};
    std::array<std::uint64_t, 2> twos;
    std::memcpy(&twos, &marks, sizeof twos);
    const std::uint64_t both = twos[0] | twos[1];
    return std::uint32_t(both | both >> 32) & 15;
#endif
}

/// Returns bits 0 .. 3 from the first masks and bits 4 .. 7 from the second.
inline std::uint32_t bits_of(const FourMasks& first, const FourMasks& second)
{
    return bits_of(first) | bits_of(second) << 4;
}

/// Returns whether all masks are set.
inline bool are_set(const TwoMasks& masks)
{
#ifdef __SSE2__
    return _mm_movemask_pd(__m128d(masks)) == 3;
#else
    return (masks[0] & masks[1]) != 0;
#endif
}

/// Returns two whole numbers 0 .. 255, each in all bytes.
inline std::array<SixteenBytes, 2> in_all_bytes(const Two& numbers)
{
#ifdef __SSE2__
    const auto whole = SixteenBytes(_mm_cvttpd_epi32(__m128d(numbers)));
    return {__builtin_shufflevector(whole, whole, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0),
            __builtin_shufflevector(whole, whole, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4)};
#else
    return {SixteenBytes{} + std::uint8_t(numbers[0]), SixteenBytes{} + std::uint8_t(numbers[1])};
#endif
}

}  // namespace spawnfield
