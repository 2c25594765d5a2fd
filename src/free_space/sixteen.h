#pragma once

#include "base/bits.h"

#include <cstdint>
#include <cstring>

namespace spawnfield {

/// Values of 16 neighbouring columns of a tile, in two registers; 0 at first. The types are extensions of GCC and
/// clang.
class Sixteen {
public:
    static constexpr int width = 16;

    static Sixteen read(const std::uint16_t* from)
    {
        Sixteen out;
        std::memcpy(&out.low_, from, sizeof out.low_);
        std::memcpy(&out.high_, from + width / 2, sizeof out.high_);
        return out;
    }
    void write(std::uint16_t* to) const
    {
        std::memcpy(to, &low_, sizeof low_);
        std::memcpy(to + width / 2, &high_, sizeof high_);
    }

    /// Raises each value to that of a column.
    void raise(const Sixteen& by)
    {
        low_ = low_ > by.low_ ? low_ : by.low_;
        high_ = high_ > by.high_ ? high_ : by.high_;
    }

    /// Returns a bit for each value in the range low .. high, the first one for the first value.
    std::uint64_t bits_within(std::uint32_t low, std::uint32_t high) const
    {
        high = high < 65535 ? high : 65535;
        if (low > high) return 0;
        const auto from = std::uint16_t(low), range = std::uint16_t(high - low);
        const auto first = SixteenBytes(low_ - from <= range),  // differences are modulo 65536
            second = SixteenBytes(high_ - from <= range);
        return bits_of(
            __builtin_shufflevector(first, second, 0, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20, 22, 24, 26, 28, 30));
    }

private:
    using Eight = std::uint16_t __attribute__((vector_size(16)));
    Eight low_{}, high_{};  // separate, because compilers keep an array of vectors in memory
};

}  // namespace spawnfield
