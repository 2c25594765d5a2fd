#pragma once

#include <cstdint>
#include <string>

namespace spawnfield {

/// A step of 1, 2, 2.5 or 5 times a power of ten.
struct RoundStep {
    double value;
    int decimals;  ///< number of decimals of its multiples
};

RoundStep round_up(double value);    ///< the smallest step that is at least `value`, which must be > 0
RoundStep round_down(double value);  ///< the largest step that is at most `value`, which must be > 0

/// Multiples of a round step.
struct Ticks {
    double step = 1;
    int decimals = 0;
    std::int64_t first = 0;  ///< first tick, in steps
    int count = 0;

    double value(int i) const { return static_cast<double>(first + i) * step; }
    double lowest() const { return value(0); }
    double highest() const { return value(count - 1); }
    std::string label(int i) const;
};

/// Returns all multiples of the step between low and high; there may be none.
Ticks ticks_within(double low, double high, RoundStep step);

/// Returns 4 to 6 ticks: the first is at most `low`, the last is at least `high`. A range without length is widened
/// by 1.
Ticks ticks_around(double low, double high);

std::string fixed(double value, int decimals);
std::string with_commas(std::uint64_t number);  ///< "1,234,567"

}  // namespace spawnfield
