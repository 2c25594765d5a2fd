#pragma once

#include <cstdint>

namespace spawnfield {

/// The random numbers of stream `index` for `seed`. They are the same on every machine, unlike those of the standard
/// library's distributions. Source: Steele, Lea, Flood, Fast splittable pseudorandom number generators, 2014
/// (SplitMix64).
class Draw {
public:
    Draw(std::uint64_t seed, std::uint64_t index) : state_{mix(seed + mix(index + golden))} {}

    double unit() { return double(mix(state_ += golden) >> 11) * 0x1p-53; }  ///< [0, 1)
    double uniform(double low, double high) { return low + (high - low) * unit(); }

private:
    static constexpr std::uint64_t golden = 0x9E3779B97F4A7C15;

    static std::uint64_t mix(std::uint64_t z)
    {
        z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9;
        z = (z ^ (z >> 27)) * 0x94D049BB133111EB;
        return z ^ (z >> 31);
    }

    std::uint64_t state_;
};

}  // namespace spawnfield
