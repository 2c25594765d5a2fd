#pragma once

#include <cstdint>

/// SplitMix64 (Steele 2014). It gives the same numbers everywhere, which std distributions do not guarantee.
class Random {
public:
    explicit Random(std::uint64_t seed) : state_{seed} {}

    std::uint64_t next()
    {
        std::uint64_t z = state_ += 0x9E3779B97F4A7C15;
        z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9;
        z = (z ^ (z >> 27)) * 0x94D049BB133111EB;
        return z ^ (z >> 31);
    }
    double between(double low, double high) { return low + (high - low) * (double(next() >> 11) * 0x1p-53); }
    int below(int count) { return int(next() % std::uint64_t(count)); }  ///< 0 .. count - 1
    bool chance(double share) { return between(0, 1) < share; }

private:
    std::uint64_t state_;
};
