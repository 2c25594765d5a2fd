#include "base/number.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <optional>

namespace spawnfield {
namespace {

/// A decimal number: digits * 10^exponent.
struct Decimal {
    std::uint64_t digits;
    int exponent;
};

constexpr std::array<std::uint64_t, 20> powers_of_10 = [] {
    std::array<std::uint64_t, 20> powers{1};
    for (std::size_t k = 1; k < powers.size(); ++k) powers[k] = 10 * powers[k - 1];
    return powers;
}();

__extension__ using Wide = unsigned __int128;

/// Returns floor(value * 2^-shift), and 1 in its last bit if any bit was lost. The shift is 1 .. 63.
std::uint64_t shifted(Wide value, int shift)
{
    const auto lost = std::uint64_t(value) << (64 - shift);
    return std::uint64_t(value >> shift) | std::uint64_t(lost != 0);
}

/// Returns the shortest decimal number that reads back to the same double, and of several, the nearest one. The bits
/// must be those of a positive double. Returns nothing for powers of two, and for numbers below 2^-11 or from 2^52 on.
///
/// All numbers between the middles to both neighbours of a double read back to it. A step of 10^k, the largest one that
/// is not longer than the distance of neighbours, always has a multiple between them. If a multiple of 10^(k + 1) is
/// there too, it is shorter. All products are exact. Source: Giulietti, The Schubfach way to render doubles, 2020.
std::optional<Decimal> shortest_decimal(std::uint64_t bits)
{
    constexpr int mantissa_bits = 52, bias = 1023;
    const std::uint64_t mantissa = bits & ((std::uint64_t{1} << mantissa_bits) - 1);
    const int power = int(bits >> mantissa_bits) - bias;
    if (mantissa == 0 || power < -11 || power > 51) return std::nullopt;
    const std::uint64_t significand = mantissa | std::uint64_t{1} << mantissa_bits;
    const int shift = mantissa_bits - power;                     // the double is significand * 2^-shift
    const int places = (shift * 1262611 + (1 << 22) - 1) >> 22;  // -k; the factor is log10(2) * 2^22
    const std::uint64_t scale = powers_of_10[std::size_t(places)];
    // In quarters of 10^k: the double, and the middles to its neighbours.
    const Wide exact = Wide{4 * significand} * scale, half = Wide{2} * scale;
    const std::uint64_t value = shifted(exact, shift), low = shifted(exact - half, shift) + significand % 2,
                        high = shifted(exact + half, shift) - significand % 2;
    const std::uint64_t whole = value / 4, tens = whole / 10;
    if (low <= 40 * tens) return Decimal{tens, 1 - places};
    if (40 * (tens + 1) <= high) return Decimal{tens + 1, 1 - places};
    const bool has_lower = low <= 4 * whole, has_upper = 4 * (whole + 1) <= high;
    const std::uint64_t middle = 4 * whole + 2;
    const bool is_nearer_upper = value > middle || (value == middle && whole % 2 == 1);
    return Decimal{whole + (has_lower && has_upper ? is_nearer_upper : has_upper), -places};
}

constexpr std::array<char, 200> pairs_of_digits = [] {
    std::array<char, 200> pairs{};
    for (std::size_t k = 0; k < 100; ++k) {
        pairs[2 * k] = char('0' + k / 10);
        pairs[2 * k + 1] = char('0' + k % 10);
    }
    return pairs;
}();

/// Writes eight digits, with zeros in front.
void write_eight(char* to, std::uint32_t digits)
{
    const std::uint32_t high = digits / 10000, low = digits % 10000;
    const auto write_two = [](char* at, std::uint32_t two) { std::memcpy(at, &pairs_of_digits[2 * two], 2); };
    write_two(to, high / 100);
    write_two(to + 2, high % 100);
    write_two(to + 4, low / 100);
    write_two(to + 6, low % 100);
}

/// The digits of a number below 10^19 as text. The first one is not 0.
class Digits {
public:
    explicit Digits(std::uint64_t number)
    {
        constexpr std::uint64_t eight = 100000000;
        const std::uint64_t high = number / eight;
        write_eight(text_.data(), std::uint32_t(high / eight));
        write_eight(text_.data() + 8, std::uint32_t(high % eight));
        write_eight(text_.data() + 16, std::uint32_t(number % eight));
        const int estimate = int(std::bit_width(number)) * 1233 >> 12;  // log10(2) * 2^12; at most 1 too small
        size_ = estimate + (number >= powers_of_10[std::size_t(estimate)]);
    }

    int size() const { return size_; }

    /// Writes the digits from `first` on, and then some other characters: `most` in all.
    void write_from(int first, char* to) const { std::memcpy(to, text_.data() + (24 - size_ + first), most); }
    static constexpr std::size_t most = 20;

private:
    std::array<char, 24 + most> text_{};
    int size_;
};

/// Writes a decimal number without an exponent; nothing if std::to_chars would write an exponent, because it is
/// shorter.
char* write_plainly(char* to, Decimal number)
{
    while (number.digits % 10 == 0) {
        number.digits /= 10;
        ++number.exponent;
    }
    const Digits digits(number.digits);
    const int size = digits.size(), before = size + number.exponent;  // `before`: number of digits before the point
    const int length = before >= size ? before : before > 0 ? size + 1 : size + 2 - before;
    const int length_with_exponent = size + (size > 1) + 4;
    if (length > length_with_exponent) return nullptr;
    char* const start = before > 0 ? to : to + 2 - before;
    if (before <= 0) std::memcpy(to, "0.000", 5);  // `before` is -3 or more
    digits.write_from(0, start);
    if (before >= size) return std::fill_n(start + size, before - size, '0');
    if (before <= 0) return start + size;
    digits.write_from(before, start + before + 1);
    start[before] = '.';
    return start + size + 1;
}

}  // namespace

char* write_number(char* to, double value)
{
    const auto bits = std::bit_cast<std::uint64_t>(value);
    constexpr std::uint64_t sign = std::uint64_t{1} << 63;
    char* at = to;
    if ((bits & sign) != 0) *at++ = '-';
    if ((bits & ~sign) == 0) {
        *at++ = '0';
        return at;
    }
    if (const auto decimal = shortest_decimal(bits & ~sign))
        if (char* const end = write_plainly(at, *decimal)) return end;
    return std::to_chars(to, to + number_room, value).ptr;
}

}  // namespace spawnfield
