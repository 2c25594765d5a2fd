#pragma once

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

/// Returns bits 0 .. 3 from the first masks and bits 4 .. 7 from the second.
inline std::uint32_t bits_of(const FourMasks& first, const FourMasks& second)
{
    const FourMasks marks = (first & FourMasks{1, 2, 4, 8}) | (second & FourMasks{16, 32, 64, 128});
    std::array<std::uint64_t, 2> twos;
    std::memcpy(&twos, &marks, sizeof twos);
    const std::uint64_t both = twos[0] | twos[1];
    return std::uint32_t(both | both >> 32) & 255;
}

}  // namespace spawnfield
