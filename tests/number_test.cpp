#include "base/number.h"

#include "catch.h"

#include <cmath>
#include <cstring>
#include <random>

using namespace spawnfield;

namespace {

bool is_as_by_library(double value)
{
    char ours[number_room], expected[number_room];
    const char* const end = write_number(ours, value);
    const char* const expected_end = std::to_chars(expected, expected + sizeof expected, value).ptr;
    return std::string_view(ours, end) == std::string_view(expected, expected_end);
}

}  // namespace

TEST_CASE("numbers are written as std::to_chars writes them")
{
    std::size_t different = 0;
    const auto look_at = [&](double value) { different += !is_as_by_library(value) + !is_as_by_library(-value); };
    for (const double value : {0.0, double(NAN), double(INFINITY), 5e-324, 1.7976931348623157e308}) look_at(value);
    for (int power = -1080; power < 1025; ++power)  // around each power of two, where the distances of doubles change
        for (const double value : {std::ldexp(1, power), std::ldexp(1.5, power)}) {
            look_at(value);
            look_at(std::nextafter(value, 0.0));
            look_at(std::nextafter(value, INFINITY));
        }
    for (int power = -20; power < 20; ++power)  // short decimals, also with zeros at the end
        for (int digits = 1; digits < 2000; ++digits) look_at(digits * std::pow(10, power));
    std::mt19937_64 random(7);
    for (int k = 0; k < 300000; ++k) {
        const std::uint64_t bits = random();
        double any;
        std::memcpy(&any, &bits, sizeof any);
        look_at(any);
        const double unit = double(bits >> 11) * 0x1p-53;
        look_at(std::ldexp(unit, int(bits % 70) - 12));  // the range in which no call of the library is needed
        look_at(500 * unit);
        look_at(double(float(500 * unit)));
        look_at(std::round(1e6 * unit) / 1000);
        look_at(double(bits >> (11 + bits % 50)));
    }
    CHECK(different == 0);
    CHECK((number(0.1) == "0.1" && number(-0.0) == "-0" && number(1e5) == "1e+05" && number(120000) == "120000"));
}
