#pragma once

#include <spawnfield/types.h>

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <atomic>
#include <cstddef>
#include <mutex>

namespace spawnfield {

/// How many threads are meant; 0: all cores.
inline int thread_count(int threads) { return threads > 0 ? threads : tbb::info::default_concurrency(); }

/// Calls body(i) for each i < count on `threads` threads (0: all cores). Each i must write to its own slot only.
/// `progress` hears of it after each item; an exception from there or from body ends the loop and is thrown on.
template <class Body>
void parallel_for(std::size_t count, int threads, const Progress& progress, const Body& body)
{
    std::atomic<std::size_t> done{0};
    std::mutex telling;
    // What TBB's own hand-over already orders, in words that a thread sanitizer reads, as the library is not
    // instrumented: what came before the loop comes before its parts, and what they did before what comes after, be it
    // an exception.
    std::atomic<bool> started{false}, finished{false};
    struct AtEnd {
        std::atomic<bool>& flag;
        ~AtEnd() { flag.exchange(true, std::memory_order_acq_rel); }
    };
    const AtEnd end{finished};
    started.store(true, std::memory_order_release);
    const auto run = [&](const tbb::blocked_range<std::size_t>& range) {
        static_cast<void>(started.load(std::memory_order_acquire));
        const AtEnd end_of_part{finished};
        for (std::size_t i = range.begin(); i != range.end(); ++i) {
            body(i);
            if (!progress) continue;
            const std::size_t now = ++done;
            if (const std::unique_lock lock(telling, std::try_to_lock); lock) progress(double(now) / double(count));
        }
    };
    const tbb::global_control allowed(tbb::global_control::max_allowed_parallelism, std::size_t(thread_count(threads)));
    tbb::task_arena arena(thread_count(threads));
    arena.execute([&] { tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count), run); });
}

}  // namespace spawnfield
