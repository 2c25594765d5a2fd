#pragma once

#include <cstdint>
#include <string>

namespace spawnfield {

/// 1, 2, 2.5 or 5 times a power of ten.
struct RoundStep {
    double value;
    int decimals;  ///< that its multiples need
};

RoundStep round_up(double value);    ///< the smallest at or above value > 0
RoundStep round_down(double value);  ///< the largest at or below it

/// Multiples of a round step.
struct Ticks {
    double step = 1;
    int decimals = 0;
    std::int64_t first = 0;  ///< in steps
    int count = 0;

    double at(int i) const { return static_cast<double>(first + i) * step; }
    double lowest() const { return at(0); }
    double highest() const { return at(count - 1); }
    std::string label(int i) const;
};

/// All between low and high; none if no multiple lies there.
Ticks ticks_within(double low, double high, RoundStep step);

/// 4 to 6 of them, the first at or below low, the last at or above high. A range of no length is widened by 1.
Ticks ticks_around(double low, double high);

std::string fixed(double value, int decimals);
std::string with_commas(std::uint64_t number);  ///< "1,234,567"

}  // namespace spawnfield
