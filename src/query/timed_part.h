#pragma once

#include <spawnfield/judge.h>

#include <chrono>

namespace spawnfield {

/// Adds the time from its construction to its destruction to a total, unless the total is nullptr.
class TimedPart {
public:
    explicit TimedPart(ExactTime* total) : total_(total), start_(total ? Clock::now() : Clock::time_point{}) {}
    TimedPart(const TimedPart&) = delete;
    TimedPart& operator=(const TimedPart&) = delete;
    ~TimedPart()
    {
        if (total_) total_->nanoseconds += std::chrono::nanoseconds(Clock::now() - start_).count();
    }

private:
    using Clock = std::chrono::steady_clock;
    ExactTime* const total_;
    const Clock::time_point start_;
};

}  // namespace spawnfield
