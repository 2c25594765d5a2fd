#include "base/parallel.h"
#include "catch.h"

#include <numeric>
#include <stdexcept>

using namespace spawnfield;

TEST_CASE("results are taken in order, one at a time, for any number of threads")
{
    constexpr std::size_t count = 500;
    for (const int threads : {1, 2, 8}) {
        CAPTURE(threads);
        std::vector<std::size_t> taken;
        std::atomic<int> takers{0};
        bool alone = true;
        double last_progress = 0;
        parallel_in_order<std::vector<std::size_t>>(
            count, threads, [&](double share) { last_progress = share; },
            [](std::size_t i, std::vector<std::size_t>& buffer) {
                volatile std::size_t work = 0;  // later results are often ready first
                for (std::size_t k = 0; k < (i * 7919) % 500; ++k) work = work + k;
                buffer.assign(1, i);
            },
            [&](std::vector<std::size_t>& buffer) {
                alone = alone && ++takers == 1;
                taken.insert(taken.end(), buffer.begin(), buffer.end());
                --takers;
            });
        std::vector<std::size_t> wanted(count);
        std::iota(wanted.begin(), wanted.end(), 0);
        CHECK(taken == wanted);
        CHECK(alone);
        CHECK(last_progress > 0);
    }
}

TEST_CASE("an exception in one result ends the loop with any number of threads, and results after it are not taken")
{
    for (const int threads : {1, 2, 8}) {
        CAPTURE(threads);
        std::size_t taken = 0;
        const auto run = [&] {
            parallel_in_order<int>(
                100, threads, {},
                [](std::size_t i, int&) {
                    if (i == 40) throw std::runtime_error("forty");
                },
                [&](int&) { ++taken; });
        };
        CHECK_THROWS_WITH(run(), "forty");
        CHECK(taken <= 40);
    }
}

TEST_CASE("nothing is made or taken if the count is 0")
{
    bool called = false;
    parallel_in_order<int>(
        0, 2, {}, [&](std::size_t, int&) { called = true; }, [&](int&) { called = true; });
    CHECK_FALSE(called);
}
