#include "drawing/ticks.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace spawnfield {
namespace {

constexpr std::array mantissas{1.0, 2.0, 2.5, 5.0, 10.0};
constexpr double tolerance = 1e-9;  // relative; so that rounding does not exclude a step

RoundStep times_power(double mantissa, int exponent)
{
    const int digits = mantissa == 2.5 ? 1 : mantissa == 10 ? -1 : 0;
    return {mantissa * std::pow(10.0, exponent), std::max(0, digits - exponent)};
}

}  // namespace

RoundStep round_up(double value)
{
    const int exponent = static_cast<int>(std::floor(std::log10(value)));
    for (const double mantissa : mantissas) {
        const RoundStep step = times_power(mantissa, exponent);
        if (step.value >= value * (1 - tolerance)) return step;
    }
    return times_power(1, exponent + 1);
}

RoundStep round_down(double value)
{
    const int exponent = static_cast<int>(std::floor(std::log10(value)));
    for (std::size_t i = mantissas.size(); i-- > 0;) {
        const RoundStep step = times_power(mantissas[i], exponent);
        if (step.value <= value * (1 + tolerance)) return step;
    }
    return times_power(5, exponent - 1);
}

std::string Ticks::label(int i) const { return fixed(value(i), decimals); }

Ticks ticks_within(double low, double high, RoundStep step)
{
    const auto first = static_cast<std::int64_t>(std::ceil(low / step.value - tolerance));
    const auto last = static_cast<std::int64_t>(std::floor(high / step.value + tolerance));
    return {step.value, step.decimals, first, static_cast<int>(last - first + 1)};
}

Ticks ticks_around(double low, double high)
{
    if (!(high - low > 1e-6 * std::max(1.0, std::abs(high)))) {
        low -= 0.5;
        high += 0.5;
    }
    RoundStep step = round_up((high - low) / 6);
    while (true) {
        const auto first = static_cast<std::int64_t>(std::floor(low / step.value + tolerance));
        const auto last = static_cast<std::int64_t>(std::ceil(high / step.value - tolerance));
        const int count = static_cast<int>(last - first + 1);
        if (count <= 6) return {step.value, step.decimals, first, count};
        step = round_up(step.value * 1.01);
    }
}

std::string fixed(double value, int decimals)
{
    char buffer[400];  // the longest double has 309 digits before its point
    const auto end = std::to_chars(buffer, buffer + sizeof buffer, value + 0.0, std::chars_format::fixed, decimals).ptr;
    return {buffer, end};
}

std::string with_commas(std::uint64_t number)
{
    const std::string digits = std::to_string(number);
    std::string text;
    for (std::size_t i = 0; i < digits.size(); ++i) {
        if (i > 0 && (digits.size() - i) % 3 == 0) text += ',';
        text += digits[i];
    }
    return text;
}

}  // namespace spawnfield
