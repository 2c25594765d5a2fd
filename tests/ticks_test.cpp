#include "drawing/ticks.h"

#include "catch.h"

#include <cmath>

using namespace spawnfield;

TEST_CASE("a step is rounded to 1, 2, 2.5 or 5 times a power of ten")
{
    const auto [value, up, down] = GENERATE(table<double, double, double>({{1, 1, 1},
                                                                           {1.01, 2, 1},
                                                                           {0.09, 0.1, 0.05},
                                                                           {2.2, 2.5, 2},
                                                                           {26, 50, 25},
                                                                           {999, 1000, 500},
                                                                           {0.1, 0.1, 0.1},
                                                                           {1e6, 1e6, 1e6}}));
    CHECK(round_up(value).value == Approx(up));
    CHECK(round_down(value).value == Approx(down));
}

TEST_CASE("labels have as many decimals as their step needs")
{
    const auto [step, label] = GENERATE(table<double, std::string>(
        {{0.09, "0.3"}, {0.025, "0.075"}, {2.5, "7.5"}, {25, "75"}, {0.2, "0.6"}, {10, "30"}}));
    CHECK(ticks_within(0, 10 * step, round_up(step)).label(3) == label);
}

TEST_CASE("zero has no sign") { CHECK(ticks_within(-1, 1, round_up(0.5)).label(2) == "0.0"); }

TEST_CASE("ticks of a range are those in it, including its ends")
{
    const Ticks ticks = ticks_within(0.1, 0.5, round_up(0.1));
    CHECK(ticks.count == 5);
    CHECK(ticks.lowest() == Approx(0.1));
    CHECK(ticks.highest() == Approx(0.5));
    CHECK(ticks_within(0.11, 0.19, round_up(0.1)).count == 0);
}

TEST_CASE("4 to 6 ticks cover any range")
{
    const double low = GENERATE(-3.7, 0.0, 0.1, 556440.0, -1e-4);
    const double length = GENERATE(0.07, 0.3, 1.0, 1.7, 3.3, 4.9, 6.1, 9.9, 12.0, 71.0, 4e5);
    const Ticks ticks = ticks_around(low, low + length);
    CAPTURE(low, length);
    if (length > 1e-6 * (low + length)) {
        CHECK(ticks.count >= 4);
        CHECK(ticks.count <= 6);
    }
    CHECK(ticks.lowest() <= low + 1e-8 * ticks.step);
    CHECK(ticks.highest() >= low + length - 1e-8 * ticks.step);
}

TEST_CASE("a range of length 0 gets ticks around it")
{
    const Ticks ticks = ticks_around(7, 7);
    CHECK(ticks.lowest() < 7);
    CHECK(ticks.highest() > 7);
}

TEST_CASE("thousands are separated")
{
    CHECK(with_commas(0) == "0");
    CHECK(with_commas(999) == "999");
    CHECK(with_commas(1000) == "1,000");
    CHECK(with_commas(1234567890) == "1,234,567,890");
}
