#pragma once

#include "base/stopwatch.h"

#include <utility>

namespace bench {

template <class Result>
struct Timed {
    double seconds;
    Result result;
};

/// Returns the result of `work` with its wall-clock time.
template <class Work>
auto timed(const Work& work)
{
    spawnfield::Stopwatch watch;
    auto result = work();
    const double seconds = watch.lap();
    return Timed<decltype(result)>{seconds, std::move(result)};
}

}  // namespace bench
